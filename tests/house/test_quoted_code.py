"""Pages of the book quote parts of source files, between two markers that must stand there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from support.tree import ROOT

QUOTE = re.compile(r"```\{literalinclude\} (?P<file>\S+)\n(?P<options>(?::.*\n)+)```")
PAGES = [page for page in sorted((ROOT / "docs").glob("*.md")) if QUOTE.search(page.read_text())]


def test_there_are_quotes() -> None:
    assert [page.name for page in PAGES] == ["path_tracer.md"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_markers_stand_once_and_in_order(page: Path) -> None:
    for quote in QUOTE.finditer(page.read_text()):
        text = (page.parent / quote["file"]).read_text()
        options = dict(re.findall(r':([a-z-]+): "(.*)"', quote["options"]))
        assert set(options) == {"start-at", "end-before"}
        for marker in options.values():
            assert text.count(marker) == 1, f"{marker!r} in {quote['file']}"
        assert text.index(options["start-at"]) < text.index(options["end-before"])
