"""One attack: its folder, what it may earn, and the bytes that a student would upload."""

from __future__ import annotations

import importlib.util
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from photograd_course.student.folder import LOCK_NAME
from photograd_course.student.predictions import digest

from course.attacks.archive import zip_of

HERE = Path(__file__).resolve().parent
ASSIGNMENT = HERE / "assignment" / "91_arena"
MODULE = "arena.py"


@dataclass(frozen=True)
class Attack:
    """A folder `NN_name/`.

    Attributes:
        folder: where it lies.
        number, title, tries: its own, and what is attempted.
        max_points: what it may earn of the checks that are run.
        budget_seconds: within which grading must end.
        checks: those of the assignment that it is about.
        control: the table [control] of attack.toml: how it shows that it works at all.
        runs: whether code of it runs in a worker, so that its token must be found there.
        note: what a maintainer should know, such as why it may earn points.
    """

    folder: Path
    number: int
    title: str
    tries: str
    max_points: float
    budget_seconds: float
    checks: tuple[str, ...]
    control: dict[str, Any]
    runs: bool = True
    note: str = ""

    @property
    def name(self) -> str:
        """Such as "02_walk_the_frames"."""
        return self.folder.name

    @property
    def token(self) -> str:
        """What a payload writes to standard error when it runs."""
        return f"token {self.number:02}"

    def variants(self) -> dict[str, bytes]:
        """Uploads by name; each a zip archive or a module; the same bytes every time."""
        script = self.folder / "make.py"
        if not script.exists():
            return {"": (self.folder / MODULE).read_bytes()}
        spec = importlib.util.spec_from_file_location(f"make_{self.number}", script)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        made: dict[str, bytes] = module.variants()
        return made

    def controlled(self) -> bytes:
        """The variant that the naive grader gets."""
        return self.variants()[self.control.get("variant", next(iter(self.variants())))]


def read_attacks() -> list[Attack]:
    """All of them, by number."""
    return [_read(path.parent) for path in sorted(HERE.glob("*/attack.toml"))]


def solution_upload() -> bytes:
    """What an honest and able student hands in."""
    made = {"91.p1": "a"}
    lock = {"assignment": "91", "answers": made, "locked_at": "", "sha256": digest("91", made)}
    answers = 'student = "innocent"\n[answers]\n"91.p1" = "a"\n"91.c1" = 1.0\n'
    module = (ASSIGNMENT / MODULE).read_bytes()
    return zip_of({MODULE: module, "answers.toml": answers, LOCK_NAME: json.dumps(lock)})


def _read(folder: Path) -> Attack:
    table = tomllib.loads((folder / "attack.toml").read_text(encoding="utf-8"))
    return Attack(folder=folder, **{**table, "checks": tuple(table["checks"])})
