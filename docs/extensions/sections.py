"""Docstrings as this project writes them, for autodoc.

An entry of Parameters or Attributes says what it is in the line of its name, "v_d : desired speed, m/s"; Returns is
prose. Both become lists and text of their own. Fields of a NamedTuple take their words from the comments beside them.
"""

import inspect
import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from sphinx.application import Sphinx

from engine.kernel.dispatch import Generic

ENTRY = re.compile(r"(?P<names>\w+(?:, \w+)*)(?: : (?P<words>.*))?$")
FIELD = re.compile(r"^    (?P<name>\w+): (?P<type>\w+)[^#\n]*(?:#\s*(?P<words>.+))?$", re.MULTILINE)
TITLES = ("Parameters", "Attributes", "Returns", "Yields", "Raises")


def translate(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Rewrite the lines of a docstring in place; the pages introduce modules themselves."""
    lines[:] = [] if what == "module" else [*_translated(lines), *_fields(thing)]


def skipped(app: Sphinx, what: str, name: str, thing: Any, skip: bool, options: Any) -> bool | None:
    """Leave out fields of NamedTuples, which the comments describe, and generic functions, which have a table."""
    field = type(thing).__name__ == "_tuplegetter"
    return True if field or isinstance(thing, Generic) else None


def _translated(lines: list[str]) -> Iterator[str]:
    heads = [k for k, line in enumerate(lines[:-1]) if line in TITLES and set(lines[k + 1]) == {"-"}]
    yield from lines[: heads[0]] if heads else lines
    for head, following in pairwise([*heads, len(lines)]):
        title, body = lines[head], lines[head + 2 : following]
        yield from ("", f".. rubric:: {title}", "")
        yield from body if title in ("Returns", "Yields") else _entries(body, title == "Raises")
        yield ""


def _entries(body: list[str], errors: bool) -> Iterator[str]:
    """A definition list: names, and below them what is said of them."""
    for line, following in pairwise([*body, ""]):
        entry = ENTRY.match(line)
        if entry:
            names = entry["names"].split(", ")
            yield ", ".join(f":py:exc:`.{name}`" if errors else f"``{name}``" for name in names)
            starts = following.lstrip()[:1].isupper()  # a type such as "float" stands as a sentence before what follows
            yield from (f"    {entry['words']}" + "." * starts,) if entry["words"] else ()
        else:
            yield line if not line or line.startswith(" ") else f"    {line}"


def _fields(thing: Any) -> Iterator[str]:
    if not (inspect.isclass(thing) and hasattr(thing, "_fields")):
        return
    for field in FIELD.finditer(inspect.getsource(thing)):
        words = field["words"] or ("a pure number" if field["type"] == "float" else "")
        yield from ("", f"``{field['name']}``", f"    {words}") if words else ()


def setup(app: Sphinx) -> dict[str, bool]:
    """Have autodoc ask here."""
    app.connect("autodoc-process-docstring", translate)
    app.connect("autodoc-skip-member", skipped)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
