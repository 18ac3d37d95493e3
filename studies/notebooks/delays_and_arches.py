# %% [markdown]
# # Delays and arches
#
# Parisi & Dorso (2005) asked what makes people slower when they hurry: arches of persons in touch that shut the door
# until they break. We run their room (20 m x 20 m, a door of 1.2 m) at two desired speeds, record who touches whom,
# and follow the chain: delays between exits, blocking clusters, arches, and how many of the delays ended when an arch
# broke.
#
# Six seeds and 150 persons keep this short; `make study-parisi` has 200 persons, 14 seeds and all of the paper's
# figures.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from engine import rooms
from studies import measures
from studies.parisi.sweeps import side_by_side
from studies.presentation import figures
from sweep import Grid, Store, open_results, read_run, sweep
from sweep.schema import run_key

STORE = Path("results/notebooks/parisi")
plt.rcParams.update(figures.STYLE | {"figure.dpi": 150})

# %%
recorded = {"record_every": 0.05, "contacts": True, "record": "positions"}  # positions and who touches whom
grid = Grid(rooms.parisi_room, v_d=[2.0, 6.0], N=150, seed=range(6), **recorded)
sweep(grid, STORE, jobs=2)
ds = open_results(STORE)

# %% [markdown]
# ## Did they get out, and how fast?
#
# The mean clearance time over the runs that got out, with a bootstrap interval of 95 %; `runs` are those averaged,
# `censored` those that did not finish and are in no mean. Faster is slower if the time is longer at the higher speed.

# %%
facts = measures.clearance(ds)
mean = measures.mean_over(facts.clearance_time.where(measures.outcome_is(ds, "all_out")), censored=facts.censored)
mean.to_dataframe()[list(mean.data_vars)].round(2)

# %% [markdown]
# ## Delay survival
#
# The fraction of delays longer than t, over all runs of a speed, from the 10th to the 120th exit, where the crowd is
# dense. The bands are intervals of 95 % from a bootstrap that draws whole runs, for the delays of one run depend on
# each other. A run that stayed blocked has a last wait that nobody ended: it is no delay, and `censored` counts such
# runs; where that is not 0, the tail is a lower bound.

# %%
survival = measures.delay_survival(ds, np.arange(0.0, 3.01, 0.05), first=10, last=120)
figure, axis = plt.subplots(figsize=(figures.COLUMN * 1.3, 2.6))
for v_d, colour in zip(ds.v_d.values, (figures.BLUE, figures.ORANGE), strict=True):
    curve = survival.sel(v_d=v_d)
    axis.fill_between(curve.time, curve.delay_survival_low, curve.delay_survival_high, color=colour, alpha=0.25, lw=0)
    label = f"{v_d:g} m/s: {int(curve.delays)} delays of {int(curve.runs)} runs, {int(curve.censored)} censored"
    axis.plot(curve.time, curve.delay_survival.where(curve.delay_survival > 0), color=colour, label=label)
axis.set(xlabel="delay $t$ / s", ylabel="fraction of delays longer than $t$", yscale="log", ylim=(1e-3, 1.2))
axis.legend(loc="upper right")
plt.show()

# %% [markdown]
# ## Blocking clusters and large clusters
#
# A blocking cluster is a chain of persons in touch from one side of the door to the other; it is *clean* if it
# encloses nobody between itself and the door. `contact_counts` reduces each recorded run to numbers that can be put
# side by side.

# %%
files = [Store(STORE).file(run_key(grid.scenario(point))) for point in grid.points()]
counts = side_by_side([measures.contact_counts(read_run(file)) for file in files], grid)

# %% [markdown]
# Fraction of the time, from the start to each run's last exit, in which there is such a cluster. The interval is a
# bootstrap over whole runs; where no run, or each sample of all runs, has one, the open end is Wilson's for so many
# runs.

# %%
shut = measures.blocking_probability(counts)
columns = ["blocking_probability", "blocking_probability_low", "blocking_probability_high", "runs", "censored"]
shut[columns].to_dataframe()[columns].round(4)

# %%
large = measures.cluster_probability(counts)
large.to_dataframe().round(4)

# %% [markdown]
# ## Do delays end when arches break?
#
# The arch-clogging correlation (Eq. 6) is the fraction of delays that ended with somebody leaving whose arch had just
# broken. If arches cause the long delays, it is near 1 for long delays at the high speed. Bins without a delay are
# empty, and bins with few say so by their interval: look at the numbers of delays before the fraction; delays of one
# run alone have no interval at all.

# %%
clogging = measures.arch_clogging_correlation(counts).sel(kind="clean")
columns = ["c_ac", "c_ac_low", "c_ac_high", "delays", "runs", "censored"]
clogging[columns].to_dataframe().set_index("delay_end", append=True)[columns].round(3)

# %% [markdown]
# ## Arches of one run
#
# The log of one run at 6 m/s: when each clean arch was first seen, how long it lived, and how many persons it had.
# Lifetimes are those of samples, too long or too short by less than the sampling interval; an arch that still stands
# at the last sample has none (it is censored).

# %%
run = read_run(Store(STORE).file(run_key(grid.scenario({"v_d": 6.0, "seed": 0}))))
log = measures.arches(run)
alive, smallest, largest = int(log.lifetime.isnull().sum()), int(log.arch_size.min()), int(log.arch_size.max())
print(f"{log.sizes['arch']} arches of {smallest} to {largest} persons, {alive} of them alive at the end")
log[["begin_time", "lifetime", "arch_size"]].to_dataframe().nlargest(5, "lifetime")

# %% [markdown]
# The one that lived longest, as it stood when it was first seen. Its persons are orange; others at the door are grey.

# %%
longest = int(log.lifetime.argmax("arch"))
members = np.split(log.arch_person.values, log.arch_size.values.cumsum())[longest]
frame = run.isel(sample=int(np.abs(run.time.values - float(log.begin_time[longest])).argmin()))

figure, axis = plt.subplots(figsize=(figures.COLUMN, 3.0))
inside = np.isfinite(frame.x.values)
axis.add_collection(
    EllipseCollection(
        *(2.0 * frame.radius.values[inside],) * 2,
        np.zeros(inside.sum()),
        units="xy",
        offsets=np.column_stack([frame.x, frame.y])[inside],
        offset_transform=axis.transData,
        facecolors=np.where(np.isin(np.flatnonzero(inside), members), figures.ORANGE, "#cccccc").tolist(),
        edgecolor="white",
        linewidth=0.4,
    )
)
axis.add_collection(LineCollection(run.wall.values.reshape(-1, 2, 2).tolist(), colors="0.2", linewidths=2))
axis.plot(frame.x[members], frame.y[members], "k-o", lw=1.2, ms=2.5)
axis.set(xlim=(16.8, 20.6), ylim=(8.2, 11.8), aspect="equal", xlabel="x / m", ylabel="y / m")
axis.set_title(f"t = {float(frame.time):.2f} s, an arch that lived {float(log.lifetime[longest]):.2f} s")
plt.show()
