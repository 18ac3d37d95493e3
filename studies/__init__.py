"""Studies: one figure or table of a paper each, with its grid, its measure, its plot and its verdicts."""
