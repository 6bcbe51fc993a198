"""A key such as [Max1995, Eq. 8] in a comment stands in cpp/references.bib."""

from __future__ import annotations

import io
import re
import tokenize
from collections.abc import Iterator

from support.tree import ROOT, cpp_texts, python_texts

BIB = ROOT / "cpp" / "references.bib"
KEY = r"[A-Z][A-Za-z]*\d{4,5}[a-z]?"  # five digits: numbers of standards
# [Key], [Key, Eq. 3], [Key1; Key2], [Key1, Key2]; indices such as [R2000] never look like that.
CITATION = re.compile(rf"\[({KEY}(?:[;,][^\[\]]*)?)\]")
REQUIRED = {"author", "title", "year"}


def cited(comment: str) -> set[str]:
    return {key for group in CITATION.findall(comment) for key in re.findall(KEY, group)}


def cpp_comments(text: str) -> str:
    blocks = re.findall(r"/\*.*?\*/", text, re.DOTALL)
    return "\n".join(re.findall(r"//.*", text) + blocks)


def python_comments(text: str) -> Iterator[str]:
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in {tokenize.COMMENT, tokenize.STRING}:
            yield token.string


def entries() -> dict[str, set[str]]:
    """Fields of each entry of the bibliography; an entry ends at a brace at the line's start."""
    text = BIB.read_text(encoding="utf-8")
    found: dict[str, set[str]] = {}
    for key, body in re.findall(r"^@\w+\{([^,\s]+),\n(.*?)^\}", text, re.MULTILINE | re.DOTALL):
        assert key not in found, f"{key} stands twice in {BIB.name}"
        found[key] = set(re.findall(r"^\s*(\w+)\s*=", body, re.MULTILINE))
    assert len(found) == len(re.findall(r"^@", text, re.MULTILINE)), "an entry is malformed"
    return found


def all_citations() -> dict[str, set[str]]:
    """Keys by the file that cites them."""
    found = {f"cpp/{path}": cited(cpp_comments(text)) for path, text in cpp_texts().items()}
    for path, text in python_texts().items():
        found[path] = {key for comment in python_comments(text) for key in cited(comment)}
    return {path: keys for path, keys in found.items() if keys}


def test_every_cited_key_is_in_the_bibliography() -> None:
    known = entries().keys()
    citations = all_citations()
    assert citations, "the sources cite nothing, so the pattern is wrong"
    missing = [f"{path}: [{key}]" for path, keys in citations.items() for key in keys - known]
    assert sorted(missing) == []


def test_entries_say_who_what_and_when() -> None:
    bad = {key: REQUIRED - fields for key, fields in entries().items() if REQUIRED - fields}
    assert bad == {}
    assert [key for key in entries() if not re.fullmatch(KEY, key)] == []


def test_the_forms_of_a_citation() -> None:
    assert cited("[Max1995], [Mildenhall2020, Eq. 3]; [Sun2022; Kingma2015, Alg. 1]") == {
        "Max1995",
        "Mildenhall2020",
        "Sun2022",
        "Kingma2015",
    }
    assert cited("values[i], [0, 1], shape [R, S]") == set()
