"""Running: workers, back ends, limits, the order of runs and what is noted of failures."""
