"""What can go wrong with a sweep besides bad input; each message is the line a user reads."""


class SweepStopped(RuntimeError):
    """A sweep that ended early; the runs it had finished are kept."""


class CannotWrite(SweepStopped):
    """A store that takes no more: a full disk, a quota, a file system that became read-only."""


class DamagedFile(RuntimeError):
    """A file of the store that is not what was written."""
