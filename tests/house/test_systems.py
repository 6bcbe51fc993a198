"""docs/systems.toml: each system that is claimed has its files, its proofs and its assignment."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from support.tree import ROOT

FIELDS = {"id", "title", "files", "proof"}


def systems() -> list[dict[str, Any]]:
    text = (ROOT / "docs" / "systems.toml").read_text(encoding="utf-8")
    found: list[dict[str, Any]] = tomllib.loads(text)["system"]
    return found


def functions_of(path: Path) -> set[str]:
    """Names of the test functions of a file, those in classes included."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    return {node.name for node in nodes if isinstance(node, ast.FunctionDef)}


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
        elif not function.startswith("test_") or function not in functions_of(root / path):
            found.append(f"no test {proof}")
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
    assert faults(good | {"proof": [f"{here}::test_none"]}) == [f"no test {here}::test_none"]
    assert faults(good | {"proof": ["tests/none.py::test_x"]}) == ["no test file tests/none.py"]
    assert faults(good | {"assignment": "assignments/none"}) == ["no assignment assignments/none"]
    assert faults({"id": "A01"}) == ["fields ['id']"]
