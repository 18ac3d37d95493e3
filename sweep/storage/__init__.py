"""The store: files of runs, shards, the manifest that vouches for them, and what holds them against each other."""
