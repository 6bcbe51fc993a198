"""The prose of a page: letters of formulas, links to what a sentence names, values to copy."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from html import escape

from .letters import typeset

NUMBER = r"[−-]?\d+(?:\.\d+)?(?:[eE][−-]?\d+)?(?![\d.]*\w)"
TUPLE = rf"\((?:{NUMBER}, )+{NUMBER}\)"
VALUE = re.compile(rf"{TUPLE}|(?<![\w.(]){NUMBER}|(?<=\(){NUMBER}")
SPECIAL = re.compile(
    r"(?P<cited>\b[A-Z][A-Za-z-]+\d{4}[a-z]?\b)"
    r"|(?P<figure>\bFigure (?P<figure_number>\d+)\b)"
    r"|(?P<section>\b[Ss]ection (?P<section_number>\d+)\b)"
    r"|(?P<equation>(?<![\w)\]⟩′'])\((?P<equation_number>\d{1,2})\))"
)


class Kind(Enum):
    """What a paragraph is: a caption (or heading), values to compare with, a reference, a text."""

    CAPTION = "caption"
    CITED = "cited"
    TEXT = "text"
    VALUES = "values"


@dataclass
class Names:
    """Numbers and keys that have a place on the page."""

    equations: set[str] = field(default_factory=set)
    figures: set[str] = field(default_factory=set)
    sections: set[str] = field(default_factory=set)
    cited: set[str] = field(default_factory=set)


class Prose:
    """Makes HTML of pieces of text, in the order in which they are read.

    Args:
        names: what can be linked to.
        glossary: words to explain where they first stand, and how.
    """

    def __init__(self, names: Names, glossary: Mapping[str, str]) -> None:
        self._names = names
        self._glossary = dict(glossary)
        self._explained: dict[str, str] = {}
        self._kind = Kind.TEXT
        forms = sorted(self._glossary, key=len, reverse=True)
        spelled = "|".join(re.escape(form).replace(r"\ ", r"\s") for form in forms)
        self._words = re.compile(rf"\b(?:{spelled})s?\b", re.IGNORECASE) if forms else None

    def begin(self, kind: Kind) -> None:
        """A paragraph begins."""
        self._kind = kind

    def html(self, text: str, *, links: bool = True) -> str:
        """HTML of a piece; inside of a link no others are made."""
        parts, at = [], 0
        for found in SPECIAL.finditer(text) if links else ():
            if target := self._target(found):
                parts.append(self._plain(text[at : found.start()]))
                parts.append(f'<a href="#{target}">{escape(found[0], quote=False)}</a>')
                at = found.end()
        return "".join([*parts, self._plain(text[at:])])

    def words(self) -> str:
        """The list of words that were explained, for the end of the page."""
        if not self._explained:
            return ""
        rows = "".join(
            f'<div id="word-{_slug(word)}"><dt>{escape(word)}</dt><dd>{escape(said)}</dd></div>\n'
            for word, said in sorted(self._explained.items())
        )
        return f'<h2 id="words">Words</h2>\n<dl class="words">\n{rows}</dl>\n'

    def _target(self, found: re.Match[str]) -> str:
        names = self._names
        if found["cited"] in names.cited:
            return str(found["cited"])
        if found["figure_number"] in names.figures and self._kind is not Kind.CAPTION:
            return f"fig-{found['figure_number']}"
        if found["section_number"] in names.sections:
            return f"section-{found['section_number']}"
        if found["equation_number"] in names.equations:
            return f"eq-{found['equation_number']}"
        return ""

    def _plain(self, text: str) -> str:
        if self._kind is Kind.CITED:
            return escape(text, quote=False)  # whose single letters are initials
        if self._kind is not Kind.VALUES:
            return self._explain(text)
        parts, at = [], 0
        for found in VALUE.finditer(text):
            if "." not in found[0] and "," not in found[0]:
                continue
            parts += [self._explain(text[at : found.start()]), _value(found[0])]
            at = found.end()
        return "".join([*parts, self._explain(text[at:])])

    def _explain(self, text: str) -> str:
        if self._words is None or self._kind is Kind.CAPTION:
            return typeset(text)
        parts, at = [], 0
        for found in self._words.finditer(text):
            word = self._word(found[0])
            if word in self._explained:
                continue
            self._explained[word] = self._glossary[word]
            parts += [typeset(text[at : found.start()]), self._term(found[0], word)]
            at = found.end()
        return "".join([*parts, typeset(text[at:])])

    def _word(self, shown: str) -> str:
        plain = re.sub(r"\s", " ", shown)
        for form in (plain, plain.removesuffix("s")):
            for word in self._glossary:
                if word.lower() == form.lower():
                    return word
        raise AssertionError(shown)  # the pattern was made of these words

    def _term(self, shown: str, word: str) -> str:
        said = escape(self._glossary[word])
        tip = f'<span class="tip" role="tooltip" id="tip-{_slug(word)}">{said}</span>'
        return (
            f'<span class="term"><a href="#word-{_slug(word)}" '
            f'aria-describedby="tip-{_slug(word)}">{escape(shown)}</a>{tip}</span>'
        )


def _value(text: str) -> str:
    """A number or a tuple of numbers, copied by a click in the form that Python reads."""
    plain = text.replace("−", "-")
    shown = escape(text.replace("-", "−"), quote=False)
    return (
        f'<span class="value" role="button" tabindex="0" data-copy="{escape(plain)}">{shown}</span>'
    )


def _slug(word: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", word.lower()).strip("-")
