# %% [markdown]
# # A first look at one run
#
# Eighty persons leave a room of 15 m x 15 m through a door of 1 m, by the model of Lin, Ma & Lo (2016). We simulate
# one run, write it to a file, read it back as an xarray dataset, and look at what a pedestrian experiment would give:
# the N-t curve, the time gaps between persons, and the crowd at one instant, with the forces that press on people.
#
# One run is one draw: it has no interval. The notebook *A sweep and its states* asks what is typical.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from engine import rooms, simulate
from studies import measures
from studies.presentation import figures
from sweep import exports, pages, read_run, write_run

FOLDER = Path("results/notebooks/first_look")
FOLDER.mkdir(parents=True, exist_ok=True)
plt.rcParams.update(figures.STYLE | {"figure.dpi": 150})

# %% [markdown]
# ## Simulate, write, read
#
# A room is a function of named parameters, all in SI units; `record_every=0.1` records the state ten times a second,
# and `contacts=True` also who touches whom. The same parameters and the same seed give the same run, to the last bit.
# (The first run compiles the kernel for the laws of this model, some ten seconds.)

# %%
run = simulate(rooms.lin_room(v_d=1.6, N=80, seed=1, record_every=0.1, contacts=True))
write_run(run, FOLDER / "run.nc")
print(run)

# %% [markdown]
# The sentence above says how the run ended. Not finishing is a result, too: a run may also end `blocked` (nobody got
# out for 120 s), `frozen` (a jam that is proven to stay) or at the time limit.
#
# The file is plain netCDF, which any tool reads; `read_run` checks it against its hash where a store vouches for it.
# `exit_time` is in the order of leaving, and `exit_person` says who it was.

# %%
ds = read_run(FOLDER / "run.nc")
ds

# %% [markdown]
# ## The N-t curve
#
# Persons out against time. Its slope is the flow; a flat piece is a time in which nobody gets through.

# %%
out = measures.discharge(ds, np.arange(0.0, float(ds.end_time) + 0.1, 0.1)).discharge
figure, axis = plt.subplots(figsize=(figures.COLUMN * 1.3, 2.4))
axis.plot(out.time, out, color=figures.BLUE)
axis.set(xlabel="time $t$ / s", ylabel="persons out", xlim=(0, None), ylim=(0, None))
plt.show()

# %%
flow = measures.mean_flow(ds)
print(f"{int(ds.N_out)} of {int(ds.persons)} persons out, mean flow {float(flow.mean_flow):.2f} /s")

# %% [markdown]
# ## Time gaps
#
# The gap (delay) before each person but the first. Most are below a second, and a few long ones take much of the
# time: these are the clogs. How such gaps are distributed over many runs is what *Delays and arches* looks at.

# %%
gaps = measures.delays(ds).delay
figure, axis = plt.subplots(figsize=(figures.COLUMN * 1.3, 2.2))
axis.bar(gaps.exit, gaps, width=0.8, color=figures.ORANGE)
axis.set(xlabel="rank of the person after whom one waits", ylabel="gap / s")
plt.show()

# %%
gaps.to_series().nlargest(5).rename("longest gaps / s").to_frame()

# %% [markdown]
# ## One instant
#
# The crowd in the middle of the longest gap. Bodies are drawn at true size; colour is the sum of the normal contact
# forces on each person (`exports.forces_on_persons` sums the recorded forces of the contacts; the social force is not
# in it). The black line, if there is one, is a blocking cluster: a chain of touching persons from
# one side of the door to the other.

# %%
waiting = gaps.idxmax("exit")
middle = float(ds.exit_time.sel(exit=waiting) + gaps.max() / 2)
sample = int(np.abs(ds.time.values - middle).argmin())
force = exports.forces_on_persons(ds).contact_force.isel(sample=sample)
frame = ds.isel(sample=sample)

cluster = measures.blocking_clusters(ds)
chain = np.split(cluster.path_person.values, cluster.path_size.values.cumsum())[sample]

# %%
figure, axis = plt.subplots(figsize=(figures.COLUMN * 1.35, 3.6))
inside = np.isfinite(frame.x.values)
bodies = EllipseCollection(
    *(2.0 * frame.radius.values[inside],) * 2,
    np.zeros(inside.sum()),
    units="xy",
    offsets=np.column_stack([frame.x, frame.y])[inside],
    offset_transform=axis.transData,
    array=force.values[inside],
    cmap="viridis_r",
    edgecolor="white",
    linewidth=0.3,
)
axis.add_collection(bodies)
axis.add_collection(LineCollection(ds.wall.values.reshape(-1, 2, 2).tolist(), colors="0.2", linewidths=1.5))
axis.plot(frame.x[chain], frame.y[chain], "k-o", lw=1.2, ms=2)
axis.set(xlim=(9, 15.5), ylim=(4, 11), aspect="equal", xlabel="x / m", ylabel="y / m")
figure.colorbar(bodies, ax=axis, label="normal contact force / N", shrink=0.8)
axis.set_title(f"t = {float(frame.time):.1f} s, {inside.sum()} persons inside")
plt.show()

# %% [markdown]
# ## A page that plays it
#
# One HTML file, without a network: open it in any browser. `jamsweep view run.nc` makes the same from a shell, and
# `jamsweep export run.nc --to run.sqlite` writes what JuPedSim and PedPy open.

# %%
page = FOLDER / "run.html"
page.write_text(pages.player_page(ds), "utf-8")
print(f"{page}: {page.stat().st_size / 1e6:.1f} MB")
