"""Code blocks of Markdown pages, and what is done with each."""

import importlib
import inspect
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from engine.dispatch import Generic
from markdown_it import MarkdownIt

from engine import laws
from sweep import cli
from sweep.gridfile import read_gridfile, read_until

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES = [page for page in PAGES if "_build" not in page.parts]
LAW = re.compile(r"^@(\w+)\.law\(", re.MULTILINE)
SHELL = ("", "shell", "console", "bash", "sh")  # an indented block names no language
EXTRAS = re.compile(r"(?:jamsweep|\.)\[([\w,-]+)\]")
NOT_HERE = {"git": "needs a network", ".": "changes the shell that it is given to", "cd": "the same"}
LAW_TYPE = re.compile(r"^class (\w+)\(NamedTuple\)", re.MULTILINE)
COMPILED = {"CONTRIBUTING.md"}  # pages whose laws are compiled into a whole kernel, which takes half a minute
ALONE = """
import inspect
from numba import njit
from engine import laws
for generic in {generic for kind in laws.KINDS.values() for generic in kind}:
    for law in [law for law in generic.laws if law.__name__ in NAMES]:
        words = ", ".join(inspect.signature(inspect.unwrap(generic)).parameters)
        arguments = law(*[0.5] * len(law._fields)), *[0.5] * words.count(",")
        assert njit(eval(f"lambda {words}: generic({words})", {"generic": generic}))(*arguments) == generic(*arguments)
"""


class Block(NamedTuple):
    """A code block."""

    language: str
    words: str  # beside the language
    code: str
    line: int  # of the page, its first


def blocks(page: Path) -> list[Block]:
    """All code blocks of a page but directives of Sphinx, which its build checks."""
    tokens = MarkdownIt().parse(page.read_text("utf-8"))
    found = (token for token in tokens if token.type in ("fence", "code_block") and not token.info.startswith("{"))
    return [_block(token.info, token.content, (token.map or [0])[0] + 1) for token in found]


def _block(info: str, code: str, line: int) -> Block:
    language, _, words = info.strip().partition(" ")
    return Block(language, words.strip(), code, line)


def execute(page: Path, folder: Path) -> None:
    """Execute the blocks of a page in order, in this folder, which must be the working directory."""
    found = blocks(page)
    adds_laws = any(LAW.search(block.code) for block in found)
    namespace: dict[str, Any] = {"__name__": "__main__"}
    for block in found:
        if block.language in SHELL:
            for line in _lines(block.code):
                command(line)
        elif block.language == "toml":
            grid_file(block.code, folder)
        elif block.language == "python" and not adds_laws:
            exec(compile(block.code, f"{page}, block at line {block.line}", "exec"), namespace)
        else:
            assert block.language in ("python", "text"), f"{page}: nothing is known about {block.language!r}"
    if adds_laws:
        print(with_laws(page, [block.code for block in found if block.language == "python"], folder))


def _lines(code: str) -> Iterator[str]:
    for line in code.replace("\\\n", " ").splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            yield line.strip().removeprefix("$ ")


def command(line: str) -> None:
    """Execute or check a line for the shell; one that nothing is known about is an error."""
    words = shlex.split(line, comments=True)
    check = {"make": _make, "jamsweep": _jamsweep, "pip": _pip, ".venv/bin/pip": _pip}.get(words[0])
    assert check or words[0] in NOT_HERE, f"nothing is known about `{line}`: use a block of text, with its reason"
    if check:
        check(words[1:])


def _make(words: list[str]) -> None:
    """The target is there, and so is the study that it runs: `study-%` takes any name."""
    said = subprocess.run(["make", "-n", *words], cwd=ROOT, capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    for name in re.findall(r"jamsweep study (\S+)", said.stdout):
        _study(name)


def _study(name: str) -> None:
    assert name.removeprefix("lin-") in cli._studies(), f"no study {name}"


def _jamsweep(words: list[str]) -> None:
    if words[0] == "study":
        _study(words[1])
        return
    with pytest.raises(SystemExit) as end:
        cli.main(words)
    assert not end.value.code, f"`jamsweep {shlex.join(words)}` ended with exit code {end.value.code}"


def _pip(words: list[str]) -> None:
    """The extras that are named are there; nothing is installed."""
    asked = {extra for word in words for names in EXTRAS.findall(word) for extra in names.split(",")}
    known = set(metadata.metadata("jamsweep").get_all("Provides-Extra") or [])
    assert asked <= known, f"no extra {', '.join(asked - known)}"


def grid_file(code: str, folder: Path) -> None:
    """A grid file is valid, and lies in the folder under the name in its first line."""
    name = re.match(r"# (\S+\.toml)\n", code)
    assert name, "the first line of a grid file is its name, such as `# grid.toml`"
    path = folder / name[1]
    path.write_text(code, "utf-8")
    read_gridfile(path)
    read_until(path)


def with_laws(page: Path, codes: list[str], folder: Path) -> str:
    """Run the blocks of a page that adds laws, and the tests in them, in a copy of the engine that has those laws.

    A block that registers a law goes to the end of the file of its kind. Where the kernel is not compiled, the laws
    are: alone.
    """
    shutil.copytree(ROOT / "engine", folder / "engine", ignore=shutil.ignore_patterns("__pycache__"))
    added = [code for code in codes if LAW.search(code)]
    for code in added:
        path = folder / f"{_module_of(code).replace('.', '/')}.py"
        path.write_text(f"{path.read_text('utf-8')}\n\n{code}", "utf-8")
    script = "\n".join(code for code in codes if code not in added)
    script += "\nfor name in [name for name in globals() if name.startswith('test_')]:\n    globals()[name]()\n"
    if page.name in COMPILED:
        return _in_copy(script, folder, NUMBA_OPT="1")  # compiling takes longer than running
    _in_copy(f"NAMES = {LAW_TYPE.findall(''.join(added))}{ALONE}", folder)
    return _in_copy(script, folder, NUMBA_DISABLE_JIT="1")


def _in_copy(script: str, folder: Path, **variables: str) -> str:
    """What a script prints in a folder that has an engine of its own; a warning is an error."""
    own = {"NUMBA_CACHE_DIR": str(folder / "cache"), "NUMBA_NUM_THREADS": "1", "PYTHONPATH": str(folder)}
    run = [sys.executable, "-W", "error", "-c", script]
    done = subprocess.run(run, cwd=folder, env=os.environ | own | variables, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def _module_of(code: str) -> str:
    """The module that has the generic functions which a block registers laws of."""
    generics = [getattr(laws, name) for name in LAW.findall(code)]
    modules = {inspect.unwrap(generic).__module__ for generic in generics if isinstance(generic, Generic)}
    assert len(modules) == 1, f"laws of one block belong into {modules}"
    return importlib.import_module(modules.pop()).__name__
