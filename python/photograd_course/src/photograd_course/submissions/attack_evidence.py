"""The attack suite, where there is a checkout: it lies with the tests, and is run from there."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..build.kits import ENVIRONMENT, PACKAGE
from ..worker.modes import probe

STRICT = ("A", "B", "C")
LONGEST = 3600.0  # seconds for all modes together
MOST_UNSTAGED = 4  # attacks that may lack a positive control

# Prints one line of JSON: which attacks have shown that they work, and what became of them.
PROGRAM = """
import json, sys
from course.attacks.attack import read_attacks
from course.attacks.controls import has_naive_control, require_naive_grader, run_control
from course.attacks.suite import run_suite

require_naive_grader()
attacks = read_attacks()
naive = {a.name: bool(run_control(a)[0]) for a in attacks if has_naive_control(a)}
tokens = [a.name for a in attacks if a.control["kind"] == "token"]
modes = run_suite(sys.argv[1:], attacks)
print(json.dumps({"attacks": [a.name for a in attacks], "naive": naive, "tokens": tokens,
                  "modes": modes}))
"""


def attack_evidence(tests: Path | None = None) -> dict[str, Any]:
    """Attacks with a positive control, and those survived in each mode that works here.

    Args:
        tests: the checkout's folder of tests; found where None.

    Returns:
        `ok`, `findings` and counts; `state` says "ran", or why it did not.
    """
    place = tests or PACKAGE.parents[3] / "tests"
    if not (place / "course" / "attacks" / "suite.py").is_file():
        return {"ok": False, "state": "not run: no checkout", "findings": ["attacks: not run"]}
    reasons = {mode: reason for mode, reason in probe().items() if mode in STRICT}
    modes = [mode for mode, reason in reasons.items() if not reason]
    missing = {mode: reason for mode, reason in reasons.items() if reason}
    if not modes:
        findings = ["attacks: no strict isolation works here"]
        return {"ok": False, "state": "not run", "findings": findings, "missing_modes": missing}
    try:
        found = _run(place, modes)
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        findings = [f"attacks: the suite failed: {error}"]
        return {"ok": False, "state": "failed", "findings": findings, "missing_modes": missing}
    return {**summary(found), "missing_modes": missing}


def summary(found: dict[str, Any]) -> dict[str, Any]:
    """Counts and findings of what PROGRAM printed."""
    names = list(found["attacks"])
    staged = {name for name, worked in found["naive"].items() if worked}
    modes: dict[str, dict[str, int]] = {}
    findings = []
    ran = set(found["tokens"])
    for mode, result in found["modes"].items():
        modes[mode] = {"attacks": int(result["attacks"]), "survived": int(result["survived"])}
        findings += [f"attacks, mode {mode}: {text}" for text in result["violations"]]
        if modes[mode]["survived"] < len(names) and not result["violations"]:
            findings.append(f"attacks, mode {mode}: only {modes[mode]['survived']} survived")
        ran -= {name for name in ran if not result["results"].get(name, {}).get("ran")}
    unstaged = [name for name in names if name not in staged | ran]
    if len(unstaged) > MOST_UNSTAGED:
        findings.append(
            f"attacks: {len(unstaged)} were not seen to work where nothing isolates, so that their "
            f"failing proves nothing: {', '.join(unstaged[:8])}"
        )
    if not names or not modes:
        findings.append("attacks: none ran")
    return {
        "ok": not findings,
        "state": "ran",
        "attacks": len(names),
        "with_positive_control": len(names) - len(unstaged),
        "unstaged": unstaged,
        "modes": modes,
        "findings": findings,
    }


def _run(tests: Path, modes: Sequence[str]) -> dict[str, Any]:
    path = os.pathsep.join([str(tests), str(tests.parent)])
    # The attacks are on the grader, with an assignment of their own, whichever course is examined.
    environment = {name: value for name, value in os.environ.items() if name != ENVIRONMENT}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *modes],
        capture_output=True,
        text=True,
        check=False,
        timeout=LONGEST,
        env={**environment, "PYTHONPATH": path},
    )
    if done.returncode:
        raise ValueError(done.stderr.strip()[-600:] or f"exit status {done.returncode}")
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found
