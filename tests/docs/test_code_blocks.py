"""All code blocks of README, CONTRIBUTING and the documentation work as printed."""

from pathlib import Path

import pytest

from tests.docs.blocks import PAGES, ROOT, blocks, command, execute, grid_file

MOST_TEXT = 3  # blocks on all pages that nothing executes
PRINTED = {
    "README.md": ("all 100 persons were out", "Name: blocked_share, dtype: float64"),
    "docs/law.md": ("all 10 persons were out",),
    "docs/numerics.md": ("stiffness of the contacts",),
    "docs/study.md": ("a wider exit is faster",),
}


def name_of(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_the_blocks_of_a_page_work_in_order(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    execute(page, tmp_path)
    printed = capsys.readouterr().out
    for words in PRINTED.get(name_of(page), ()):
        assert words in printed


def test_the_readmes_ten_lines_are_ten():
    (block,) = (block for block in blocks(ROOT / "README.md") if block.language == "python")
    assert len([line for line in block.code.splitlines() if line.strip()]) <= 10


def test_what_is_not_executed_is_rare_and_says_why():
    texts = [(name_of(page), block) for page in PAGES for block in blocks(page) if block.language == "text"]
    assert len(texts) <= MOST_TEXT
    for page, block in texts:
        assert len(block.words.split()) >= 3, f"{page}, line {block.line}: write ```text and the reason"


def test_blocks_in_lists_and_indented_ones_are_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("1. one\n\n   ```python\n   x = 1\n   ```\n\ntwo\n\n    make test\n\n```{toctree}\nthree\n```\n")
    assert [(block.language, block.code) for block in blocks(page)] == [("python", "x = 1\n"), ("", "make test\n")]


def test_an_example_that_fails_fails_its_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = tmp_path / "page.md"
    page.write_text("```python\nx = 1\n```\n\nand\n\n```python\nassert x == 2\n```\n")
    with pytest.raises(AssertionError):
        execute(page, tmp_path)


@pytest.mark.parametrize(
    "line",
    [
        "make no-such-target",
        "make study-of-nothing",
        "jamsweep study of-nothing",
        "jamsweep run lin_room --no-such-option 1",
        "jamsweep status nowhere",
        "pip install 'jamsweep[no-such-extra]'",
        "rm -rf results",
    ],
)
def test_a_command_that_does_not_work_is_an_error(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AssertionError):
        command(line)


def test_a_grid_file_with_an_unknown_keyword_is_an_error(tmp_path):
    with pytest.raises(ValueError, match="speed"):
        grid_file('# grid.toml\nroom = "lin_room"\nstore = "here"\n[axes]\nspeed = [1.0]\n', tmp_path)


def test_a_block_that_is_a_file_is_there_for_commands_and_a_test_in_a_block_is_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = tmp_path / "page.md"
    page.write_text("```python\n# rooms.py\nsize = 3\n```\n\n```python\ndef test_it():\n    assert size == 4\n```\n")
    with pytest.raises(AssertionError):
        execute(page, tmp_path)
    assert (tmp_path / "rooms.py").read_text() == "# rooms.py\nsize = 3\n"
