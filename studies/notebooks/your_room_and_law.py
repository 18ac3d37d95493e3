# %% [markdown]
# # Your room and your law
#
# Two questions that no paper's scene answers: does a door near the corner let people out sooner than one in the
# middle of the wall, and does the answer depend on how people keep their distance? We write a room of our own, a
# repulsion of our own, and sweep both.

# %% [markdown]
# ## A law of your own
#
# A law of force is one function beside a small type with its parameters; the engine compiles it into its time loop. It
# may stand in any file, or in a notebook. The law here: a repulsion k/gap^2 between persons, held at its value at 1 cm
# for smaller gaps. Its cutoff and its stiffness follow from the formula. A hash of the law's code is part of a run's
# key: after an edit of the law, the sweep below runs anew.

# %%
from pathlib import Path
from typing import Annotated, NamedTuple

import matplotlib.pyplot as plt

from engine import Crowd, Exit, Scenario, Scene, laws, models, simulate
from studies import measures
from studies.presentation import figures
from sweep import Grid, open_results, sweep

plt.rcParams.update(figures.STYLE | {"figure.dpi": 150})
FOLDER = Path("results/notebooks/mine").absolute()


class PowerLaw(NamedTuple):
    """k/gap^2, held within 1 cm."""

    k: Annotated[float, laws.at_least(0.0, "N m^2", "strength")]


@laws.social.law(PowerLaw)
def power_law(p: PowerLaw, gap: float) -> float:
    """Repulsion at a gap, N."""
    return p.k / max(gap, 0.01) ** 2


# %% [markdown]
# ## A room of your own
#
# A room is any function of named parameters that returns a `Scenario`: walls and exits, a crowd, a model, a seed.
# Each keyword, and each of the options of a run (`engine.Options`), may then be an axis or a constant of a sweep.
# Bodies, friction and drive are those of Lin, Ma & Lo's model; only the social force between persons is exchanged. Step
# and integrator follow from the accuracy that is asked for, 2 % of the statistics by default. A scenario is checked
# when it is made: a door narrower than a person, or a time step too long for the law, is refused with a remedy.

# %%
LAWS = {"exponential": models.lin_dem().social, "power law": PowerLaw(k=0.03)}


def my_room(v_d: float = 1.2, seed: int = 0, door: float = 4.0, law: str = "exponential", N: int = 60) -> Scenario:
    """A room of 8 m x 8 m with a door of 1 m in its right wall, whose middle is `door` (m) above the floor."""
    low, high = door - 0.5, door + 0.5
    walls = (
        (8.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, 8.0),
        (0.0, 8.0, 8.0, 8.0),
        (8.0, 8.0, 8.0, high),
        (8.0, low, 8.0, 0.0),
    )
    scene = Scene(walls, (Exit((8.0, low), (8.0, high), outward=(1.0, 0.0)),))
    crowd = Crowd.uniform(N, (0.0, 8.0, 0.0, 8.0), radius=(0.25, 0.35), mass=(60.0, 80.0), v_d=v_d)
    return Scenario(scene, crowd, models.lin_dem()._replace(social=LAWS[law]), seed=seed)


print(simulate(my_room(law="power law")))

# %% [markdown]
# ## Sweep it
#
# Two places of the door, two laws, eight seeds. The same seed means the same bodies and positions in all four
# cells.

# %%
grid = Grid(my_room, door=[4.0, 1.1], law=["exponential", "power law"], seed=range(8))
sweep(grid, FOLDER / "runs", jobs=2)
ds = open_results(FOLDER / "runs")

# %% [markdown]
# Mean clearance time of the runs that got out, with a bootstrap interval of 95 %; `runs` is how many these are and
# `censored` how many did not finish. The blocked fraction beside it has Wilson's interval.

# %%
facts = measures.clearance(ds)
mean = measures.mean_over(facts.clearance_time.where(measures.outcome_is(ds, "all_out")), censored=facts.censored)
mean.to_dataframe().round(1)

# %%
share = measures.blocked_share(ds)
columns = ["blocked_share", "blocked_share_low", "blocked_share_high", "blocked", "runs"]
share[columns].to_dataframe().round(2)

# %%
cells = mean.stack(cell=["law", "door"])
arms = [cells.clearance_time - cells.clearance_time_low, cells.clearance_time_high - cells.clearance_time]
figure, axis = plt.subplots(figsize=(figures.COLUMN * 1.3, 2.6))
axis.errorbar(range(cells.sizes["cell"]), cells.clearance_time, arms, fmt="o", ms=4, color=figures.BLUE)
words = [
    f"{law}\ndoor at {door:g} m\n{int(runs)} runs out\n{int(censored)} censored"
    for (law, door), runs, censored in zip(cells.cell.values, cells.runs, cells.censored, strict=True)
]
axis.set(xticks=range(len(words)), xticklabels=words, xlim=(-0.5, 3.5), ylim=(0, None))
axis.set_ylabel("clearance time / s, 95 %")
plt.show()

# %% [markdown]
# The intervals above are of each cell by itself. Since all cells have the same seeds, the difference of two places of
# the door is better judged pair by pair: the mean difference over the seeds in which both runs got out, with its
# interval.

# %%
times = facts.clearance_time.where(measures.outcome_is(ds, "all_out"))
difference = (times.sel(door=1.1) - times.sel(door=4.0)).rename("near_corner_less_middle").assign_attrs(units="s")
measures.mean_over(difference, censored=facts.censored.any("door")).to_dataframe().round(1)

# %% [markdown]
# An interval that holds zero says that these runs do not tell the two places apart; more seeds would. To keep room
# and law, put both into a file, from which they are run and swept: `docs/room.md` and `docs/law.md`.
