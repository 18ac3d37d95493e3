"""The gathered dataset as the measures read it: what it must hold, what an outcome means."""

from collections.abc import Sequence

import xarray as xr

Over = str | Sequence[str]  # the dimension or dimensions an estimate is taken over

FINISHED = ("all_out",)
BLOCKED = ("blocked", "frozen")
UNFINISHED = ("blocked", "frozen", "time_limit")
KNOWN = FINISHED + UNFINISHED  # neither missing nor unstable: what counts as a run


def needs(ds: xr.Dataset, *names: str) -> None:
    """Check that the dataset holds the variables of these names.

    Raises
    ------
    ValueError
        If one is missing.
    """
    absent = [name for name in names if name not in ds.variables]
    if absent:
        raise ValueError(
            f"dataset has no variable {', '.join(absent)} (it holds"
            f" {', '.join(map(str, ds.data_vars)) or 'none'}): pass the gathered dataset of a sweep"
        )


def dims_over(held: xr.Dataset | xr.DataArray, over: Over) -> list[str]:
    """Names of the dimensions to estimate over, checked against the dataset.

    Raises
    ------
    ValueError
        If one is not a dimension of `held`, or is the rank of leaving.
    """
    names = [over] if isinstance(over, str) else list(over)
    axes = [str(dim) for dim in held.dims if dim != "exit"]
    for name in names:
        if name not in axes:
            raise ValueError(
                f"over={name!r} is not an axis of the dataset ({', '.join(axes) or 'it has none'}):"
                " name an axis that the sweep varied"
            )
    return names


def outcome_is(ds: xr.Dataset, *meanings: str) -> xr.DataArray:
    """Whether each run ended in one of the named ways, read from the CF flag attributes.

    Parameters
    ----------
    ds : Dataset with `outcome` (axes...) and its `flag_values` and `flag_meanings`
    meanings : str
        Any of the words in `flag_meanings`.

    Returns
    -------
    (axes...) bool

    Raises
    ------
    ValueError
        If `outcome` or its flag attributes are missing, or a word is not among its meanings.
    """
    needs(ds, "outcome")
    attrs = ds.outcome.attrs
    if "flag_values" not in attrs or "flag_meanings" not in attrs:
        raise ValueError(
            "outcome has no flag_values or flag_meanings: both are needed to read it, so keep attributes when"
            " the dataset is reshaped (xr.set_options(keep_attrs=True))"
        )
    code = dict(zip(attrs["flag_meanings"].split(), attrs["flag_values"], strict=True))
    unknown = [word for word in meanings if word not in code]
    if unknown:
        raise ValueError(
            f"outcome has no flag {unknown[0]!r} (it has {', '.join(code)}): gather with the current schema"
        )
    found: xr.DataArray = ds.outcome.isin([code[word] for word in meanings])
    return found


def described(values: xr.DataArray, units: str, long_name: str, **attrs: object) -> xr.DataArray:
    """The same values with exactly these attributes."""
    described_values = values.copy(deep=False)
    described_values.attrs = {"units": units, "long_name": long_name, **attrs}
    return described_values


def count(truth: xr.DataArray, over: Over, long_name: str) -> xr.DataArray:
    """Number of true values over the dimensions `over`, as a described variable."""
    return described(truth.sum(dims_over(truth, over)).astype("int64"), "1", long_name)
