"""A page of HTML as tests look at it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from html.parser import HTMLParser

ALONE = {"meta", "img", "br", "hr", "link", "input"}
RAW = re.compile(r"\$|\\[a-zA-Z]{2,}|\b[a-zA-Z]_\{")


@dataclass
class Seen(HTMLParser):
    """What stands on a page.

    Attributes:
        ids, links, sources, alternatives: values of attributes, in order.
        prose: text outside of code, scripts and styles.
        displayed, formulas: how many equations stand alone, and MathML elements in all.
        open: elements that were not closed.
    """

    ids: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    alternatives: list[str] = field(default_factory=list)
    prose: list[str] = field(default_factory=list)
    values: list[str] = field(default_factory=list)
    displayed: int = 0
    formulas: int = 0
    open: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = {name: value or "" for name, value in attrs}
        if tag not in ALONE:
            self.open.append(tag)
        if "id" in named:
            self.ids.append(named["id"])
        if tag == "a":
            self.links.append(named["href"])
        if tag == "img":
            self.sources.append(named["src"])
            self.alternatives.append(named["alt"])
        if "data-copy" in named:
            self.values.append(named["data-copy"])
        self.formulas += tag == "math"
        self.displayed += named.get("class", "").startswith("equation")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not {"code", "script", "style"} & set(self.open):
            self.prose.append(data)


def look_at(page: str) -> Seen:
    """Parse a page; every element must be closed where it has to be."""
    seen = Seen()
    seen.feed(page)
    seen.close()
    assert seen.open == []
    return seen


def faults(page: str) -> list[str]:
    """What is wrong with any page: doubled ids, links to nowhere, formulas left as typed."""
    seen = look_at(page)
    doubled = {name for name in seen.ids if seen.ids.count(name) > 1}
    lost = {link for link in seen.links if link[1:] not in seen.ids or not link.startswith("#")}
    raw = [text for text in seen.prose if RAW.search(text)]
    unsaid = [
        source[:40]
        for source, said in zip(seen.sources, seen.alternatives, strict=True)
        if not said
    ]
    outside = [each for each in seen.sources if not each.startswith(("data:", "figures/"))]
    return [*doubled, *lost, *raw, *unsaid, *outside]
