"""Shells can complete commands and options."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

MODULE = [sys.executable, "-m", "photograd_course"]


def answer(words: list[str], **variables: str) -> str:
    done = subprocess.run(
        [*MODULE, *words],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    return done.stdout


@pytest.mark.parametrize(
    ("line", "completed"),
    [("photograd cou", "course"), ("photograd course che", "check"), ("photograd fi", "fit")],
)
def test_words_are_completed(line: str, completed: str) -> None:
    count = len(line.split()) - 1
    words = answer([], _PHOTOGRAD_COMPLETE="complete_bash", COMP_WORDS=line, COMP_CWORD=str(count))
    assert words.split() == [completed]


def test_the_script_for_a_shell_is_shown() -> None:
    script = answer(["--show-completion", "bash"], _TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION="1")
    assert "_PHOTOGRAD_COMPLETE=complete_bash" in script
