"""The lower bounds of the dependencies in pyproject.toml, as constraints: one `name==version` a line."""

import re
import tomllib
from pathlib import Path


def bounds(requirements: list[str]) -> list[str]:
    """`name==version` of each `name>=version`."""
    found = [re.fullmatch(r"([A-Za-z0-9_.-]+)>=([0-9][0-9A-Za-z.]*)", requirement) for requirement in requirements]
    plain = [match for match in found if match]
    if len(plain) < len(found):
        raise SystemExit(f"pyproject.toml: not all of {requirements} are of the form name>=version")
    return [f"{match[1]}=={match[2]}" for match in plain]


if __name__ == "__main__":
    path = Path(__file__).parents[1] / "pyproject.toml"
    print("\n".join(bounds(tomllib.loads(path.read_text("utf-8"))["project"]["dependencies"])))
