"""Positive controls: each attack succeeds against the naive grader, or leaves its token.

An attack that fails everywhere proves nothing about the grader it fails against.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from course.attacks.attack import ASSIGNMENT, MODULE, Attack
from course.naive_grader.cage import FULL, HARD_SECONDS, HUNG_SECONDS, Naive, grade_naively

FLOODED = 1 << 20  # bytes that no report has by itself


def has_naive_control(attack: Attack) -> bool:
    """Whether it must succeed against the naive grader."""
    return attack.control["kind"] == "naive"


def run_control(attack: Attack) -> tuple[bool, Naive]:
    """Whether it gained there what attack.toml says, and what came of it."""
    with tempfile.TemporaryDirectory(prefix="naive-", ignore_cleanup_errors=True) as folder:
        scratch = Path(folder) / "scratch"
        scratch.mkdir()
        found = grade_naively(
            attack.controlled(),
            scratch,
            ASSIGNMENT / MODULE,
            earlier=attack.control.get("earlier"),
            wait=attack.control.get("wait", 0.0),
            seconds=HUNG_SECONDS if attack.control["gain"] == "hang" else HARD_SECONDS,
        )
    return gained(attack, found), found


def require_naive_grader() -> None:
    """Without an attack, the naive grader must grade: else no attack fails there for its own sake.

    Raises:
        RuntimeError: it does not, with what it has printed.
    """
    with tempfile.TemporaryDirectory(prefix="naive-", ignore_cleanup_errors=True) as folder:
        scratch = Path(folder) / "scratch"
        scratch.mkdir()
        solution = ASSIGNMENT / MODULE
        found = grade_naively(solution.read_bytes(), scratch, solution)
    if found.report.get("score") != FULL:
        raise RuntimeError(f"the naive grader does not run on this machine: {found.log[-400:]}")


def gained(attack: Attack, found: Naive) -> bool:
    """Whether the naive grader was harmed as announced."""
    gain = attack.control["gain"]
    if gain == "score":
        return found.score >= attack.control["minimum"]
    if gain == "leak":
        return attack.control["text"] in json.dumps(found.report, ensure_ascii=False)
    if gain == "innocent":  # the next student loses points
        scores = [found.report.get("innocent"), found.next_score]
        return any(score is not None and score < FULL for score in scores)
    if gain == "strays":
        return bool(found.strays)
    if gain == "flood":
        return found.size > FLOODED
    if gain == "hang":
        return found.hung
    if gain == "lost":  # no report, or one without a result, though the grader ended
        return not found.hung and not found.report.get("score")
    raise AssertionError(f"{attack.name}: an unknown gain {gain!r}")
