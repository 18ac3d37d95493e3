"""The subcommands of `jamsweep`, one file for those of a kind."""
