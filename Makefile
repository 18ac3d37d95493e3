# jamsweep: `make study-fig10` and `make test` work as the first command after a clone.
PYTHON ?= python3
JOBS ?= 2
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready

.PHONY: notebooks package
.PHONY: help setup bench stress torture study-accuracy study-variants study-real-crowds test lint docs constraints clean
.DEFAULT_GOAL := help

help:  ## this list
	@grep -hE '^[a-z%-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 20

setup: $(READY)  ## the environment in .venv, from pinned versions

# A bare Debian has Python without the means to make a virtual environment.
VENV_PACKAGE := { \
  if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
    echo "installing Debian's python3-venv ..."; \
    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -qq -y python3-venv >/dev/null; \
  else echo "Python cannot make a virtual environment: apt-get install python3-venv"; exit 2; fi; }

$(READY): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "$(PYTHON) is older than Python 3.11: say make PYTHON=python3.11"; exit 2; }
	@$(PYTHON) -c 'import ensurepip' 2>/dev/null || $(VENV_PACKAGE)
	@test -x $(BIN)/pip || $(PYTHON) -m venv $(VENV)
	@echo "setting up $(VENV) ..."
	@$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	@touch $@

study-%: $(READY)  ## reproduce a figure: make study-fig10, study-parisi, study-parisi-fig1 ... [QUICK=1] [JOBS=2]
	@$(BIN)/jamsweep study $* --jobs $(JOBS) $(if $(QUICK),--quick)

study-accuracy: $(READY)  ## error, bias and time of the numerics: make study-accuracy [QUICK=1] [JOBS=2] [DOCS=1] [MORE=4]
	@$(BIN)/python -m studies.accuracy --jobs $(JOBS) $(if $(QUICK),--quick) $(if $(DOCS),--docs) $(if $(MORE),--more $(MORE))

study-variants: $(READY)  ## variants of Lin's model against its numbers: make study-variants [QUICK=1] [JOBS=2] [DOCS=1]
	@$(BIN)/python -m studies.variants --jobs $(JOBS) $(if $(QUICK),--quick) $(if $(DOCS),--docs)

study-real-crowds: $(READY)  ## real crowds beside simulated ones: make study-real-crowds DATA=folder [QUICK=1] [JOBS=2]
	@$(BIN)/python -m studies.real_crowds --jobs $(JOBS) $(if $(QUICK),--quick) $(if $(DATA),--data '$(DATA)')

bench: $(READY)  ## this engine beside its peers: make bench [QUICK=1]; .venv/bin/pip install -e '.[bench]' brings them
	@$(BIN)/python -m studies.bench $(if $(QUICK),--quick) $(if $(DOCS),--docs)

stress: $(READY)  ## the engine at its edges and 10,000 random scenes: make stress [QUICK=1] [JOBS=2]
	@$(BIN)/python -m studies.stress --jobs $(JOBS) $(if $(QUICK),--quick) $(if $(DOCS),--docs)

torture: $(READY)  ## sweeps that are killed, damaged, spread and large: make torture [QUICK=1]
	@$(BIN)/python -m studies.torture $(if $(QUICK),--quick)

notebooks: $(READY)  ## run studies/notebooks; as .ipynb and .html in results/notebooks
	@$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[notebooks]'
	@.ci/notebooks

package: $(READY)  ## wheel and sdist in dist/, each tried in an empty environment [QUICK=1]
	@QUICK=$(QUICK) .ci/package

test-%: $(READY)  ## some tests with other versions: make test-minimum, make test-newest [QUICK=1] [JOBS=2]
	@QUICK=$(QUICK) JOBS=$(JOBS) .ci/versions $*

test: $(READY)  ## all tests
	@$(BIN)/python -m pytest -n $(JOBS) --dist loadfile

lint: $(READY)  ## style, layers, types
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/lint-imports --no-cache
	@$(BIN)/mypy

docs: $(READY)  ## the documentation in docs/_build/html/index.html
	@$(BIN)/python -c 'import furo, myst_parser' 2>/dev/null || \
	  $(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[docs]'
	@$(BIN)/sphinx-build --quiet --fresh-env --fail-on-warning --keep-going docs docs/_build/html
	@echo docs/_build/html/index.html

constraints: $(READY)  ## pin what is installed now
	@$(BIN)/pip freeze --exclude-editable > constraints.txt

clean:  ## remove the environment (results stay)
	rm -rf $(VENV)
