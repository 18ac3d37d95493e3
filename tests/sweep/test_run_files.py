"""What a run file holds."""

from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

from engine import OUTCOMES, BadInput, Run, Scenario, rooms, simulate
from sweep import read_run, to_dataset, write_run
from sweep.schema import SCHEMA_VERSION, run_key


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(rooms.lin_room(N=12, size=4.0, v_d=1.4, time_limit=4.0, record_every=0.5, contacts=True))


@pytest.fixture(scope="module")
def path(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("one") / "run.nc"
    write_run(run, path)
    return path


def test_a_file_reads_back_as_the_dataset_of_its_run(run: Run, path: Path) -> None:
    xr.testing.assert_identical(read_run(path), to_dataset(run))


def test_the_facts_of_the_run_are_stored_exactly(run: Run, path: Path) -> None:
    ds = read_run(path)
    assert np.array_equal(ds.exit_time, run.exit_time)
    assert 0 < run.N_out < run.N
    assert np.array_equal(ds.exit_person, run.exit_person)
    assert np.array_equal(ds.v_d_person, run.start.v_d)
    assert np.array_equal(ds.x0, run.start.x)
    assert OUTCOMES[int(ds.outcome)] == run.outcome == ds.outcome.flag_meanings.split()[int(ds.outcome)]
    assert (int(ds.N_out), int(ds.persons), float(ds.end_time)) == (run.N_out, run.N, run.end_time)


def test_ragged_counts_add_up_to_the_elements(run: Run, path: Path) -> None:
    with netCDF4.Dataset(path) as file:
        counters = {v.sample_dimension: v for v in file.variables.values() if "sample_dimension" in v.ncattrs()}
        assert {name: int(v[:].sum()) for name, v in counters.items()} == {
            name: file.dimensions[name].size for name in ("exit", "contact")
        }
        assert file["row_size"].dimensions == ("sample",)
        assert file.dimensions["contact"].size > 0
        assert np.array_equal(file["row_size"][:], run.samples.row_size)


def test_every_variable_has_a_filter_units_and_a_description(path: Path) -> None:
    with netCDF4.Dataset(path) as file:
        for variable in file.variables.values():
            assert variable.filters()["zlib"] or variable.filters()["fletcher32"]
            assert variable.units
            assert variable.long_name


def test_a_file_says_how_it_was_made(run: Run, path: Path) -> None:
    with netCDF4.Dataset(path) as file:
        assert Scenario.from_json(file.scenario) == run.scenario.with_options(**run.scenario.numerics._asdict())
        assert (file.run_key, file.schema_version, file.complete) == (
            run_key(run.scenario),
            SCHEMA_VERSION,
            1,
        )
        assert file.Conventions == "CF-1.11"


def test_a_run_without_exits_and_without_samples_is_stored_too(tmp_path: Path) -> None:
    run = simulate(rooms.lin_room(N=3, size=4.0, time_limit=0.01))
    write_run(run, tmp_path / "run.nc")
    ds = read_run(tmp_path / "run.nc")
    assert ds.sizes["exit"] == 0
    assert "x" not in ds
    assert "row_size" not in ds
    xr.testing.assert_identical(ds, to_dataset(run))


def test_samples_without_contacts_have_no_contact_variables(tmp_path: Path) -> None:
    ds = to_dataset(simulate(rooms.lin_room(N=3, size=4.0, time_limit=0.1, record_every=0.05)))
    assert ds.x.dims == ("sample", "person")
    assert ds.x.dtype == np.float32
    assert not {"row_size", "contact_i"} & set(ds.variables)


def test_equal_runs_make_equal_files(run: Run, path: Path, tmp_path: Path) -> None:
    write_run(simulate(run.scenario), tmp_path / "again.nc")
    assert (tmp_path / "again.nc").read_bytes() == path.read_bytes()


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"nowhere\.nc' does not exist"):
        read_run(tmp_path / "nowhere.nc")
