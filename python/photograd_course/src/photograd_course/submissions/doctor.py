"""Is the course what it claims to be? Everything is found out by running it.

Each assignment is built and judged (rules, mutants, alternatives), its solution is graded as a
submission is, and the attacks are let loose on the grader in every strict isolation mode.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ..assignment.bundle import Bundle
from ..build.evidence import evidence
from ..build.kits import no_sources, source_folders
from ..errors import Error
from ..grading.outcome import Status
from ..worker.modes import note, probe
from .attack_evidence import attack_evidence
from .load import load
from .one import Case, grade_one
from .submission import Submission
from .workers import isolated_workers

# What an assignment must have some of, so that a missing part is no silent success.
REQUIRED = ("checks", "named_mutants", "automatic_mutants", "alternatives")
Say = Callable[[str], None]


def examine(
    *, quick: bool = False, root: Path | None = None, say: Say | None = None
) -> dict[str, Any]:
    """The state of the whole course.

    Args:
        quick: leave the attacks out; they take minutes.
        root: the folder of assignments; by default the checkout's.
        say: told what is being looked at.

    Returns:
        `ok`, `findings` (what is wrong, one sentence each), `modes`, `assignments`, `attacks`.
    """
    tell = say or (lambda _: None)
    folders = source_folders(root)
    assignments = []
    for name, folder in folders.items():
        tell(f"assignment {name}")
        assignments.append(examine_assignment(folder, root))
    tell("attacks" if not quick else "attacks left out")
    attacks = {"ok": True, "state": "not run: --quick", "findings": []}
    if not quick:
        attacks = attack_evidence()
    findings = [text for each in (*assignments, attacks) for text in each["findings"]]
    if not folders:
        findings.append(str(no_sources("doctor", "assignments")))
    sound = bool(folders) and all(each["ok"] for each in (*assignments, attacks))
    modes = {mode: reason or _works(mode) for mode, reason in probe().items()}
    return {
        "ok": sound and not findings,
        "complete": not quick,
        "findings": findings,
        "modes": modes,
        "assignments": assignments,
        "attacks": attacks,
    }


def _works(mode: str) -> str:
    """That it does, and which of its layers are weaker here than they might be."""
    weaker = note(mode) if mode != "E" else ""  # E has no layers
    return f"works; {weaker}" if weaker else "works"


def examine_assignment(folder: Path, root: Path | None = None) -> dict[str, Any]:
    """Evidence of one assignment, and what grading its solution gives and takes."""
    name = folder.name
    try:
        found = evidence(folder, root=root)
        graded = grade_solution(folder)
    except Exception as error:  # whatever is broken, the others still get looked at
        said = error.text if isinstance(error, Error) else f"{type(error).__name__}: {error}"
        return {"assignment": name, "ok": False, "findings": [f"{name}: {said}"]}
    findings = [f"{name}: {text}" for text in found["findings"]]
    findings += [f"{name}: {text}" for text in (*_lacking(found), *graded.pop("findings"))]
    return {**found, **graded, "ok": bool(found["ok"]) and not findings, "findings": findings}


def grade_solution(folder: Path) -> dict[str, Any]:
    """Grade the solution in isolated workers: mode, seconds, and points of the code.

    Raises:
        GraderFault: no isolation mode is good enough here.
    """
    loaded = load(folder.name, folder)
    bundle = loaded.read()
    module = folder / f"{bundle.manifest.module}.py"
    submission = Submission(bundle.solution_files(module.read_text(encoding="utf-8")))
    with isolated_workers(bundle.manifest, None, (folder,)) as workers:
        report = grade_one(Case("solution", submission, bundle, loaded.digest), workers)
    findings = [
        f"graded as a submission, the solution does not pass {outcome.id}: {outcome.text}"
        for outcome in report.checks
        if outcome.status is not Status.PASSED
    ]
    return {
        "grading_mode": report.mode,
        "grading_seconds": report.seconds,
        "code_points": sum(outcome.points for outcome in report.checks),
        "code_points_max": _points(bundle),
        "findings": findings,
    }


def _points(bundle: Bundle) -> float:
    return float(sum(check.points for check in bundle.checks))


def _lacking(found: dict[str, Any]) -> Sequence[str]:
    missing = [f"{key}: none" for key in REQUIRED if not found.get(key)]
    if not found["findings"]:
        for key in ("margin_right", "margin_wrong"):
            value = found.get(key)
            if not isinstance(value, (int, float)) or not math.isfinite(value):
                missing.append(f"{key}: not measured")
    return missing
