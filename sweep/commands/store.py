"""The commands of `jamsweep` that look at a store or tidy it."""

import json
import math
from pathlib import Path

import click

from engine import BadInput
from engine.errors import require
from sweep.errors import DamagedFile
from sweep.grid import Grid
from sweep.status import DONE, Status, status_of
from sweep.storage.durable import require_target
from sweep.storage.serving import ON_CODE_CHANGE, RERUN
from sweep.storage.store import CORRUPT, Store, sizes_in

FAILED = 1  # exit code
store_argument = click.argument("store", type=click.Path(path_type=Path))
code_option = click.option(
    "--on-code-change",
    type=click.Choice(ON_CODE_CHANGE),
    help=f"What becomes of runs that another state of the engine made.  [default: {RERUN}]",
)


@click.command()
@store_argument
@click.option("--why", is_flag=True, help="Also say which runs are not done, and why.")
@click.option("--json", "as_json", is_flag=True, help="The same for programs.")
def status(store: Path, why: bool, as_json: bool) -> None:
    """Say how much of the grid last swept into STORE is done.

    \b
    jamsweep status results/mine --why
    """  # noqa: D301  click reads \b as a character
    kept = Store(store)
    kept.check()
    found = status_of(grid_of(kept), kept)
    if as_json:
        click.echo(json.dumps(_plain(found)))
        return
    notes = sizes_in(kept.failed)
    failed = sum(f"{run.key}.txt" in notes for run in found.runs if run.state != DONE)
    say(found, why, f"; {failed} of them failed before, see {kept.failed}" if failed else "")
    aside = sum(name.endswith(CORRUPT) for name in [*sizes_in(kept.runs), *sizes_in(kept.shards)])
    if aside:
        click.echo(f"{aside} damaged file{'s' * (aside != 1)} set aside as *{CORRUPT}: delete when no longer of use")


def say(found: Status, why: bool, failures: str = "") -> None:
    """Print how far a sweep is."""
    click.echo(f"{found}{failures}")
    for line in found.more():
        click.echo(line)
    for line in found.why() if why else ():
        click.echo(line)


def _plain(found: Status) -> dict[str, object]:
    waiting = [run._asdict() for run in found.runs if run.state != DONE]
    seconds = None if math.isnan(found.seconds) else round(found.seconds, 3)
    return {"runs": len(found.runs), "states": found.counts(), "cpu_seconds_left": seconds, "not_done": waiting}


@click.command()
@store_argument
@click.option("-o", "--output", type=click.Path(dir_okay=False, path_type=Path), help="Also write the dataset here.")
@code_option
def gather(store: Path, output: Path | None, on_code_change: str | None) -> None:
    """Gather the runs in STORE into its dataset.nc, as far as they are done.

    \b
    jamsweep gather results/mine -o mine.nc
    """  # noqa: D301  click reads \b as a character
    from sweep.gathering import collect  # xarray takes a second, which `status` need not wait for

    if output:
        require_target(output)
    kept = Store(store)
    kept.check()
    gathered = collect(grid_of(kept), kept, on_code_change or RERUN)
    if output:
        gathered.ds.to_netcdf(output)
    click.echo(str(output or kept.dataset))
    if gathered.aside:
        raise click.exceptions.Exit(FAILED)


@click.command()
@store_argument
@click.option("--repair", is_flag=True, help="Set damaged files aside, enter whole ones again, remove leftovers.")
def verify(store: Path, repair: bool) -> None:
    """Read every byte in STORE and say what is damaged, lost or foreign, a line each, with its remedy.

    \b
    jamsweep verify results/mine

    Exit code 1 if there is anything that is not repaired.
    """  # noqa: D301  click reads \b as a character
    from sweep.storage.verify import verify as verified

    kept = Store(store)
    require(kept.path.is_dir(), "store", f"'{kept.path}'", "does not exist", "name the folder of a sweep")
    findings = verified(kept, repair)
    for finding in findings:
        click.echo(("repaired: " if repair and finding.repair else "") + str(finding))
    number = len(kept.finished())
    click.echo(f"{number} run{'s' * (number != 1)} whole, {len(findings)} finding{'s' * (len(findings) != 1)}")
    if any(not (repair and finding.repair) for finding in findings):
        raise click.exceptions.Exit(FAILED)


@click.command()
@store_argument
def compact(store: Path) -> None:
    """Fold the finished runs in STORE into few large files; they count and are gathered as before.

    \b
    jamsweep compact results/mine
    """  # noqa: D301  click reads \b as a character
    from sweep.storage.compact import compact as compacted

    done = compacted(store)
    sizes = f"{done.before / 1e6:.1f} MB became {done.after / 1e6:.1f} MB"
    into = f"{done.shards} shard{'s' * (done.shards != 1)}"
    click.echo(f"{done.runs} runs folded into {into}: {sizes}" if done.runs else "nothing to fold")


def grid_of(store: Store) -> Grid:
    """The grid that was swept last into a store.

    Raises
    ------
    BadInput
        If there is none, or its room is one of one's own, which no name leads to.
    DamagedFile
        If it cannot be read.
    """
    remedy = "name the folder of a sweep"
    require(store.grid.is_file(), "store", f"'{store.path}'", "holds no sweep", remedy)
    own = False
    try:
        text = store.grid.read_text("utf-8")
        own = ":" in json.loads(text)["room"]
        return Grid.from_json(text)
    except (ValueError, KeyError, TypeError, RecursionError) as error:  # of JSON, of UTF-8, or no grid
        if isinstance(error, BadInput) and own:
            raise BadInput(f"{error} (sweep.open_results opens the dataset from Python)") from None
        raise DamagedFile(f"grid '{store.grid}' is damaged: sweep again, which writes it anew") from None
