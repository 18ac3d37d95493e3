"""`make bench`: this engine and its peers on one jam, in one run, as one table of ratios."""
