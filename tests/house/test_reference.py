"""The API reference describes every public name once; its pages come from docs/api_pages.py."""

from __future__ import annotations

import ast
import re
import sys
from collections import Counter
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
try:
    import api_pages
    import docstrings
finally:
    sys.path.pop(0)

SOURCES = (
    ("photograd", ROOT / "python/photograd"),
    ("photograd_course", ROOT / "python/photograd_course/src/photograd_course"),
)
DIRECTIVE = re.compile(r"^\.\. (autofunction|autoclass|py:data):: (\S+)$", re.MULTILINE)


@cache
def directives() -> list[tuple[str, str]]:
    """(kind, dotted name) of everything that the pages describe."""
    return [found for text in api_pages.pages().values() for found in DIRECTIVE.findall(text)]


def public_modules() -> dict[str, Path]:
    """Modules without an underscore in their names; commands have pages of their own."""
    found = {}
    for root, folder in SOURCES:
        for path in folder.rglob("*.py"):
            parts = [*path.relative_to(folder).with_suffix("").parts]
            parts = parts[:-1] if parts[-1] == "__init__" else parts
            if not any(part.startswith("_") for part in parts) and parts[:1] not in (
                ["commands"],
                ["cli"],
            ):
                found[".".join([root, *parts])] = path
    return found


def defined_names(path: Path) -> set[str]:
    """Public functions, classes and constants at the top level of a file."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    body += [inner for node in body if isinstance(node, ast.If | ast.Try) for inner in node.body]
    names = {node.name for node in body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    for node in body:
        targets = node.targets if isinstance(node, ast.Assign) else []
        targets = [node.target] if isinstance(node, ast.AnnAssign) else targets
        names |= {target.id for target in targets if isinstance(target, ast.Name)}
    return {name for name in names if not name.startswith("_")}


def test_no_name_is_described_twice() -> None:
    counts = Counter(name for _, name in directives())
    assert len(counts) > 1500
    assert [name for name, count in counts.items() if count > 1] == []


@pytest.mark.usefixtures("core")
def test_every_public_name_is_described_once() -> None:
    described = Counter()
    for kind, name in directives():
        module, _, own = name.rpartition(".")
        if kind != "py:data":
            thing = getattr(import_module(module), own)
            module, own = thing.__module__, thing.__name__
        described[module, own] += 1
    wanted = {(name, own) for name, path in public_modules().items() for own in defined_names(path)}
    assert sorted(wanted - described.keys()) == []
    assert [pair for pair, count in described.items() if count > 1] == []


@pytest.mark.usefixtures("core")
def test_names_at_the_door_are_described_there() -> None:
    import photograd

    described = {name for _, name in directives()}
    things = {
        name
        for name in photograd.__all__
        if not isinstance(getattr(photograd, name), type(photograd))
    }
    assert {f"photograd.{name}" for name in things} <= described


def test_a_planted_name_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text("A: int = 1\n_B = 2\nif A:\n    def f(): ...\nclass C: ...\n", encoding="utf-8")
    assert defined_names(path) == {"A", "f", "C"}


@pytest.mark.parametrize(
    ("text", "rst"),
    [
        ("|x| and a * b_ of `c_*`", r"\|x\| and a \* b\_ of `c_*`"),
        ("Some `Target`s.", r"Some `Target`\ s."),
        ("As in [Kerbl2023, eq. 7].", "As in [:cite:label:`Kerbl2023`, eq. 7]."),
        ("Not [Nobody1901].", "Not [Nobody1901]."),
        ("Sum:\n    a * b\nEnd.", "Sum:\n\n::\n\n    a * b\n\nEnd."),
        ("- one\n  two", "- one\n  two"),
        ("Args:\n    x: a * b\n        c", "Args:\n    x: a \\* b\n        c"),
        ("Attributes:\n    x: y", "Fields:\n    x: y"),
        (">>> f(*x)\n(a|b)\n\na|b", ">>> f(*x)\n(a|b)\n\na\\|b"),
        (
            "See cpp/photograd/ops/composite.h, docs/bench.md.",
            "See :doc:`ops/composite.h </api/sources/ops.composite>`, :doc:`/bench`.",
        ),
    ],
)
def test_docstrings_become_restructured_text(text: str, rst: str) -> None:
    assert "\n".join(docstrings.to_rst(text.split("\n"))) == rst


def test_a_property_has_no_type_before_its_colon() -> None:
    lines = docstrings.to_rst(["All views: three."], is_property=True)
    assert lines == ["..", "", "All views: three."]


def test_files_of_the_core_that_docstrings_name_are_there() -> None:
    sources = api_pages.named_sources()
    assert len(sources) > 25
    assert [source for source in sources if not (ROOT / "cpp/photograd" / source).is_file()] == []


def test_docstrings_name_no_other_sources() -> None:
    """A reader of the pages has no repository: files of the core are shown, pages linked."""
    assert api_pages.unknown_files() == []
