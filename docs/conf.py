"""Settings of the book: Sphinx with Markdown, citations from cpp/references.bib, docstrings."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pybtex.plugin import register_plugin
from pybtex.style.formatting.unsrt import Style
from pybtex.style.labels import BaseLabelStyle
from sphinx.util.inspect import TypeAliasForwardRef

sys.path.insert(0, str(Path(__file__).resolve().parent))
import api_pages
import docstrings
import mathematics

if TYPE_CHECKING:
    from collections.abc import Iterator

    from sphinx.application import Sphinx

project = "photograd"
author = "the photograd authors"
extensions = ["myst_parser", "sphinxcontrib.bibtex", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
bibtex_bibfiles = ["../cpp/references.bib"]
bibtex_default_style = "keys"
exclude_patterns = ["README.md"]
html_theme = "furo"
html_title = "photograd"
html_math_renderer = "mathml"  # of mathematics.py: needs no network
html_static_path = [
    "../python/photograd_course/src/photograd_course/build/page/mathematics.woff2",
    "_static",
]
html_css_files = ["book.css"]
html_show_search_summary = False  # fetched page by page, which browsers refuse for files
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
smartquotes_action = "qe"  # -- stands before options

default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_type_aliases = {
    **{name: f"photograd.types.{name}" for name in ("Array", "FloatArray")},
    "ArrayLike": "numpy.typing.ArrayLike",
}
napoleon_numpy_docstring = False
napoleon_custom_sections = [("Fields", "params_style")]
napoleon_use_param = False  # which would describe "spp, seed" once for each
napoleon_use_rtype = False
python_use_unqualified_type_names = True
toc_object_entries_show_parents = "hide"

PROTOCOL = (
    "photograd.representation.base",
    "photograd.representation.fittable",
    "photograd.fields.voxel_field",
)
"""Modules whose methods are described once, though many classes override them."""


class KeyLabels(BaseLabelStyle):
    """The label of a reference is the key under which the sources cite it."""

    def format_labels(self, entries: list[Any]) -> Iterator[str]:
        """Labels in the order of the entries."""
        for entry in entries:
            yield entry.key


class KeyStyle(Style):
    """The plain style with keys as labels."""

    default_label_style = KeyLabels


# Inside of a union or a container, autodoc writes an alias as its repr.
TypeAliasForwardRef.__repr__ = lambda alias: alias.name

register_plugin("pybtex.style.formatting", "keys", KeyStyle)


def _edit_docstring(
    _app: Sphinx, what: str, _name: str, _thing: object, _options: object, lines: list[str]
) -> None:
    lines[:] = docstrings.to_rst(lines, is_property=what in {"attribute", "property"})


def _edit_signature(
    _app: Sphinx,
    _what: str,
    _name: str,
    _thing: object,
    _options: object,
    signature: str | None,
    returns: str | None,
) -> tuple[str | None, str | None]:
    """Without the marks of short names, which autodoc leaves where it cannot parse a default."""
    return signature and re.sub(r"~(?=\w)", "", signature), returns


def _skip_overrides(
    _app: Sphinx, _what: str, _name: str, thing: Any, _skip: bool, _options: object
) -> bool | None:
    """Methods that a representation has by protocol are described there, not in each class."""
    thing = getattr(thing, "fget", None) or getattr(thing, "__func__", thing)
    owner, _, name = getattr(thing, "__qualname__", "").rpartition(".")
    cls = getattr(sys.modules.get(getattr(thing, "__module__", "")), owner, None)
    if not isinstance(cls, type):
        return None
    bases = (base for base in cls.__mro__[1:] if base.__module__ in PROTOCOL)
    return True if any(name in vars(base) for base in bases) else None


def setup(app: Sphinx) -> None:
    """Write the pages of the reference before Sphinx looks for pages."""
    mathematics.register(app)
    app.connect("config-inited", lambda *_: api_pages.write())
    app.connect("autodoc-process-signature", _edit_signature)
    app.connect("autodoc-skip-member", _skip_overrides)
    app.connect("autodoc-process-docstring", _edit_docstring, priority=100)  # before napoleon
