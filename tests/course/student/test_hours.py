"""Hours are estimates, and the same in the handout and in the manifest."""

from __future__ import annotations

import re

import pytest
from photograd_course.assignment.manifest import read_manifest
from photograd_course.build.kits import source_folders

WORDS = dict(
    zip(("five", "seven", "eight", "ten", "eleven", "twelve"), (5, 7, 8, 10, 11, 12), strict=True)
)
FOLDERS = {name[:2]: folder for name, folder in source_folders().items()}
GRADED = sorted(set(FOLDERS) - {"00"})


def total(parts: str) -> float:
    """The sum of "1½, 2 and ½"."""
    return sum(
        float(whole or 0) + 0.5 * bool(half)
        for whole, half in re.findall(r"(?=[\d½])(\d*)(½?)", parts)
    )


@pytest.mark.parametrize("number", GRADED)
def test_the_handout_calls_its_hours_an_estimate(number: str) -> None:
    text = " ".join((FOLDERS[number] / "handout.md").read_text("utf-8").split())
    hours = read_manifest(FOLDERS[number]).hours
    (said,) = re.findall(r"(?:in )?an estimated ([^.(]*?)[.(]", text)
    word, _, parts = said.partition(" hours")
    if word in WORDS:
        assert hours == WORDS[word]
        listed = parts.removeprefix(":")
    else:
        listed = word
    if re.search(r"\d", listed):
        assert total(listed) == hours
