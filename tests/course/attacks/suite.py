"""Run the attacks against the real grader, in one isolation mode after another.

`run_suite` is also a program, so that mode C can be tried where root has lost its capabilities:
`python -m course.attacks.suite --mode C --attacks 01 02` prints the results as JSON.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from photograd_course.submissions.report import Report

from course.attacks import traces
from course.attacks.attack import ASSIGNMENT, MODULE, Attack, read_attacks
from course.attacks.privileges import run_like_a_container
from course.attacks.session import Session, is_full, pages, shown
from course.naive_grader.cage import bubblewrap

Results = Mapping[str, Mapping[str, Any]]
STRICT = ("A", "B", "C")
LONGEST_PAGE = 1 << 20
MOST_GROWTH = 300 << 10  # kilobytes by which a submission may raise the grader's peak memory


def strongest() -> str:
    """The best mode, judged by what is installed, since collecting tests must be quick."""
    return "A" if bubblewrap() else "C"


def run_suite(modes: Sequence[str] = STRICT, attacks: Sequence[Attack] | None = None) -> Any:
    """The attacks' results by mode.

    Args:
        modes: "A", "B" or "C"; C runs in a process without the capabilities that containers lack.
        attacks: by default all.

    Returns:
        {mode: {"attacks": n, "survived": n, "ran": n, "violations": [...], "results": {...}}}.
    """
    chosen = list(read_attacks() if attacks is None else attacks)
    found = {}
    for mode in modes:
        if mode == "C":
            names = [f"{attack.number:02}" for attack in chosen]
            results = run_like_a_container(["--mode", mode, "--attacks", *names])
        else:
            results = run_mode(mode, chosen)
        survived = [name for name, result in results.items() if not result["violations"]]
        found[mode] = {
            "attacks": len(results),
            "survived": len(survived),
            "ran": sum(result["ran"] for result in results.values()),
            "violations": [
                f"{name}: {text}"
                for name, result in results.items()
                for text in result["violations"]
            ],
            "results": results,
        }
    return found


def run_mode(mode: str, attacks: Sequence[Attack]) -> dict[str, dict[str, Any]]:
    """Each attack's result in one mode, by name."""
    with Session(mode) as session:
        referee = Referee(session)
        results = {attack.name: referee.judge(attack) for attack in attacks}
        whole = session.innocent([check.id for check in session.bundle.checks])
        assert is_full(whole), whole
        return results


class Referee:
    """Grades attacks in a session, and looks at what they leave."""

    def __init__(self, session: Session) -> None:
        self._session = session
        source = (ASSIGNMENT / MODULE).read_text(encoding="utf-8")
        self._numbers = traces.hidden_numbers(session.bundle, source)
        self._innocent = session.innocent()
        assert is_full(self._innocent), self._innocent
        self._vault = traces.fingerprint_of(session.vault)
        self._program = traces.program_of(session.home)
        self._shared = traces.shared_names()
        session.workers.take_log()

    def judge(self, attack: Attack) -> dict[str, Any]:
        """What it earned, how long it took, whether it ran, and each rule that it broke."""
        violations: list[str] = []
        scores, logs, longest = [], "", 0.0
        before = _restarted_peak()
        for name, upload in attack.variants().items():
            started = time.monotonic()
            report = self._session.grade(upload, attack.checks)
            longest = max(longest, time.monotonic() - started)
            log = self._session.workers.take_log(attack.token)
            scores.append(report.proven)
            where = f"{name}: " if name else ""
            violations += [where + text for text in self._about(attack, report, log)]
            logs += log
        if longest > attack.budget_seconds:
            violations.append(f"took {longest:.1f} s of {attack.budget_seconds:g}")
        if (grown := _peak() - before) > MOST_GROWTH:
            violations.append(f"the grader's memory grew by {grown >> 10} MB")
        violations += self._left()
        ran = attack.token in logs
        if attack.runs and not ran:
            violations.append("left no token: its payload did not run")
        return {
            "score": max(scores),
            "max_points": attack.max_points,
            "seconds": round(longest, 2),
            "ran": ran,
            "violations": violations,
        }

    def _about(self, attack: Attack, report: Report, log: str) -> list[str]:
        found = []
        if report.proven > attack.max_points:
            found.append(f"earned {report.proven:g} of at most {attack.max_points:g} points")
        if report.staff:
            found.append(f"counts as our own failure: {report.staff[0][:300]}")
        if [outcome.id for outcome in report.checks] != list(_sorted(self._session, attack)):
            found.append("the report has other checks than the bundle")
        found += sorted({line for line in log.splitlines() if line.startswith("escape:")})
        text = shown(report)
        if "leaked_" in text:
            found.append("the report on a hidden check quotes the submission")
        if numbers := traces.quoted(text, self._numbers):
            found.append(f"the report on a hidden check quotes hidden numbers: {numbers[:3]}")
        for name, page in pages(report).items():
            if len(page) > LONGEST_PAGE:
                found.append(f"{name} has {len(page)} bytes")
            if name == "page" and "<script" in page.lower():
                found.append("a tag of the submission stands in the page")
            if "\x1b" in page:
                found.append(f"an escape sequence stands in {name}")
        return found

    def _left(self) -> list[str]:
        session, found = self._session, []
        if pids := traces.living(session.home):
            found.append(f"processes of the worker's user are left: {pids}")
        if rooms := list(session.home.folder.glob("room-*")):
            found.append(f"working folders are left: {len(rooms)}")
        if traces.fingerprint_of(session.vault) != self._vault:
            found.append("changed what belongs to the grader or to another student")
        if traces.program_of(session.home) != self._program:
            found.append("changed the worker's program")
        if strays := traces.shared_names() - self._shared:
            found.append(f"left files: {sorted(map(str, strays))[:3]}")
        innocent = session.innocent()
        session.workers.take_log()
        if innocent != self._innocent:
            found.append(
                f"another submission is graded differently afterwards: {innocent[:2000]!r}"
            )
        return found


def _sorted(session: Session, attack: Attack) -> Sequence[str]:
    return [check.id for check in session.bundle.checks if check.id in attack.checks]


def _restarted_peak() -> int:
    """Forget the largest memory so far, or an attack could hide behind a hungrier one before it."""
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    return _peak()


def _peak() -> int:
    """The largest memory that this process has had since the restart, in kilobytes."""
    status = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
    return int(status.split("VmHWM:")[1].split()[0])


def main() -> None:
    """Print results as JSON."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--mode", required=True)
    parser.add_argument("--attacks", nargs="*", type=int)
    words = parser.parse_args()
    attacks = [each for each in read_attacks() if each.number in (words.attacks or range(100))]
    print(json.dumps(run_mode(words.mode, attacks)))  # noqa: T201


if __name__ == "__main__":
    main()
