"""The kernel: all that turns a scenario into a run. A run's key holds a hash of this folder, and of no other."""
