"""The page that plays a run, in a real browser: it shows what the run did, and obeys."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from studies.measures.arches import blocking_clusters
from sweep.pages.motion import force_on_each
from sweep.pages.touching import contacts_of
from tests.pages.browser import Browser

Show = Callable[[xr.Dataset], Browser]
BOX = "((box) => [box.left, box.top, box.width, box.height])(document.getElementById('%s').getBoundingClientRect())"


def inside(run: xr.Dataset, time: float) -> int:
    return run.sizes["person"] - int((run.exit_time <= time).sum())


def test_the_page_opens_from_disk_alone_and_nothing_complains(playing: Browser) -> None:
    playing.press("End")
    assert playing.errors == []
    assert [url.partition(":")[0] for url in playing.requests] == ["file"]


def test_it_begins_by_itself_and_stops_at_the_end(show: Show, walk: xr.Dataset) -> None:
    browser = show(walk)
    browser.call("Page.reload")
    browser.wait("window.player && player.state().time > 0.2 && player.state().playing")
    browser.value("player.setRate(32)")
    browser.wait("!player.state().playing")
    state = browser.value("player.state()")
    assert state["time"] == pytest.approx(float(walk.end_time))
    assert (state["inside"], state["shown"]) == (0, 0)


def test_who_wants_no_motion_gets_none_unasked(browser: Browser, show: Show, jam: xr.Dataset) -> None:
    quiet = [{"name": "prefers-reduced-motion", "value": "reduce"}]
    browser.call("Emulation.setEmulatedMedia", features=quiet)
    show(jam)
    browser.call("Page.reload")
    browser.wait("window.player && player.state().frames")
    standing = browser.value("player.state().playing"), browser.value("player.state().time")
    browser.call("Emulation.setEmulatedMedia", features=[])
    assert standing == (False, 0)


def test_keys_move_by_samples_to_the_ends_and_change_the_speed(playing: Browser, jam: xr.Dataset) -> None:
    seen = []
    for key in ("ArrowRight", "ArrowRight", "ArrowLeft", "End", "ArrowLeft", "Home"):
        playing.press(key)
        seen.append(playing.value("player.state().sample"))
    last = jam.sizes["sample"] - 1
    assert seen == [1, 2, 1, last, last - 1, 0]
    playing.press("+")
    assert playing.value("player.state().rate") == 2
    playing.press("-")
    playing.press("-")
    assert playing.value("[player.state().rate, document.getElementById('rate').value]") == [0.5, "0.5"]
    playing.press(" ")
    playing.wait("player.state().playing && player.state().time > 0")
    playing.press(" ")
    assert not playing.value("player.state().playing")


def test_a_back_step_between_samples_goes_to_the_sample_just_passed(playing: Browser) -> None:
    playing.value("player.seek(1.05)")
    playing.press("ArrowLeft")
    assert playing.value("player.state().time") == pytest.approx(1.0)


def test_the_slider_and_the_curve_can_be_dragged(playing: Browser, jam: xr.Dataset) -> None:
    left, top, width, height = playing.value(BOX % "time")
    middle = top + height / 2
    playing.drag((left + 8, middle), (left + width / 4, middle), (left + width / 2, middle))
    half = playing.value("player.state().time")
    assert half == pytest.approx(float(jam.time[-1]) / 2, rel=0.05)
    left, top, width, height = playing.value(BOX % "curve")
    playing.drag((left + width / 2, top + 40), (left + width - 2, top + 40))
    assert playing.value("player.state().time") == pytest.approx(float(jam.end_time))


def test_as_many_persons_are_shown_and_counted_as_the_run_has(playing: Browser, jam: xr.Dataset) -> None:
    for k in range(0, jam.sizes["sample"], 7):
        time = float(jam.time[k])
        playing.value(f"player.seek({time})")
        playing.wait(f"player.state().sample === {k} && document.getElementById('now').textContent === '{time:.1f} s'")
        state = playing.value("player.state()")
        assert state["shown"] == int(np.isfinite(jam.x[k]).sum())
        assert state["inside"] == inside(jam, time)
        assert state["lines"] == int(jam.row_size[k])


def test_somebody_who_leaves_between_samples_walks_to_the_door_and_is_gone(playing: Browser, jam: xr.Dataset) -> None:
    person, time = int(jam.exit_person[0]), float(jam.exit_time[0])
    place = f"Array.from(player.view.places.slice({2 * person}, {2 * person + 2}))"
    playing.value(f"player.seek({time - 1e-4})")
    playing.screenshot()
    assert playing.value(place) == pytest.approx([float(jam.exit_x[0]), float(jam.exit_y[0])], abs=5e-3)
    playing.value(f"player.seek({time})")
    playing.screenshot()
    assert playing.value(f"Number.isNaN(player.view.places[{2 * person}])")
    assert playing.value("player.state().inside") == inside(jam, time) == jam.sizes["person"] - 1


def test_discs_are_drawn_where_persons_are_and_as_large(playing: Browser, jam: xr.Dataset) -> None:
    """Pixels of the screenshot, the colours being the speeds' on the map of the page."""
    playing.value("player.paint('light'), player.toggle('contacts'), player.toggle('arches')")
    picture = playing.screenshot().astype(int)
    persons = range(0, jam.sizes["person"], 3)
    for i in persons:
        colour = playing.value(f"player.colourOf({i})")
        x, y, radius = playing.value(f"player.screenOf({i})")
        assert np.abs(picture[round(y), round(x)] - colour).max() <= 2
        assert np.abs(picture[round(y), round(x + 0.8 * radius)] - colour).max() <= 2
    left, top, _, _ = playing.value(BOX % "room")
    assert picture[round(top) + 60, round(left) + 20].tolist() == [255, 255, 255]


