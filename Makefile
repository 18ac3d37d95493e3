# jamsweep: `make study-fig10` and `make test` work as the first command after a clone.
PYTHON ?= python3
JOBS ?= 2
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready

.PHONY: help setup test lint clean
.DEFAULT_GOAL := help

help:  ## this list
	@grep -hE '^[a-z%-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 16

setup: $(READY)  ## the environment in .venv, from pinned versions

$(READY): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "$(PYTHON) is older than Python 3.11: install one and say make PYTHON=python3.11"; exit 2; }
	@test -x $(BIN)/pip || $(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
	  echo "Python cannot make a virtual environment: on Debian, apt-get install python3-venv"; exit 2; }
	@echo "setting up $(VENV) ..."
	@$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	@touch $@

study-%: $(READY)  ## reproduce a figure: make study-fig10 [QUICK=1] [JOBS=2]
	@$(BIN)/jamsweep study $* --jobs $(JOBS) $(if $(QUICK),--quick)

test: $(READY)  ## all tests
	@$(BIN)/python -m pytest

lint: $(READY)  ## style, layers, types
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/lint-imports --no-cache
	@$(BIN)/mypy

clean:  ## remove the environment (results stay)
	rm -rf $(VENV)
