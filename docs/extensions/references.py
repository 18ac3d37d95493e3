"""References in signatures, which name the module where something is defined, led to the package that exports it."""

from typing import Any

from docutils.nodes import Element
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

OURS = ("engine", "sweep", "studies")


def resolve(app: Sphinx, env: BuildEnvironment, node: pending_xref, shown: Element) -> Any:
    """The documented object of the same name, `engine.Scenario` for `engine.scenario.Scenario`; None if none is."""
    package, _, rest = node.get("reftarget", "").lstrip("~").partition(".")
    if node.get("refdomain") != "py" or package not in OURS:
        return None
    name = rest.rpartition(".")[2]
    known = [full for full in env.domains["py"].objects if full.startswith(package) and full.endswith(f".{name}")]
    if len(known) != 1:
        return None
    return env.domains["py"].resolve_xref(env, node["refdoc"], app.builder, "obj", known[0], node, shown)


def setup(app: Sphinx) -> dict[str, bool]:
    """Have Sphinx ask here before it calls a reference broken."""
    app.connect("missing-reference", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