def test_colours_follow_the_speed_or_the_force(playing: Browser, jam: xr.Dataset) -> None:
    k = 60
    force = force_on_each(contacts_of(jam), jam.sizes["person"])[k]
    speed = np.hypot(jam.vx, jam.vy)[k]
    playing.value(f"player.seek({float(jam.time[k])})")
    playing.press("f")
    playing.screenshot()
    assert playing.value("player.state().colour") == "force"
    shown = playing.value("Array.from(player.view.forces)")
    assert shown == pytest.approx(force.tolist(), abs=5)  # whole newtons a contact
    for i in np.flatnonzero(np.isfinite(speed))[:10]:
        assert playing.value(f"player.recording.speedOf({i}, {k})") == pytest.approx(float(speed[i]), abs=6e-4)


@pytest.mark.parametrize("name", ["jam", "walking_on"])
def test_arches_are_those_that_the_measures_find(show: Show, name: str, request: pytest.FixtureRequest) -> None:
    run: xr.Dataset = request.getfixturevalue(name)
    browser, found = show(run), blocking_clusters(run)
    sizes = found.path_size.values
    paths = np.split(found.path_person.values, np.cumsum(sizes)[:-1])
    arches = browser.value(f"Array.from({{length: {run.sizes['sample']}}}, (_, k) => player.arches.at(k))")
    assert [at[0]["persons"] if at else [] for at in arches] == [path.tolist() for path in paths]
    assert [any(arch["clean"] for arch in at) for at in arches] == found.clean.values.tolist()
    assert 0 < found.clean.sum() < found.clean.size


def test_who_has_crossed_the_door_holds_no_arch(show: Show) -> None:
    """Two persons between the sides of a door; the second one crosses it between the samples and walks on."""
    run = xr.Dataset(
        {
            "x": (("sample", "person"), [[4.9, 5.1], [4.9, 5.1]]),
            "y": (("sample", "person"), [[2.25, 2.75], [2.25, 2.75]]),
            "wall": (("wall", "end"), [[5.0, 0.0, 5.0, 2.0], [5.0, 3.0, 5.0, 5.0]]),
            "door": (("door", "end"), [[5.0, 2.0, 5.0, 3.0]]),
            "exit_time": ("exit", [0.05]),
            "exit_person": ("exit", [1]),
            "exit_x": ("exit", [5.0]),
            "exit_y": ("exit", [2.75]),
            "exit_door": ("exit", [0]),
            **{
                name: ("person", [value] * 2)
                for name, value in {"radius": 0.3, "mass": 70.0, "v_d_person": 1.0}.items()
            },
            "row_size": ("sample", [3, 3]),
            "contact_i": ("contact", [0, 0, 1] * 2),
            "contact_j": ("contact", [1, -1, -2] * 2),
            "outcome": 4,
            "end_time": 0.1,
        },
        {"time": ("sample", [0.0, 0.1])},
    )
    arches = show(run).value("[0, 1].map((k) => player.arches.at(k))")
    assert [at[0]["persons"] if at else [] for at in arches] == [[0, 1], []]
    assert blocking_clusters(run).path_size.values.tolist() == [2, 0]


