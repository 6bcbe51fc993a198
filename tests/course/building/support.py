"""An assignment that a test changes, and what the rules then say."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from photograd_course.build.assignment_build import AssignmentBuild
from photograd_course.build.course_files import build_of
from photograd_course.build.rules import READING, RUNNING, findings

from support.tree import ROOT

TOY = ROOT / "tests" / "course" / "fixture_course" / "90_toy"
SECRET = b"a secret of this test, 32 bytes!"


@dataclass
class Broken:
    """A copy of the scaffold."""

    folder: Path
    cache: Path

    def change(self, path: str, old: str, new: str) -> None:
        """Replace a text that occurs in a file."""
        file = self.folder / path
        text = file.read_text("utf-8")
        assert old in text
        file.write_text(text.replace(old, new), "utf-8")

    def add(self, path: str, text: str) -> None:
        """Write another file."""
        (self.folder / path).parent.mkdir(exist_ok=True)
        (self.folder / path).write_text(text, "utf-8")

    @property
    def build(self) -> AssignmentBuild:
        """A fresh one."""
        return build_of(self.folder, cache=self.cache)

    def says(self, rule: str) -> list[str]:
        """What one rule has to say."""
        return list({**READING, **RUNNING}[rule](self.build))

    def broken_rules(self) -> set[str]:
        """Names of the rules that the build would report."""
        return {each.rule for each in findings(self.build)}
