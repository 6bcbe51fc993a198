"""docs/systems.toml: each system that is claimed has its files, its proofs and its assignment."""

from __future__ import annotations

import ast
import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from support.tree import ROOT

FIELDS = {"id", "title", "files", "proof"}


def systems() -> list[dict[str, Any]]:
    text = (ROOT / "docs" / "systems.toml").read_text(encoding="utf-8")
    found: list[dict[str, Any]] = tomllib.loads(text)["system"]
    return found


def module_file(module: str) -> Path | None:
    """The file of a module that test files share, or None: it is of another distribution."""
    tail = Path(*module.split(".")).with_suffix(".py")
    return next((top / tail for top in (ROOT, ROOT / "tests") if (top / tail).is_file()), None)


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def classes_of(path: Path) -> dict[str, set[str]]:
    """{class: its test methods} of a file, inherited ones included, and of what it imports."""
    found: dict[str, set[str]] = {}
    for node in parsed(path).body:
        if isinstance(node, ast.ImportFrom) and (source := module_file(node.module or "")):
            known = classes_of(source)
            found |= {n.asname or n.name: known[n.name] for n in node.names if n.name in known}
        elif isinstance(node, ast.ClassDef):
            bases = [found.get(base.id, set()) for base in node.bases if isinstance(base, ast.Name)]
            found[node.name] = set().union(own_tests(node.body), *bases)
    return found


def own_tests(body: list[ast.stmt]) -> set[str]:
    """Names of the test functions of a file's or a class's own statements."""
    functions = [node.name for node in body if isinstance(node, ast.FunctionDef)]
    return {name for name in functions if name.startswith("test_")}


@cache
def collected(path: Path) -> set[str]:
    """What pytest collects from a file: "function" and "Class::method"."""
    if not path.name.startswith("test_"):
        return set()
    found = own_tests(parsed(path).body)
    for name, methods in classes_of(path).items():
        found |= {f"{name}::{method}" for method in methods if name.startswith("Test")}
    return found


def faults(row: dict[str, Any], root: Path = ROOT) -> list[str]:
    """What is wrong with one row."""
    if not row.keys() >= FIELDS or not row.keys() <= FIELDS | {"assignment"}:
        return [f"fields {sorted(row)}"]
    found = [f"no file {name}" for name in row["files"] if not (root / name).is_file()]
    found += [] if row["files"] and row["proof"] else ["files and proof must not be empty"]
    for proof in row["proof"]:
        path, _, function = proof.partition("::")
        if not path.startswith("tests/") or not (root / path).is_file():
            found.append(f"no test file {path}")
        elif function not in collected(root / path):
            found.append(f"not collected: {proof}")
    if "assignment" in row and not (root / row["assignment"] / "assignment.toml").is_file():
        found.append(f"no assignment {row['assignment']}")
    return found


def test_rows_are_sorted_and_their_ids_unique() -> None:
    ids = [row["id"] for row in systems()]
    assert ids, "nothing is claimed"
    assert ids == sorted(set(ids))
    assert [name for name in ids if not re.fullmatch(r"[AB]\d{2,3}", name)] == []


@pytest.mark.parametrize("row", systems(), ids=lambda row: row["id"])
def test_what_a_row_names_exists(row: dict[str, Any]) -> None:
    assert faults(row) == []


def test_the_book_has_every_handout() -> None:
    folders = [path.parent.name for path in ROOT.glob("assignments/*/assignment.toml")]
    pages = {path.stem: path.read_text("utf-8") for path in (ROOT / "docs/handouts").glob("*.md")}
    assert sorted(pages) == sorted(folders)
    assert all(f"assignments/{name}/handout.md" in text for name, text in pages.items())


def test_a_broken_row_is_seen() -> None:
    here = "tests/house/test_systems.py"
    good = {
        "id": "A01",
        "title": "x",
        "files": [here],
        "proof": [f"{here}::test_a_broken_row_is_seen"],
    }
    assert faults(good) == []
    assert faults(good | {"files": ["cpp/none.h"]}) == ["no file cpp/none.h"]
    base = "tests/course/assignments/support.py"
    heir = "tests/course/assignments/test_01.py::TestGradientDescent"
    inherited = "test_the_solution_earns_everything"
    assert faults(good | {"proof": [f"{heir}::{inherited}"]}) == []
    for proof in (
        f"{here}::test_none",
        f"{here}::collected",
        f"{base}::{inherited}",  # a file that pytest passes by
        f"{base}::AssignmentTests::{inherited}",
        f"{heir}::test_none",
        f"{heir.partition('::')[0]}::{inherited}",  # a method, without its class
    ):
        assert faults(good | {"proof": [proof]}) == [f"not collected: {proof}"]
    assert faults(good | {"proof": ["tests/none.py::test_x"]}) == ["no test file tests/none.py"]
    assert faults(good | {"assignment": "assignments/none"}) == ["no assignment assignments/none"]
    assert faults({"id": "A01"}) == ["fields ['id']"]
