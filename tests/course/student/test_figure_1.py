"""What a handout calls "what you will have made", the exploration makes: Figure 1."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from photograd_course.viz.handout import Fact
from PIL import Image

from course.assignments.support import figure_facts, load_figures
from course.student.explored import FOLDERS, TINY, explore, finished_kit

LONG = pytest.mark.exhaustive
# Explorations that end with Figure 1 itself; the other options are as small as they may be.
DRAWN = ("01", "02", "03", "04", "05", "08", pytest.param("07", marks=LONG))
DRAWN = (*DRAWN, pytest.param("09", marks=LONG), pytest.param("10", marks=LONG))
DRAWN = (*DRAWN, pytest.param("11", marks=LONG), pytest.param("14", marks=LONG))


def facts_of(number: str) -> Mapping[str, Fact]:
    """What the caption of Figure 1 claims, computed for the handout."""
    folder = FOLDERS[number]
    name = next(name for name in load_figures(folder).FIGURES if name.startswith("fig1_"))
    facts = figure_facts(folder, name)
    assert all(fact.holds for fact in facts.values())
    return facts


def shown(value: object) -> str:
    return str(bool(value)) if str(value) in {"True", "False"} else f"{float(str(value)):.5g}"


def output(number: str, folder: Path, *words: str) -> str:
    done = explore(finished_kit(number, folder, with_core=True), *words)
    assert done.returncode == 0, done.stderr
    return done.stdout


def size_of(picture: Path) -> tuple[int, int]:
    with Image.open(picture) as image:
        return image.size


def number_after(text: str, pattern: str) -> float:
    (found,) = re.findall(pattern, text)
    return float(found)


@pytest.mark.parametrize("number", DRAWN)
def test_the_exploration_draws_figure_1_and_says_what_its_caption_claims(
    number: str, tmp_path: Path
) -> None:
    small = {**TINY[number], "figure": 1}
    words = [word for name, value in small.items() for word in (f"--{name}", str(value))]
    said = output(number, tmp_path, *words)
    told = dict(re.findall(r"^Figure 1: (.*): (\S+)$", said, re.MULTILINE))
    assert told == {claim: shown(fact.value) for claim, fact in facts_of(number).items()}
    assert size_of(tmp_path / "figure_1.png")[0] > 500


def test_00_draws_figure_1(tmp_path: Path) -> None:
    assert "gradient.png" in output("00", tmp_path)
    assert size_of(tmp_path / "gradient.png")[0] > 500


@LONG
def test_06_is_nearer_to_the_traced_frame_than_the_caption_says(tmp_path: Path) -> None:
    said = output("06", tmp_path)
    assert number_after(said, r"tuned: (\S+) from the traced frame") < 0.04
    assert size_of(tmp_path / "frame.png") == (528, 330)
    facts_of("06")


@LONG
def test_12_reaches_the_decibels_of_figure_1(tmp_path: Path) -> None:
    said = output("12", tmp_path)
    fact = facts_of("12")["above 25 dB"]
    reached = number_after(said, r"(\S+) dB on held-out views")
    assert reached == pytest.approx(fact.value, abs=0.051)
    assert number_after(said, r"(\S+) numbers, 2500 steps") == 8180


def test_13_has_the_lead_of_figure_1_and_beats_the_tuned_leaves(tmp_path: Path) -> None:
    said = output("13", tmp_path)
    fact = facts_of("13")["the hash grid is better by more than 7 dB"]
    grid, network = (
        number_after(said, rf"{name}: \d+ steps.*?(\S+) dB") for name in ("hash grid", "network")
    )
    assert grid - network == pytest.approx(fact.value, abs=0.11)
    assert grid > number_after(said, r"fine-tuned (\S+) dB") + 5
