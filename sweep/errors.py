"""What can go wrong with a sweep besides bad input; each message is the line a user reads."""


class SweepStopped(RuntimeError):
    """A sweep that ended early; the runs it had finished are kept."""


class DamagedFile(RuntimeError):
    """A file of the store that is not what was written."""
