"""Bad input is one line: what, value, requirement, remedy."""

import math
from dataclasses import replace

import pytest

from engine import BadInput, Crowd, Exit, Model, Options, Scenario, Scene, laws, models, rooms, simulate

NAN, INF = math.nan, math.inf
AREA = (0, 15, 0, 15)
PERSON = {"x": [1.0], "y": [1.0], "vx": 0.0, "vy": 0.0, "spin": 0.0, "radius": 0.3, "mass": 70.0, "v_d": 1.0}


def started(x, y):
    """Begin a run of persons given at these places in a box."""
    crowd = Crowd.given(x, y, 0.0, 0.0, 0.0, 0.3, 70.0, 0.0)
    return simulate(Scenario(Scene.box(3.0, 3.0), crowd, models.lin_dem()))


CASES = {
    "v_d nan": (lambda: rooms.lin_room(v_d=NAN), "v_d nan"),
    "v_d negative": (lambda: rooms.lin_room(v_d=-1.0), "v_d -1.0"),
    "N negative": (lambda: rooms.lin_room(N=-3), "N -3"),
    "N no whole number": (lambda: rooms.lin_room(N=2.5), "N 2.5"),
    "N zero": (lambda: rooms.lin_room(N=0), "N 0"),
    "seed negative": (lambda: rooms.lin_room(seed=-1), "seed -1"),
    "seed no whole number": (lambda: rooms.lin_room(seed=0.5), "seed 0.5"),
    "tau zero": (lambda: rooms.lin_room(tau=0.0), "drive tau 0"),
    "tau nan": (lambda: rooms.lin_room(tau=NAN), "drive tau nan"),
    "A negative": (lambda: rooms.lin_room(A=-300.0), "social A -300"),
    "B zero": (lambda: rooms.lin_room(B=0.0), "social B 0"),
    "mu text": (lambda: rooms.lin_room(mu="high"), "friction mu high"),
    "friction unknown": (lambda: rooms.lin_room(wall_friction="XY"), "wall_friction 'XY'"),
    "inertia unknown": (lambda: rooms.lin_room(inertia="cube"), "inertia 'cube'"),
    "exit width zero": (lambda: rooms.lin_room(L=0.0), "L 0.0"),
    "exit width nan": (lambda: rooms.lin_room(L=NAN), "L nan"),
    "exit too narrow": (lambda: rooms.lin_room(L=0.5), "exit width 0.5 m is narrower than the largest person (0.7 m)"),
    "exit wider than the room": (lambda: rooms.lin_room(L=15.0), "size 15.0"),
    "dt too long": (lambda: rooms.lin_room(dt=0.02), "dt 0.02 s is beyond the"),
    "dt nan": (lambda: rooms.lin_room(dt=NAN), "dt nan"),
    "dt negative": (lambda: rooms.lin_room(dt=-1e-3), "dt -0.001"),
    "dt beyond tau": (
        lambda: rooms.lin_room(tau=1e-4, dt=1e-3),
        "dt 0.001 s is beyond the 0.0001 s that the drive's tau",
    ),
    "dt beyond the damping": (lambda: rooms.lin_room(g_n=1e5, numerics="paper"), "dt 0.001 s is beyond the"),
    "dt beyond the social force": (lambda: rooms.lin_room(A=1e6, B=1e-3, dt=1e-3), "dt 0.001 s is beyond the"),
    "dt without end": (lambda: rooms.lin_room(dt=1e-300), "time_limit of 1e+303 steps"),
    "no step at all": (lambda: rooms.lin_room(time_limit=1e-9, dt=1e-3), "time_limit of 1e-06 steps"),
    "seed too large": (lambda: rooms.lin_room(seed=2**64), "seed 18446744073709551616"),
    "L text": (lambda: rooms.lin_room(L="1"), "L 1 is not a finite number"),
    "size none": (lambda: rooms.lin_room(size=None), "size None is not a finite number"),
    "A beyond floats": (lambda: rooms.lin_room(A=10**400), "social A ... is not a finite number"),
    "inertia a list": (lambda: rooms.lin_room(inertia=[]), "inertia []"),
    "E nan": (lambda: rooms.lin_room(E=NAN), "E nan"),
    "integrator unknown": (lambda: rooms.lin_room(integrator="euler"), "integrator 'euler'"),
    "exits of something else": (lambda: Scene((), ("abc",)), "exit 'abc' is no Exit"),
    "options of something else": (lambda: replace(rooms.lin_room(), options=3.0), "options 3.0 is no Options"),
    "deep in another": (lambda: started([1.0, 1.1], [1.0, 1.0]), "somebody (such as person"),
    "centre on a wall": (lambda: started([0.0], [1.0]), "somebody (such as person 0) is"),
    "force tolerance zero": (lambda: Options(force_tolerance=0.0), "force_tolerance 0"),
    "blocked_after infinite": (lambda: rooms.lin_room(blocked_after=INF), "blocked_after inf"),
    "sampling negative": (lambda: rooms.lin_room(record_every=-1.0), "record_every -1"),
    "sampling within a step": (
        lambda: rooms.lin_room(dt=1e-3, record_every=5e-4),
        "record_every 0.0005 s is shorter than the time step of 0.001 s",
    ),
    "numerics of no paper": (
        lambda: replace(rooms.lin_room(), paper=None).with_options(numerics="paper"),
        "numerics 'paper' are not known for this room",
    ),
    "contacts without times": (lambda: Options(contacts=True), "contacts without record_every"),
    "radius nan": (lambda: Crowd.uniform(10, AREA, radius=NAN), "radius nan"),
    "radius zero": (lambda: Crowd.uniform(10, AREA, radius=(0.0, 0.3)), "radius (0.0, 0.3)"),
    "radius backwards": (lambda: Crowd.uniform(10, AREA, radius=(0.3, 0.2)), "radius (0.3, 0.2)"),
    "mass negative": (lambda: Crowd.uniform(10, AREA, mass=-70.0), "mass -70.0"),
    "mass of three": (lambda: Crowd.uniform(10, AREA, mass=(1, 2, 3)), "mass (1, 2, 3)"),
    "area empty": (lambda: Crowd.uniform(10, (0, 0, 0, 15)), "area (0, 0, 0, 15)"),
    "given radius negative": (lambda: Crowd.given(**PERSON | {"radius": -0.3}), "radius -0.3"),
    "given place nan": (lambda: Crowd.given(**PERSON | {"x": [NAN]}), "x nan"),
    "given lengths differ": (lambda: Crowd.given(**PERSON | {"mass": [70.0, 80.0]}), "mass of shape (2,)"),
    "given one place twice": (
        lambda: Crowd.given(**PERSON | {"x": [1.0, 1.0], "y": [2.0, 2.0]}),
        "position (1.0, 2.0) is given to two persons",
    ),
    "phi beyond 1": (lambda: rooms.lin_room(phi=1.5), "anisotropy phi 1.5"),
    "wall without length": (lambda: Scene(((1, 1, 1, 1),)), "wall (1.0, 1.0, 1.0, 1.0)"),
    "wall nan": (lambda: Scene(((1, 1, 1, NAN),)), "wall (1, 1, 1, nan)"),
    "exit outward along": (lambda: Exit((0, 0), (0, 1), (0, 1)), "exit outward"),
    "exit without width": (lambda: Exit((0, 0), (0, 0), (0, 1)), "exit width 0 m"),
    "a law of the wrong kind": (lambda: models.validated(Model(drive=laws.Hertz(1e6, 0))), "drive Hertz"),
    "a law without its end": (lambda: models.validated(Model(social=laws.Hertz(1e6, 0))), "social Hertz"),
    "not a law": (lambda: models.validated(Model(anisotropy=0.3)), "anisotropy 0.3"),
}


