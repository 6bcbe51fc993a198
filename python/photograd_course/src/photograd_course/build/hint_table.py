"""Known mistakes by the fingerprint of their wrong answers, for `grading.hints`."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Collection, Mapping
from pathlib import Path

from ..assignment.bundle import PUBLIC_SECRET
from ..atomic_io import atomic_write
from ..grading.check import Check
from ..grading.hints import hint_key
from .assignment_build import AssignmentBuild
from .judging import Verdict
from .named import NamedMutant


def hints_of(
    mutants: Collection[NamedMutant],
    verdicts: Mapping[str, Verdict],
    checks: Collection[Check],
    secret: bytes,
) -> dict[str, str]:
    """The table: key to sentence. An answer that several mistakes share names none of them.

    Args:
        mutants, verdicts: the named mutants and what became of them.
        checks: those to speak about.
        secret: the salt of checks that are not public.
    """
    salts = {c.id: PUBLIC_SECRET if c.visibility == "public" else secret for c in checks}
    found: dict[str, set[str]] = defaultdict(set)
    for mutant in mutants:
        for each in verdicts[mutant.name].outcomes:
            print_ = each["details"].get("fingerprint")
            # Without a comparison the print is of a sentence that many mistakes share.
            compared = "tolerance" in each["details"]
            if compared and print_ is not None and each["id"] in salts:
                key = hint_key(salts[each["id"]].hex(), each["id"], print_)
                found[key].add(mutant.diagnosis)
    return {key: said.pop() for key, said in sorted(found.items()) if len(said) == 1}


def public_hints(build: AssignmentBuild) -> dict[str, str]:
    """The table for the public checks; the same for every course, since their seeds are."""
    checks = [check for check in build.checks if check.visibility == "public"]
    return hints_of(build.mutants, build.mutant_verdicts, checks, PUBLIC_SECRET)


def read_hints(folder: Path) -> dict[str, str]:
    """The committed table; empty where there is none."""
    path = folder / "hints.json"
    table: dict[str, str] = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    return table


def write_hints(folder: Path, table: Mapping[str, str]) -> None:
    """Commit a table to the folder; an empty one leaves no file."""
    path = folder / "hints.json"
    if table:
        atomic_write(path, (json.dumps(table, indent=1, sort_keys=True) + "\n").encode())
    else:
        path.unlink(missing_ok=True)
