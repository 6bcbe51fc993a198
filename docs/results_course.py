"""Runs `photograd course doctor` and writes its figures into docs/results.md.

    python docs/results_course.py [--quick] [--found FILE]

The whole takes some twenty minutes on two cores. FILE is the JSON line of an earlier run.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).resolve().parent / "results.md"
BEGIN, END = "<!-- course -->", "<!-- end of course -->"
HEAD = (
    "| assignment | checks | questions | named mutants killed | automatic mutants killed "
    "| equivalent | alternatives accepted | right answers use | wrong ones exceed | graded in, s |"
)


def examined(quick: bool) -> dict[str, Any]:
    """What the doctor found, from a run."""
    words = ["course", "doctor", "--json", *(["--quick"] if quick else [])]
    done = subprocess.run(
        [sys.executable, "-m", "photograd_course", *words],
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return found


def section(found: dict[str, Any], before: str) -> str:
    """The tables; raises SystemExit for findings, which are no result.

    Without attacks in `found`, what `before` says of them stays: they know nothing of assignments.
    """
    if found["findings"]:
        raise SystemExit("\n".join(["not written, the doctor has findings:", *found["findings"]]))
    lines = [HEAD, "|" + "---|" * (HEAD.count("|") - 1)]
    lines += [_row(each) for each in found["assignments"]]
    attacks = found["attacks"]
    if "modes" not in attacks:
        _, mark, rest = before.strip("\n").partition("Attacks on the grader")
        lines += ["", mark + rest] if mark else []
    else:
        lines += [
            "",
            f"Attacks on the grader: {attacks['attacks']}, of which "
            f"{attacks['with_positive_control']} are seen to work on a naive grader.",
            "",
            "| isolation mode | attacks survived |",
            "|---|---|",
        ]
        lines += [
            f"| {mode} | {each['survived']} of {each['attacks']} |"
            for mode, each in attacks["modes"].items()
        ]
    return "\n".join(lines)


def _row(each: dict[str, Any]) -> str:
    cells = [
        each["assignment"],
        each["checks"],
        each["questions"],
        f"{each['named_mutants_as_listed']} of {each['named_mutants']}",
        f"{each['automatic_mutants_killed']} of {each['automatic_mutants']}",
        each["equivalent"],
        f"{each['alternatives_accepted']} of {each['alternatives']}",
        f"{each['margin_right']:.1e}",
        f"{each['margin_wrong']:.1e}",
        f"{each['grading_seconds']:.1f}",
    ]
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> None:
    """Measure, and rewrite what stands between the two markers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="without the attacks, whose rows stay")
    parser.add_argument("--found", type=Path, help="JSON of an earlier run, instead of a new one")
    given = parser.parse_args()
    if given.found:
        found = json.loads(given.found.read_text(encoding="utf-8").strip().splitlines()[-1])
    else:
        found = examined(given.quick)
    head, rest = RESULTS.read_text(encoding="utf-8").split(BEGIN)
    before, tail = rest.split(END)
    text = section(found, before)
    RESULTS.write_text(f"{head}{BEGIN}\n{text}\n{END}{tail}", encoding="utf-8")


if __name__ == "__main__":
    main()
