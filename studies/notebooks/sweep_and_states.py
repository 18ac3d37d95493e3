# %% [markdown]
# # A sweep and its states
#
# How does the desired speed decide what becomes of a crowd at a door? We run a small grid of Lin, Ma & Lo's room
# (2016), eight desired speeds with six seeds each, and read three things from it: the mean flow, the fraction of runs
# that block, and the states of the crowd: smooth, transition, phase separation.
#
# Six seeds are few, so that this notebook runs in a minute: intervals are wide, and some cells may stay undecided.
# `make study-fig10` is the same with 240 runs.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd

from engine import rooms
from studies import measures
from studies.presentation import figures
from sweep import Grid, open_results, sweep

STORE = Path("results/notebooks/speeds")
plt.rcParams.update(figures.STYLE | {"figure.dpi": 150})

# %% [markdown]
# ## Run the grid
#
# Lists are axes, single values constants. The store is a folder with one file a run: a sweep that was interrupted
# goes on where it stopped, and a second call runs nothing. The same seed means the same bodies and positions at
# every speed.

# %%
grid = Grid(rooms.lin_room, v_d=[0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0], N=200, seed=range(6))
sweep(grid, STORE, jobs=2)
ds = open_results(STORE)
ds

# %% [markdown]
# ## How runs ended
#
# Before any average: how many runs got everybody out? A run that is `blocked` or `frozen` has no clearance time, and
# one at the `time_limit` has one that nobody saw. Neither is ever averaged in as a number; they are counted.

# %%
words = ds.outcome.attrs["flag_meanings"].split()
ended = {word: measures.outcome_is(ds, word).sum("seed").to_series() for word in words}
pd.DataFrame(ended).loc[:, lambda table: table.any()]

# %% [markdown]
# ## Blocked fraction
#
# The fraction of runs that blocked, with Wilson's interval of 95 % for so many runs. With six seeds, no blocked run
# at all still allows a fraction of up to two fifths: the upper limit says so.

# %%
share = measures.blocked_share(ds)
columns = ["blocked_share", "blocked_share_low", "blocked_share_high", "blocked", "runs", "censored"]
share[columns].to_dataframe()[columns].round(2)

# %% [markdown]
# ## Mean flow
#
# Persons over clearance time. A small dot is a run, the large one the mean over the runs that got out, with a
# bootstrap interval of 95 % over runs; blocked runs lie at zero as dots and are not in the mean. Means of few
# remaining runs are those of the lucky ones: read them beside the blocked fraction below.

# %%
facts = measures.mean_flow(ds)
got_out = facts.mean_flow.where(measures.outcome_is(ds, "all_out"))
mean = measures.mean_over(got_out, censored=facts.censored)

figure, (upper, lower) = plt.subplots(2, 1, figsize=(figures.COLUMN * 1.3, 4.0), sharex=True, height_ratios=(3, 2))
for seed in ds.seed:
    upper.plot(ds.v_d, facts.mean_flow.sel(seed=seed), ".", color=figures.GREY, ms=3)
arms = [mean.mean_flow - mean.mean_flow_low, mean.mean_flow_high - mean.mean_flow]
upper.errorbar(ds.v_d, mean.mean_flow, arms, fmt="o", ms=4, color=figures.BLUE, label="mean of the runs out, 95 %")
upper.set(ylabel="mean flow / s$^{-1}$", ylim=(-0.05, 1.4))
upper.legend()
arms = [share.blocked_share - share.blocked_share_low, share.blocked_share_high - share.blocked_share]
lower.errorbar(ds.v_d, share.blocked_share, arms, fmt="s", ms=4, color=figures.ORANGE)
lower.set(xlabel="desired speed $v_d$ / m s$^{-1}$", ylabel="blocked fraction, 95 %", ylim=(-0.05, 1.05))
plt.show()

# %%
mean.to_dataframe()[list(mean.data_vars)].round(3)

# %% [markdown]
# ## States
#
# `measures.states` places two boundaries on the axis of the desired speed: where the mean flow no longer rises
# (transition), by a broken-stick fit, and where blocking is established (phase separation), by a step fit to the
# numbers of blocked runs. Each comes with an interval of 95 % and with what was decided: `inf` means that the
# boundary lies beyond the speeds that were run, and where the runs cannot tell it is undecided and says why.

# %%
found = measures.states(ds)
for name in ("transition_from", "phase_separation_from"):
    decision = found[f"{name}_decision"]
    word = decision.attrs["flag_meanings"].split()[int(decision)]
    low, high = float(found[f"{name}_low"]), float(found[f"{name}_high"])
    print(f"{name}: {float(found[name]):.2f} [{low:.2f}, {high:.2f}] m/s, {word}")

# %% [markdown]
# A cell is certain where it lies outside both intervals.

# %%
names = found.state.attrs["flag_meanings"].split()
columns = ["state", "state_certain", "runs", "blocked", "censored"]
found.to_dataframe()[columns].assign(state=[names[code] for code in found.state.values])

# %% [markdown]
# ## More seeds where they are needed
#
# Uniform seeds are wasteful: most cells are settled early. `sweep(grid, store, until="blocked_share=0.1,
# clearance_time=5%")` gives more seeds to the cells whose intervals are still too wide, and `jamsweep report
# results/notebooks/speeds` makes a page of what there is.
