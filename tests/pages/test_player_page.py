"""The page that plays a run, as a file: whole, self-contained, and true to the run."""

import base64
import re
import zlib
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from engine import BadInput, rooms, simulate
from sweep import to_dataset
from sweep.pages import player_page
from sweep.pages.motion import common_top, speeds, thinned
from sweep.pages.packing import NOTHING, in_multiples, packed
from sweep.pages.touching import contacts_of


def unpacked(block: dict[str, Any]) -> np.ndarray:
    """Numbers of a block by another way than the page's."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(block["base64"])), np.uint8)
    zigzag = planes.reshape(4, -1).T.copy().view("<u4").ravel().astype(np.int64)
    numbers = np.where(zigzag % 2, -(zigzag + 1) // 2, zigzag // 2).reshape(block["shape"])
    if block["differences"]:
        numbers = (np.cumsum(numbers, axis=-1) + 2**31) % 2**32 - 2**31
    return numbers


@given(st.lists(st.integers(-(2**31), 2**31 - 1), min_size=1, max_size=30), st.booleans())
def test_numbers_packed_are_the_numbers_unpacked(numbers: list[int], differences: bool) -> None:
    rows = np.array([numbers, numbers[::-1]], dtype=np.int32)
    assert unpacked(packed(rows, differences)).tolist() == rows.tolist()


def test_what_is_not_finite_is_nothing_and_the_rest_is_within_half_a_multiple() -> None:
    values = np.array([0.0, 1.2344, -7.0006, np.nan, np.inf])
    multiples = in_multiples(values, 1e-3)
    assert multiples.tolist() == [0, 1234, -7001, NOTHING, NOTHING]


def test_a_page_fetches_nothing(jam: xr.Dataset) -> None:
    page = player_page(jam)
    assert re.findall(r"""\b(?:src|href|action)\s*=|url\(|@import|https?://|\bfetch\(""", page) == []
    assert "default-src 'none'" in page
    assert "{{" not in page.split("<script", 1)[0]


def test_what_a_file_says_of_itself_is_text_and_no_tag(walk: xr.Dataset) -> None:
    page = player_page(walk.assign_attrs(comment="</script><b>x</b>{{title}}", engine_fingerprint="<i>"))
    assert "</script><b>" not in page
    assert page.count("</script>") == 2
    assert "<dd>&lt;i&gt;</dd>" in page


def test_contacts_found_from_positions_are_those_the_engine_recorded(jam: xr.Dataset) -> None:
    """Positions of the full state are stored as float32: who touches by less than a micrometre may differ."""
    without = jam.drop_dims("contact").drop_vars("row_size")
    recorded, found = contacts_of(jam), contacts_of(without)
    assert (recorded.recorded, found.recorded) == (True, False)

    def keys(contacts: Any) -> set[tuple[int, int, int]]:
        sample = np.repeat(np.arange(contacts.row_size.size), contacts.row_size)
        pair = contacts.j >= 0
        i, j = np.where(pair, np.minimum(contacts.i, contacts.j), contacts.i), np.maximum(contacts.i, contacts.j)
        return set(zip(sample.tolist(), i.tolist(), np.where(pair, j, contacts.j).tolist(), strict=True))

    assert len(keys(recorded)) > 1000
    assert len(keys(recorded) ^ keys(found)) <= 0.002 * len(keys(recorded))


def test_the_force_of_a_contact_is_hertz_of_its_overlap_and_its_damping(jam: xr.Dataset) -> None:
    """Lin et al. (2016), Eq. 3: sqrt(overlap R) (k_n overlap - m g_n v_n), k_n = 2 E/(3 (1 - poisson^2)).

    As if velocities were nil: nobody parts faster than two of the fastest. Positions are stored to a micrometre.
    """
    contacts = contacts_of(jam)
    k, k_n, g_n = 80, 2 * 5e6 / (3 * (1 - 0.25**2)), 0.8
    at = slice(int(contacts.row_size[:k].sum()), int(contacts.row_size[: k + 1].sum()))
    x, y, radius, mass = jam.x.values[k], jam.y.values[k], jam.radius.values, jam.mass.values
    fastest = float(np.hypot(jam.vx, jam.vy)[k].max())
    seen = {"persons": 0, "wall": 0}
    for i, j, force in zip(contacts.i[at], contacts.j[at], contacts.force[at], strict=True):
        if j >= 0:
            overlap, R = radius[i] + radius[j] - np.hypot(x[i] - x[j], y[i] - y[j]), radius[i] * radius[j]
            R /= radius[i] + radius[j]
            seen["persons"] += 1
        else:  # the right wall, x = 7 m, which all walk to
            overlap, R = radius[i] - (7.0 - x[i]), radius[i]
            if not (y[i] < 3.0 or y[i] > 4.0) or overlap <= 0:
                continue
            seen["wall"] += 1
        alpha = np.sqrt(max(overlap, 0.0) * R)
        allowed = alpha * (mass[i] * g_n * 2 * fastest + 1.5 * k_n * 2e-6)
        assert force == pytest.approx(alpha * k_n * overlap, abs=allowed, rel=0.0)
    assert min(seen.values()) > 0


def test_without_recorded_forces_there_are_contacts_but_no_forces(jam: xr.Dataset) -> None:
    strange = jam.drop_vars("contact_F_n")
    assert contacts_of(strange).force is None
    for run, said in ((strange, True), (jam, False)):
        assert ("<dd>not recorded</dd>" in player_page(run)) is said


def test_speed_without_velocities_is_the_way_to_the_next_sample_or_from_the_last() -> None:
    positions = xr.Dataset(
        {
            "x": (("sample", "person"), [[0.0, 1.0], [0.3, 1.0], [0.9, np.nan]]),
            "y": (("sample", "person"), [[0.0, 1.0], [0.4, 1.5], [1.2, np.nan]]),
            "time": ("sample", [0.0, 0.5, 1.0]),
        }
    )
    assert speeds(positions) == pytest.approx(np.array([[1.0, 1.0], [2.0, 1.0], [2.0, np.nan]]), nan_ok=True)


def test_thinned_samples_keep_their_own_contacts(jam: xr.Dataset) -> None:
    few = thinned(jam, 5)
    starts = np.concatenate([[0], np.cumsum(jam.row_size.values)])
    wanted = np.concatenate([jam.contact_i.values[starts[k] : starts[k + 1]] for k in range(0, jam.sizes["sample"], 5)])
    assert few.time.values.tolist() == jam.time.values[::5].tolist()
    assert few.contact_i.values.tolist() == wanted.tolist()


def test_a_scale_ends_at_a_round_number_above_nearly_all() -> None:
    assert common_top(np.array([0.0, np.nan, *np.linspace(0.01, 1.31, 500)]), 0.1) == 1.5
    assert common_top(np.zeros(3), 100.0) == 100.0


def test_a_run_without_samples_says_how_to_record() -> None:
    run = to_dataset(simulate(rooms.lin_room(N=3, size=4.0, time_limit=1.0)))
    with pytest.raises(BadInput, match=r"has no samples to play: run it again with `--record-every 0\.1`"):
        player_page(run)
