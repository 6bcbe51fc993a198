"""Settings of the book: Sphinx with Markdown, citations from cpp/references.bib."""

from __future__ import annotations

project = "photograd"
author = "the photograd authors"
extensions = ["myst_parser", "sphinxcontrib.bibtex"]
bibtex_bibfiles = ["../cpp/references.bib"]
exclude_patterns = ["README.md"]
html_theme = "furo"
html_title = "photograd"
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
