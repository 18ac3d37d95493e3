"""Tables that are made of the code while the pages are built: none of them can drift from it."""

import inspect
from collections.abc import Callable, Iterable, Sequence

from docutils.nodes import Node
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from engine import laws
from engine.kernel.dispatch import Generic
from engine.options import LEVELS
from sweep import schema
from sweep.cli import cli
from sweep.schema import Variable

FROM_CONTACTS, FROM_SAMPLES, FULL = "`contacts`", "`record_every` > 0", '`record="full"`'


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    return "\n".join("| " + " | ".join(line) + " |" for line in (head, ["---"] * len(head), *rows))


def run_variables() -> str:
    """Every variable of a run file."""
    head = ("variable", "dimensions", "type", "unit", "what", "recorded with")
    return table(head, (_run_variable(v) for v in schema.VARIABLES))


def _run_variable(v: Variable) -> tuple[str, ...]:
    more = f"; counts the elements of `{v.counts}`" if v.counts else ""
    more += "; " + _flags() if "flag_values" in v.attrs else ""
    return f"`{v.name}`", _dims(v.dims), v.dtype, _unit(v.units), v.long_name + more, _recorded_with(v)


def _recorded_with(v: Variable) -> str:
    dims = {*v.dims, v.counts}
    needs = [FROM_SAMPLES] if dims & {"sample", "contact"} else []
    needs += [FROM_CONTACTS] if "contact" in dims else []
    needs += [FULL] if v.name in schema.FULL_STATE else []
    return ", ".join(needs) or "always"


def gathered_variables() -> str:
    """Every variable of a gathered dataset."""
    head = ("variable", "dimensions", "type", "unit", "what", "where there is none")
    rows = (
        (
            f"`{v.name}`",
            "axes, `exit`" if v.dims == schema.EXIT else "axes",
            v.dtype,
            _unit(v.units),
            v.long_name,
            schema.OUTCOMES[schema.MISSING] if v.name == "outcome" else str(v.pad),
        )
        for v in schema.GATHERED
    )
    return table(head, rows)


def parameters() -> str:
    """Keywords of rooms as coordinates."""
    rows = ((f"`{name}`", _unit(units), words) for name, (units, words) in schema.PARAMETERS.items())
    return table(("coordinate", "unit", "what"), rows)


def outcomes() -> str:
    """The outcomes with their numbers."""
    return _flags()


def law_kinds() -> str:
    """What a model's fields must have a law of, and the laws that there are."""
    fields: dict[Generic, list[str]] = {}
    for kind, generic in laws.KINDS.items():
        fields.setdefault(generic, []).append(f"`{kind}`")
    rows = [
        (", ".join(kinds), f"`{g.__name__}{inspect.signature(inspect.unwrap(g))}`", _first_paragraph(g))
        for g, kinds in fields.items()
    ]
    return table(("field of a model", "function", "what"), rows)


def law_types() -> str:
    """The laws of each kind."""
    kinds: dict[str, list[str]] = {}
    for kind, call in laws.KINDS.items():
        names = ", ".join(f"`{law.__name__}`" for law in call.laws)
        kinds.setdefault(names, []).append(f"`{kind}`")
    return table(("field of a model", "laws"), ((", ".join(fields), names) for names, fields in kinds.items()))


def accuracy_levels() -> str:
    """What each level of accuracy stands for."""
    rows = (
        (
            f'`"{name}"`',
            f"`{level.integrator}`",
            f"{1e3 * level.longest_step:g} ms",
            f"{level.force_tolerance:g} N",
            f"{level.solver_tolerance:g} m/s",
        )
        for name, level in LEVELS.items()
    )
    return table(("accuracy", "integrator", "longest step", "force tolerance", "solver tolerance"), rows)


def commands() -> str:
    """The commands of the shell."""
    rows = ((f"`jamsweep {name}`", command.get_short_help_str(limit=200)) for name, command in cli.commands.items())
    return table(("command", "what it does"), rows)


def _flags() -> str:
    return ", ".join(f"{k} {word}" for k, word in enumerate(schema.OUTCOMES))


def _dims(dims: Sequence[str]) -> str:
    return ", ".join(f"`{dim}`" for dim in dims)


def _unit(units: str) -> str:
    return "" if units == "1" else f"`{units}`"


def _first_paragraph(generic: Generic) -> str:
    return " ".join((generic.__doc__ or "").split("\n\n")[0].split())


TABLES: dict[str, Callable[[], str]] = {
    "run-variables": run_variables,
    "gathered-variables": gathered_variables,
    "parameters": parameters,
    "outcomes": outcomes,
    "law-kinds": law_kinds,
    "law-types": law_types,
    "accuracy-levels": accuracy_levels,
    "commands": commands,
}


class FromCode(SphinxDirective):
    """`{from-code} NAME`: the table of this name."""

    required_arguments = 1

    def run(self) -> list[Node]:
        """The table's nodes."""
        if self.arguments[0] not in TABLES:
            raise self.error(f"no table {self.arguments[0]!r}: choose one of {', '.join(TABLES)}")
        return self.parse_text_to_nodes(TABLES[self.arguments[0]]())


def setup(app: Sphinx) -> dict[str, bool]:
    """Offer the directive."""
    app.add_directive("from-code", FromCode)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