def test_between_samples_persons_are_between_their_positions(playing: Browser, jam: xr.Dataset) -> None:
    k = 10
    playing.value(f"player.seek({float(jam.time[k]) + 0.03})")
    playing.screenshot()
    places = np.array(playing.value("Array.from(player.view.places, (place) => place ?? NaN)"), dtype=float)
    for name, shown in (("x", places[::2]), ("y", places[1::2])):
        wanted = jam[name].values[k] + 0.3 * (jam[name].values[k + 1] - jam[name].values[k])
        good = np.isfinite(wanted)
        assert np.abs(shown - wanted)[good].max() <= 0.6e-3
    assert np.hypot(*(jam[n].values[k + 1] - jam[n].values[k] for n in ("x", "y")))[good].max() > 0.1


def test_a_click_chooses_a_person_and_the_wheel_keeps_its_place(playing: Browser) -> None:
    x, y, _ = playing.value("player.screenOf(7)")
    playing.drag((x, y), (x, y))
    playing.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-400)
    playing.wait("player.state().zoom > 2")
    assert playing.value("player.state().selected") == 7
    playing.wait("document.getElementById('chosen').textContent.startsWith('person 7: ')")
    assert playing.value("player.screenOf(7).slice(0, 2)") == pytest.approx([x, y], abs=2)
    playing.press("0")
    playing.press("Escape")
    assert playing.value("[player.state().zoom, player.state().selected]") == [1, -1]


def test_a_sharp_screen_and_another_size_get_their_pixels(playing: Browser) -> None:
    metrics = {"width": 900, "height": 700, "deviceScaleFactor": 2, "mobile": False}
    playing.call("Emulation.setDeviceMetricsOverride", **metrics)
    size = "(({width, clientWidth}) => [width, clientWidth])(document.getElementById('room'))"
    playing.wait(f"{size}[0] === 2 * {size}[1]")
    whole = playing.value("document.documentElement.scrollWidth <= innerWidth")
    playing.call("Emulation.clearDeviceMetricsOverride")
    playing.wait(f"{size}[0] === {size}[1]")
    assert whole


def test_another_resolution_alone_gets_its_pixels(playing: Browser) -> None:
    """As a window moves to another screen: the size in CSS pixels stays."""
    size = "(({width, clientWidth}) => [width, clientWidth])(document.getElementById('room'))"
    metrics = {"width": 900, "height": 700, "mobile": False}
    for ratio in (1, 2, 3, 1):
        playing.call("Emulation.setDeviceMetricsOverride", **metrics, deviceScaleFactor=ratio)
        playing.wait(f"{size}[0] === {ratio} * {size}[1]")
    playing.call("Emulation.clearDeviceMetricsOverride")


def test_every_control_has_a_name(playing: Browser) -> None:
    nodes = playing.call("Accessibility.getFullAXTree")["nodes"]
    roles = ("button", "slider", "combobox", "radio", "checkbox", "image")
    names = [(n["role"]["value"], n["name"]["value"]) for n in nodes if n.get("role", {}).get("value") in roles]
    assert {role for role, _ in names} == set(roles)
    assert [role for role, name in names if not name.strip()] == []


def test_a_run_of_positions_alone_plays_with_contacts_found_from_them(show: Show, walk: xr.Dataset) -> None:
    browser = show(walk)
    browser.press("ArrowRight")
    assert browser.errors == []
    assert browser.value("player.state().shown") == walk.sizes["person"]
    assert "none recorded" in browser.value("document.body.textContent")


def test_a_run_of_one_sample_plays(show: Show, walk: xr.Dataset) -> None:
    browser = show(walk.isel(sample=[0]))
    browser.press("End")
    browser.press("ArrowLeft")
    browser.wait(f"player.state().shown === {walk.sizes['person']}")
    assert browser.value("player.state().samples") == 1
    assert browser.errors == []
