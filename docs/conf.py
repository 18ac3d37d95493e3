"""Sphinx configuration of the documentation: `make docs` builds it, `docs/_build/html/index.html` is its first page."""

import sys
from importlib import metadata
from pathlib import Path

import sweep

sys.path.insert(0, str(Path(__file__).parent / "extensions"))
for name in sweep.__all__:
    getattr(sweep, name)  # imported when first asked for: autodoc lists what is there

project = "jamsweep"
author = project_copyright = "The jamsweep authors"
release = version = metadata.version(project)

extensions = ["myst_parser", "sphinx.ext.autodoc", "references", "sections", "mathml", "tables"]
exclude_patterns = ["_build"]
default_role = "code"  # of `single backticks` in docstrings

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
myst_update_mathjax = False  # formulas are MathML

autodoc_default_options = {"members": True}
autodoc_member_order = "bysource"
autodoc_preserve_defaults = False  # of rooms, whose options stand in no source line
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
add_module_names = False
toc_object_entries_show_parents = "hide"

nitpicky = True
nitpick_ignore = [  # types of an attribute of Store that is not for users
    ("py:class", "sweep.storage.manifest.Manifest"),
    ("py:class", "sweep.storage.manifest.Entry"),
    ("py:class", "engine.options.Made"),  # a type variable
]
nitpick_ignore_regex = [  # no inventory of another project is fetched: the build needs no network
    *(
        (r"py:.*", rf"~?({package})\..*")
        for package in ("numpy", "xarray", "pandas", "pathlib", "collections", "typing", "click")
    ),
    ("py:class", r".*Parameter"),  # range of a parameter of a law, which `above`, `at_least` and `between` make
]

html_theme = "furo"
html_title = f"jamsweep {release}"
html_static_path = ["static"]
html_css_files = ["tables.css"]
html_math_renderer = "mathml"
html_show_copyright = False
html_copy_source = False
