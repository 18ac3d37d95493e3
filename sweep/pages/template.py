"""Pages made of the files in `assets`: everything in one file, nothing from a network."""

import html
import json
import re
from collections.abc import Mapping, Sequence
from importlib import metadata, resources
from typing import Any

POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"


def page(title: str, body: str, styles: Sequence[str], scripts: Sequence[str] = (), facts: Any = None) -> str:
    """An HTML page.

    Parameters
    ----------
    title : plain text
    body : HTML
    styles, scripts : names of files in `assets`; the scripts share one scope, in this order
    facts : what the scripts find, as JSON, in the element `facts`
    """
    css = "\n".join(map(asset, styles))
    parts = [
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f'<meta name="generator" content="jamsweep {version()}">',
        f"<title>{html.escape(title)}</title>\n<style>\n{css}</style>\n</head>\n<body>\n{body}",
    ]
    if facts is not None:
        parts.append(f'<script type="application/json" id="facts">{_json(facts)}</script>')
    if scripts:
        code = "\n".join(map(asset, scripts))
        parts.append(f'<script>\n"use strict";\n(() => {{\n{code}}})();\n</script>')
    return "\n".join([*parts, "</body>\n</html>\n"])


def filled(body: str, words: Mapping[str, str]) -> str:
    """HTML with each `{{name}}` replaced by the HTML that `words` has for it."""
    return re.sub(r"\{\{(\w+)\}\}", lambda found: words[found[1]], body)


def asset(name: str) -> str:
    """The text of a file in `assets`."""
    return resources.files("sweep.pages").joinpath("assets", name).read_text("utf-8")


def version() -> str:
    """Version of the installed jamsweep."""
    try:
        return metadata.version("jamsweep")
    except metadata.PackageNotFoundError:
        return "(not installed)"


def rows_of(pairs: Sequence[tuple[str, str]]) -> str:
    """A list of names and values as HTML."""
    inside = "".join(f"<dt>{html.escape(name)}</dt><dd>{html.escape(value)}</dd>" for name, value in pairs)
    return f"<dl>{inside}</dl>"


def _json(facts: Any) -> str:
    """JSON that no parser of HTML takes for a tag."""
    return json.dumps(facts, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
