"""Lin, Ma & Lo (2016): Figures 4 to 10, from sweeps that all share. One module for each figure."""
