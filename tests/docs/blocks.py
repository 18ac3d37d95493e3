"""Code blocks of Markdown pages, and what is done with each."""

import re
import shlex
import subprocess
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from markdown_it import MarkdownIt

from sweep import cli
from sweep.gridfile import read_gridfile, read_until

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES = [page for page in PAGES if "_build" not in page.parts]
FILE = re.compile(r"# (\S+\.(?:toml|py))\n")  # the first line of a block that is a file
SHELL = ("", "shell", "console", "bash", "sh")  # an indented block names no language
EXTRAS = re.compile(r"(?:jamsweep|\.)\[([\w,-]+)\]")
NOT_HERE = {"git": "needs a network", ".": "changes the shell that it is given to", "cd": "the same"}


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
    """Execute the blocks of a page in order, in this folder, which must be the working directory, and tests in them."""
    namespace: dict[str, Any] = {"__name__": "__main__"}
    for block in blocks(page):
        if block.language in SHELL:
            for line in _lines(block.code):
                command(line)
        elif block.language == "toml":
            grid_file(block.code, folder)
        elif block.language == "python":
            if name := FILE.match(block.code):
                (folder / name[1]).write_text(block.code, "utf-8")
            exec(compile(block.code, f"{page}, block at line {block.line}", "exec"), namespace)
        else:
            assert block.language == "text", f"{page}: nothing is known about {block.language!r}"
    for test in [value for name, value in namespace.items() if name.startswith("test_")]:
        test()


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
    name = FILE.match(code)
    assert name, "the first line of a grid file is its name, such as `# grid.toml`"
    path = folder / name[1]
    path.write_text(code, "utf-8")
    read_gridfile(path)
    read_until(path)
