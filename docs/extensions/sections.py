"""Docstrings as this project writes them, for autodoc.

An entry of Parameters or Attributes has its type in the line of its name, "v_d : float", and below what it is; or that
in the same line, "v_d : desired speed, m/s". Returns is prose. Both become lists and text of their own. Fields of a
NamedTuple take their words from the comments beside them, parameters of a law from their annotations.
"""

import inspect
import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from sphinx.application import Sphinx

from engine import laws
from engine.kernel.dispatch import Generic

ENTRY = re.compile(r"(?P<names>\w+(?:, \w+)*)(?: : (?P<words>.*))?$")
KIND = r"(?:float|int|bool|str|arrays?|None|[A-Z]\w+)"
TYPE = re.compile(rf"(?:\([^)]*\) )?{KIND}(?:(?:, | or ){KIND})*")  # "(N,) float", "float, str or None"
FIELD = re.compile(r"^    (?P<name>\w+): [^#\n]*#\s*(?P<words>.+)$", re.MULTILINE)
TITLES = ("Parameters", "Attributes", "Returns", "Yields", "Raises")


def translate(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Rewrite the lines of a docstring in place; the pages introduce modules themselves."""
    lines[:] = [] if what == "module" else [*_translated(lines), *_fields(thing)]


def skipped(app: Sphinx, what: str, name: str, thing: Any, skip: bool, options: Any) -> bool | None:
    """Leave out fields of NamedTuples, which the comments describe, and generic functions, which have a table."""
    field = type(thing).__name__ == "_tuplegetter"
    return True if field or isinstance(thing, Generic) else None


def without_ranges(
    app: Sphinx, what: str, name: str, thing: Any, options: Any, signature: str | None, returns: str | None
) -> tuple[str | None, str | None]:
    """The signature of a law without the ranges of its parameters, which are listed below."""
    if not _is_a_law(thing):
        return signature, returns
    return f"({', '.join(f'{field}: float' for field in thing._fields)})", returns


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
            term = ", ".join(f":py:exc:`.{name}`" if errors else f"``{name}``" for name in names)
            words = entry["words"] or ""
            typed = following.startswith(" ") and TYPE.fullmatch(words)
            yield f"{term} : {words}" if typed else term
            yield from (f"    {words}",) if words and not typed else ()
        else:
            yield line if not line or line.startswith(" ") else f"    {line}"


def _fields(thing: Any) -> Iterator[str]:
    if _is_a_law(thing):
        for name, parameter in laws.parameters_of(thing).items():
            unit = "" if parameter.unit == "1" else f", {parameter.unit}"
            yield from ("", f"``{name}``", f"    {parameter.meaning}{unit}; a number {parameter.requirement}")
    elif inspect.isclass(thing) and hasattr(thing, "_fields"):
        for field in FIELD.finditer(inspect.getsource(thing)):
            yield from ("", f"``{field['name']}``", f"    {field['words']}")


def _is_a_law(thing: Any) -> bool:
    return any(thing in call.laws for call in laws.KINDS.values() if inspect.isclass(thing))


def setup(app: Sphinx) -> dict[str, bool]:
    """Have autodoc ask here."""
    app.connect("autodoc-process-docstring", translate)
    app.connect("autodoc-process-signature", without_ranges)
    app.connect("autodoc-skip-member", skipped)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
