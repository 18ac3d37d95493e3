"""Parisi & Dorso (2005): every figure and Table 1, from two sweeps that all share. One module for each."""
