"""How a time falls with the width of a door: exponentially, or as a power."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy import stats

from studies.measures.facts import described, needs

Floats = NDArray[np.float64]
LAWS = ("exponential", "power")
TELLING = 2.0  # difference of AIC below which neither law is better (Burnham & Anderson 2002, Sec. 2.6)


def fitted(x: Floats, log_t: Floats, confidence: float) -> tuple[float, float, float, float]:
    """Slope of a least squares line with its limits, and AIC of the fit with 3 parameters."""
    line = stats.linregress(x, log_t)
    left = log_t - line.intercept - line.slope * x
    n = x.size
    arm = stats.t.ppf(0.5 + confidence / 2.0, n - 2) * line.stderr
    aic = n * np.log(np.sum(left**2) / n) + 2.0 * 3
    return float(line.slope), float(line.slope - arm), float(line.slope + arm), float(aic)


def decay(ds: xr.Dataset, of: str, along: str = "L", confidence: float = 0.95) -> xr.Dataset:
    """Fits of ln t = a + b x, an exponential, and ln t = a + b ln x, a power, to the times of all runs.

    Parameters
    ----------
    ds : Dataset with the times `of` (along, ...) s; times that are not finite and above 0 are left out
    of : str
        Name of the variable.
    along : str
        The axis x, above 0.
    confidence : float
        Of the limits of the slopes.

    Returns
    -------
    Dataset with `slope` (law), 1/m for the exponential and 1 for the power, `slope_low`, `slope_high`; `aic`
    (law), Akaike's criterion, less for the better law; `better`, the law's name, or "undecided" where they differ by
    less than 2; `runs` fitted.

    Raises
    ------
    ValueError
        If a variable is missing, x is not above 0, or there are fewer than three x.
    """
    needs(ds, of, along)
    t, x = xr.broadcast(ds[of], ds[along].astype(np.float64))
    times, at = t.values.ravel(), x.values.ravel()
    good = np.isfinite(times) & (times > 0)
    if not (at > 0).all() or np.unique(at[good]).size < 3:
        raise ValueError(f"{along} must be above 0 and have three values with finite times, for a law to be told")
    log_t = np.log(times[good])
    rows = np.array([fitted(axis[good], log_t, confidence) for axis in (at, np.log(at))])
    slope, low, high, aic = (xr.DataArray(column, dims="law", coords={"law": list(LAWS)}) for column in rows.T)
    apart = abs(float(aic[0] - aic[1]))
    better = LAWS[int(np.argmin(aic.values))] if apart >= TELLING else "undecided"
    return xr.Dataset(
        {
            "slope": described(slope, "1", "slope of ln t against x, or ln x"),
            "slope_low": described(low, "1", "slope: lower limit", confidence=confidence),
            "slope_high": described(high, "1", "slope: upper limit", confidence=confidence),
            "aic": described(aic, "1", "Akaike's information criterion"),
            "better": described(xr.DataArray(better), "1", "law of the lesser AIC"),
            "runs": described(xr.DataArray(int(good.sum())), "1", "runs fitted"),
        }
    )
