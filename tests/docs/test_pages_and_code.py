"""What pages list by hand is what the code has."""

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from engine import models, simulate
from engine.rooms import ROOMS, lin_room, parisi_room
from sweep import Grid, schema, sweep
from sweep.commands.export import TABLES, TRAJECTORIES

DOCS = Path(__file__).parents[2] / "docs"
TINY = {"N": 5, "size": 4.0, "time_limit": 2.0}


def rows(page: str, before: str) -> Iterator[list[str]]:
    """Cells of the first table after these words."""
    text = (DOCS / page).read_text("utf-8").partition(before)[2]
    lines = text[text.index("\n| ") :].strip().split("\n\n")[0].splitlines()
    return ([cell.strip() for cell in line[1:-1].split("|")] for line in lines[2:])


def words(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


def first_words(page: str, before: str) -> list[str]:
    return [word for row in rows(page, before) for word in words(row[0])]


def test_the_dimensions_of_a_run_are_listed():
    known = {dim for variable in schema.VARIABLES for dim in variable.dims}
    assert set(first_words("data.md", "run.identical")) == known


def test_the_attributes_of_a_run_file_are_listed():
    listed = first_words("data.md", "Attributes of the file:")
    assert listed == list(schema.run_attributes(simulate(lin_room(**TINY))))


def test_the_attributes_of_a_dataset_are_listed(tmp_path):
    ds = sweep(Grid(lin_room, seed=[0], **TINY), tmp_path / "store", jobs=1, progress=False)
    assert set(first_words("data.md", "Attributes of a dataset:")) == {*ds.attrs, "accepted_engines"}


def test_the_files_of_exports_are_listed():
    assert set(first_words("data.md", "## Exports")) | {".hdf5"} == {*TRAJECTORIES, *TABLES}


def test_every_keyword_of_every_room_has_a_unit_and_a_name():
    keywords = {name for room in ROOMS.values() for name in inspect.signature(room).parameters}
    assert keywords <= set(schema.PARAMETERS)


def test_every_friction_is_listed():
    assert first_words("models.md", "### What the paper leaves open") == list(models.FRICTION)


@pytest.mark.parametrize(("before", "room"), [("**Walls** act by", lin_room), ("## Parisi & Dorso", parisi_room)])
def test_the_parameters_of_a_model_are_the_defaults_of_its_room(before, room):
    defaults = {name: p.default for name, p in inspect.signature(room).parameters.items()}
    listed = 0
    for _, names, values in rows("models.md", before):
        for name, value in zip(words(names), values.split(", ") if words(names) else [], strict=True):
            assert float(value.split()[0]) == defaults[name], name
            listed += 1
    assert listed >= 9
