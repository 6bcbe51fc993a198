"""What the doctor found, on a terminal or as JSON."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.text import Text

from ..cli.output import print_json
from ..printable import printable
from .report_json import canonical


def print_examination(result: dict[str, Any], *, as_json: bool) -> None:
    """Print tables and findings; with `as_json` these go to stderr and one JSON line to stdout."""
    console = Console(stderr=as_json, highlight=False)
    for entry in result["assignments"]:
        for line in _assignment(entry):
            console.print(Text(printable(line)), soft_wrap=True)
    for line in (*_modes(result["modes"]), *_attacks(result["attacks"])):
        console.print(Text(printable(line)), soft_wrap=True)
    for finding in result["findings"]:
        console.print(Text(f"✗ {printable(finding)}", style="dark_orange"), soft_wrap=True)
    verdict = "all is well" if result["ok"] else f"{len(result['findings'])} findings"
    more = "" if result["complete"] else " (attacks left out)"
    console.print(Text(verdict + more, style="bold"))
    if as_json:
        print_json(canonical(result).decode())


def _assignment(entry: dict[str, Any]) -> list[str]:
    lines = [f"{entry['assignment']}: {'ok' if entry['ok'] else 'not ok'}"]
    if "alternatives" in entry:
        lines += [
            f"  {entry['checks']} checks, {entry['named_mutants_as_listed']} of "
            f"{entry['named_mutants']} named mutants lose what they should, "
            f"{entry['automatic_mutants_killed']} of {entry['automatic_mutants']} automatic ones "
            f"killed ({entry['equivalent']} equivalent), {entry['alternatives_accepted']} of "
            f"{entry['alternatives']} alternatives accepted",
            f"  right answers use {_short(entry['margin_right'])} of a tolerance at most, wrong "
            f"ones exceed one {_short(entry['margin_wrong'])} times at least",
        ]
    if "grading_seconds" in entry:
        seconds, mode = entry["grading_seconds"], entry["grading_mode"]
        lines.append(f"  the solution was graded in {seconds:.1f} s, isolation mode {mode}")
    return lines


def _short(value: object) -> str:
    return f"{value:.1e}" if isinstance(value, (int, float)) else "?"


def _modes(modes: dict[str, str]) -> list[str]:
    return [f"isolation mode {mode}: {reason}" for mode, reason in modes.items()]


def _attacks(attacks: dict[str, Any]) -> list[str]:
    if "modes" not in attacks:
        return [f"attacks: {attacks['state']}"]
    first = f"attacks: {attacks['with_positive_control']} of {attacks['attacks']} work elsewhere"
    return [
        f"{first} (positive control)",
        *(
            f"attacks, mode {mode}: {each['survived']} of {each['attacks']} survived"
            for mode, each in attacks["modes"].items()
        ),
    ]
