"""One score for each variant, and how certain it is: the same seeds resampled for all variants together."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from studies.measures.uncertainty import bootstrap_interval
from studies.variants.sweeps import CELLS
from studies.variants.targets import FITTED, HELD_OUT, TARGETS, Floats, Sample

RESAMPLES = 2000
CONFIDENCE = 0.95
LEAST_SEEDS = 6  # three seeds have ten different resamples, and an interval that is too narrow
TOO_FEW = "too few seeds"
GROUPS = ("all", FITTED, HELD_OUT)


def terms(sample: Sample) -> Floats:
    """What each target adds to the score of each variant: (targets, variants)."""
    return np.stack([target.term(sample) for target in TARGETS])


def sample_of(facts: xr.Dataset, drawn: NDArray[np.int64] | slice = slice(None)) -> Sample:
    """The runs of some seeds, by their place: the same ones in all cells and variants."""
    plain = {str(name): facts[name].transpose("cell", "variant", "seed").values for name in facts.data_vars}
    return {cell: {name: v[k][:, drawn] for name, v in plain.items()} for k, cell in enumerate(CELLS)}


def scored(facts: xr.Dataset, resamples: int = RESAMPLES, seed: int = 0) -> xr.Dataset:
    """Scores of all variants with intervals, and paired differences between each two.

    Seeds are resampled, whole: a draw takes the runs of the same seeds in all cells and variants, since a seed
    means the same bodies and positions everywhere. Intervals are the expanded percentile ones of
    `measures.uncertainty`. Where no run of a cell blocked, or every one, no resample knows better: what few runs
    leave open is in the term itself (`targets.predictive`).

    Parameters
    ----------
    facts : see `sweeps.run`
    resamples, seed : of the bootstrap

    Returns
    -------
    Dataset with `term`, `found` (target, variant); `score`, `score_low`, `score_high` (group, variant);
    `difference`, `difference_low`, `difference_high` (group, variant, other): score of the variant less that of
    the other; `runs`, `blocked`, `not_run` (variant).

    Raises
    ------
    ValueError
        If there are fewer than two seeds.
    """
    n = facts.sizes["seed"]
    if n < 2:
        raise ValueError(f"{n} seed is too few for an interval: run at least 2")
    rng = np.random.default_rng(seed)
    draws = (rng.integers(n, size=n) for _ in range(resamples))
    plain = sample_of(facts)
    resampled = _by_group(np.stack([terms(_resampled(plain, drawn)) for drawn in draws], axis=-1))
    own = terms(plain)
    score = _by_group(own[..., None])[..., 0]
    low, high = bootstrap_interval(np.moveaxis(resampled, -1, 0), n, CONFIDENCE)
    apart = resampled[:, :, None] - resampled[:, None, :]
    apart_low, apart_high = bootstrap_interval(np.moveaxis(apart, -1, 0), n, CONFIDENCE)
    dims = ("group", "variant", "other")
    return xr.Dataset(
        {
            "term": (("target", "variant"), own),
            "found": (("target", "variant"), np.stack([target.found(plain) for target in TARGETS])),
            "score": (dims[:2], score),
            "score_low": (dims[:2], low),
            "score_high": (dims[:2], high),
            "difference": (dims, score[:, :, None] - score[:, None, :]),
            "difference_low": (dims, apart_low),
            "difference_high": (dims, apart_high),
            "runs": facts.known.sum(["cell", "seed"]),
            "blocked": facts.blocked.sum(["cell", "seed"]),
            "not_run": (~facts.known).sum(["cell", "seed"]),
        },
        coords={
            "group": list(GROUPS),
            "variant": facts.variant.values,
            "other": facts.variant.values,
            "target": [target.statement for target in TARGETS],
        },
        attrs={"seeds": n, "resamples": resamples, "confidence": CONFIDENCE},
    )


def _resampled(sample: Sample, drawn: NDArray[np.int64]) -> Sample:
    return {cell: {name: values[:, drawn] for name, values in facts.items()} for cell, facts in sample.items()}


def _by_group(of_targets: Floats) -> Floats:
    """Sums over the targets of each group: (targets, ...) -> (groups, ...)."""
    own = np.array([target.group for target in TARGETS])
    return np.stack([of_targets[(own == group) | (group == "all")].sum(axis=0) for group in GROUPS])


def verdicts(found: xr.Dataset) -> dict[str, str]:
    """For each variant "best", "ruled out" or "not told apart" from the best, by the paired difference of scores.

    With fewer than LEAST_SEEDS seeds nothing is decided: "too few seeds".
    """
    of_all = found.sel(group="all")
    best = str(of_all.variant.values[int(of_all.score.values.argmin())])
    apart = of_all.sel(other=best)
    worse = apart.difference_low > 0.0
    words = {
        str(name): "ruled out" if bool(worse.sel(variant=name)) else "not told apart" for name in found.variant.values
    }
    if found.attrs["seeds"] < LEAST_SEEDS:
        words = dict.fromkeys(words, TOO_FEW)
    return words | {best: "best"}
