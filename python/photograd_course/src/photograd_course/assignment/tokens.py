"""The tokens of Python text, in a time proportional to its length, whatever the text is.

The standard `tokenize` starts over at each quote that is not closed, which takes minutes for 200 KB
of them, and its tokens change between versions of Python, while the numbers that are drawn from a
submission must not. Here each character is looked at once, and nothing is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

NAME, NUMBER, STRING, OPERATOR, END, LAYOUT = (
    "name",
    "number",
    "string",
    "operator",
    "end",
    "layout",
)


class Token(NamedTuple):
    """One token: its kind and its characters.

    END ends a statement: a line's end outside of brackets. LAYOUT is a comment, a blank, or a
    line's end within them.
    """

    kind: str
    text: str


# The first that fits is taken, and each fits however it goes on, so nothing is looked at twice. A
# string that is not closed ends with its line, or with the text where it has three quotes.
_PATTERN = re.compile(
    r"""
    (?P<layout> [ \t\f\r]+ | \#[^\n]* | \\\r?\n )
    | (?P<end> \n )
    | (?P<string> (?i:[rbuf]|[bf]r|r[bf])? (?:
        \"\"\" (?: [^"\\]+ | \\. | "(?!"") )* (?:\"\"\")?
        | ''' (?: [^'\\]+ | \\. | '(?!'') )* (?:''')?
        | " (?: [^"\\\n]+ | \\. )* "?
        | ' (?: [^'\\\n]+ | \\. )* '? ) )
    | (?P<number> 0[xXbBoO][0-9a-fA-F_]+
        | (?: [0-9][0-9_]*\.?[0-9_]* | \.[0-9][0-9_]* ) (?:[eE][+-]?[0-9][0-9_]*)? [jJ]? )
    | (?P<name> \w+ )
    | (?P<operator> \*\*=? | //=? | >>=? | <<=? | \.\.\. | -> | := | [-+*/%&|^=<>!@]= | . )
    """,
    re.VERBOSE | re.DOTALL,
)


def tokens(source: str) -> Iterator[Token]:
    """All of them, so that their texts make up the source again."""
    depth = 0
    for found in _PATTERN.finditer(source):
        kind, text = str(found.lastgroup), found[0]
        if kind == OPERATOR and text in "([{":
            depth += 1
        elif kind == OPERATOR and text in ")]}":
            depth = max(0, depth - 1)
        yield Token(LAYOUT if kind == END and depth else kind, text)


def code_words(source: str) -> list[str]:
    """The tokens of a text without comments and layout."""
    return [text for kind, text in tokens(source) if kind not in {END, LAYOUT}]