@pytest.mark.parametrize(("make", "begins"), CASES.values(), ids=CASES)
def test_bad_input_is_one_line_that_names_it(make, begins):
    with pytest.raises(BadInput) as error:
        make()
    message = str(error.value)
    assert message.startswith(begins)
    assert ": " in message, "no remedy"
    assert "\n" not in message


def test_the_longest_allowed_step_is_named():
    limit = float(_message(lambda: rooms.lin_room(dt=0.1)).split("beyond the ")[1].split(" s")[0])
    assert 2e-3 < limit < 2e-2
    rooms.lin_room(dt=limit * 0.99)


def test_a_stiffer_body_forbids_the_step_that_a_softer_one_allows():
    scenario = rooms.lin_room(dt=4e-3)
    with pytest.raises(BadInput, match=r"^dt 0.004 s"):
        replace(scenario, model=models.lin_dem(E=5e8))


def _message(make):
    with pytest.raises(BadInput) as error:
        make()
    return str(error.value)


def test_a_scenario_survives_its_text_form():
    variant = {"friction": "kept", "wall_friction": "kept", "wall_mu": 0.1, "inertia": "none"}
    scenario = rooms.lin_room(v_d=1.3, N=40, record_every=0.5, contacts=True, **variant)
    again = Scenario.from_json(scenario.to_json())
    assert again == scenario.with_options(**scenario.numerics._asdict())
    assert again.canonical() == scenario.canonical()
    assert again.to_json() == scenario.to_json()
    assert rooms.lin_room(v_d=1.3 + 1e-15, N=40).canonical() != rooms.lin_room(v_d=1.3, N=40).canonical()
