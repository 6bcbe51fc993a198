"""No telling run of five tokens of the solution occurs in what students can see.

What counts as telling is defined in `leak_words`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from ..assignment_build import AssignmentBuild
from ..leak_words import (
    Shingle,
    fenced_code,
    says_something,
    shingles_in,
    shingles_of,
    well_known_shingles,
)
from .leaked_names import seen_texts


def check_leaked_shingles(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    telling = telling_shingles(build)
    for path, text in sorted(seen_texts(build).items()):
        if path.endswith(".py"):
            code = text
        elif path.endswith(".md"):
            continue  # its fences are given on purpose, its sentences are no code
        else:
            code = text.replace("\\n", "\n").replace('"', " ")
        common = sorted(shingles_in(telling, code))
        if common:
            more = f" and {len(common) - 1} more" if len(common) > 1 else ""
            yield f"'{' '.join(common[0])}'{more} of the solution stands in {path}"


def telling_shingles(build: AssignmentBuild) -> set[Shingle]:
    """Those of the solution that are evidence."""
    handout = build.visible.get("kit/README.md", b"").decode("utf-8")
    given = shingles_of(build.starter) | shingles_of(fenced_code(handout))
    given |= shingles_of(_headers(build.starter))
    parts = {each for part in build.parts for each in shingles_of(_dedented(part.text))}
    return {each for each in parts - given - well_known_shingles() if says_something(each)}


def _headers(text: str) -> str:
    """The functions of a text with the names of their arguments, a line each: not annotated."""
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    return "".join(
        f"def {each.name}({', '.join(arg.arg for arg in each.args.args)}): ...\n"
        for each in functions
    )


def _dedented(text: str) -> str:
    """Lines moved to the left, so that the tokenizer takes them for a module."""
    lines = text.splitlines()
    margin = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return "\n".join(line[margin:] for line in lines) + "\n"
