"""Tokens of any text, each character once, and those of Python where it is Python."""

from __future__ import annotations

import io
import sys
import tokenize
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from photograd_course.assignment.tokens import LAYOUT, code_words, tokens
from photograd_course.submissions.submission import SOURCE_BYTES

SOURCES = sorted(Path(__file__).parents[3].glob("assignments/*/checks/*.py"))
_SILENT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}
TRICKY = r"""
x = 0x1e + 5 - 1_000.5e-3j ** .5 // 0b1_0 if a != b else rB'\'' ":=" 'it''s'
s = u"a\
b" + '''a'b''c\'''' + f(*a, **k)[1:2, ...] ; y: int = (lambda z: z @ z)(1.) ; x @= ~y ; x **= 2
def 𝜎(größe, /) -> None: ...  # says 'nothing'
"""


def standard(text: str) -> list[str]:
    found = tokenize.generate_tokens(io.StringIO(text).readline)
    return [token.string for token in found if token.type not in _SILENT]


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="there f-strings are taken to pieces")
def test_tokens_are_those_of_python() -> None:
    assert len(SOURCES) > 5
    for text in [TRICKY, *(path.read_text(encoding="utf-8") for path in SOURCES)]:
        assert code_words(text) == standard(text)


@pytest.mark.parametrize(
    "piece", ["'\\'", '"""\\"', "'", '"" "', "\\", "(", "0_", "1e", "a'", "\n'\\", "''' '"]
)
def test_no_text_is_looked_at_twice(piece: str) -> None:
    """`tokenize` needs minutes for some of these, and more for twice as many."""
    text = piece * (SOURCE_BYTES // len(piece))
    assert "".join(token.text for token in tokens(text)) == text


@given(st.text(alphabet="'\"\\\n #ab0.e([{)]}=rf", max_size=40))
@settings(max_examples=200, deadline=None)
def test_nothing_is_an_error_and_nothing_is_lost(text: str) -> None:
    assert "".join(token.text for token in tokens(text)) == text


def test_a_line_ends_no_statement_within_brackets() -> None:
    kinds = [token.kind for token in tokens("f(\n)\n") if token.text == "\n"]
    assert kinds == [LAYOUT, "end"]
