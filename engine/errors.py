"""Bad input: one line that names the thing, its value, what is required and the remedy."""


class BadInput(ValueError):
    """Input that no run can be made of; the message is the line a user reads."""


def require(holds: bool, thing: str, value: object, requirement: str, remedy: str) -> None:
    """Raise `BadInput` unless `holds`.

    Parameters
    ----------
    holds : whether the requirement is met
    thing, value : what was given, as the user knows it
    requirement, remedy : clauses that end the message

    Raises
    ------
    BadInput
        "exit width 0.3 m is narrower than the largest person (0.7 m): widen the exit".
    """
    if not holds:
        raise BadInput(f"{thing} {value} {requirement}: {remedy}")
