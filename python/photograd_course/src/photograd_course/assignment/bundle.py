"""All that judging a submission takes: manifest, checks, questions, the solution, known mistakes.

A *bundle* holds everything and stays with instructors. A *public bundle* is what a student's kit
carries: public checks, questions without keys, no solution.
"""

from __future__ import annotations

import hashlib
import hmac
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

from ..grading.check import Check
from ..grading.remote import Hand
from ..grading.runner import Setting
from .brought import brought_sources
from .checks import load_checks
from .load import load_beside, load_module
from .manifest import Manifest, read_manifest
from .questions import Question, read_questions

PUBLIC_SECRET = b"public"


@dataclass(frozen=True)
class Bundle:
    """One assignment, ready to judge submissions.

    Attributes:
        manifest, checks, questions: of the assignment.
        secret: seeds of hidden checks come from it; public checks have seeds of their own.
        reference: the solution as a module; None in a public bundle.
        solution: its text; empty in a public bundle.
        keys: `answers.py` as a module, with a function for each generated question; or None.
        adapters: text of `adapters.py`, which runs beside the submission; or None.
        hints: the table of known mistakes.
        closed: nothing can be submitted any more, so that reports answer all questions.
        brought: earlier modules that the solution builds upon, by name; empty in a public bundle.
    """

    manifest: Manifest
    checks: tuple[Check, ...]
    questions: tuple[Question, ...]
    secret: bytes = PUBLIC_SECRET
    reference: ModuleType | None = None
    solution: str = ""
    keys: ModuleType | None = None
    adapters: str | None = None
    hints: Mapping[str, str] = field(default_factory=dict)
    brought: Mapping[str, str] = field(default_factory=dict)
    closed: bool = False

    @property
    def is_public(self) -> bool:
        """Whether this is a student's bundle."""
        return self.reference is None

    def setting(self, check: Check) -> Setting:
        """What the runner needs to know for one check."""
        secret = PUBLIC_SECRET if check.visibility == "public" else self.secret
        digest = hmac.new(secret, self.manifest.id.encode(), hashlib.sha256).digest()
        seed = tuple(int.from_bytes(digest[k : k + 4], "big") for k in (0, 4, 8, 12))
        # A public check runs the same for students and grader, seeds and known mistakes alike.
        salt = PUBLIC_SECRET.hex() if check.visibility == "public" else self.secret.hex()
        return Setting(self.manifest.module, seed, self.reference, self.hints, salt)

    def hand(self, files: Mapping[str, bytes]) -> Hand:
        """What a worker loads of a submission.

        Args:
            files: its files by name; the graded module must be among them.

        Raises:
            UnicodeDecodeError: the module is not UTF-8.
        """
        # A brought module that was forgotten has no functions.
        own = (*self.manifest.brought, self.manifest.module)
        sources = {name: files.get(f"{name}.py", b"").decode("utf-8") for name in own}
        if self.adapters is not None:
            sources["adapters"] = self.adapters
        return Hand(sources, own, self.manifest.imports)

    def solution_files(self, text: str) -> dict[str, bytes]:
        """A trusted text of the graded module as a submission, with the solutions it builds on."""
        files = {f"{name}.py": source.encode() for name, source in self.brought.items()}
        return {**files, f"{self.manifest.module}.py": text.encode()}


def read_folder(folder: Path, *, secret: bytes = PUBLIC_SECRET) -> Bundle:
    """The bundle of an assignment's source folder, or of an unpacked public one.

    In a source folder the graded module is the solution; a public folder has none beside its
    `checks/`.
    """
    manifest = read_manifest(folder)
    module = folder / f"{manifest.module}.py"
    reference, solution, brought = None, "", {}
    if module.exists():
        brought = brought_sources(folder, manifest)
        solution = module.read_text(encoding="utf-8")
        reference = load_beside(manifest.module, solution, brought)
    keys = folder / "answers.py"
    adapters, hints = folder / "adapters.py", folder / "hints.json"
    return Bundle(
        manifest=manifest,
        checks=tuple(load_checks(manifest)),
        questions=read_questions(folder),
        secret=secret,
        reference=reference,
        solution=solution,
        keys=load_module("answers", keys.read_text(encoding="utf-8")) if keys.exists() else None,
        adapters=adapters.read_text(encoding="utf-8") if adapters.exists() else None,
        hints=json.loads(hints.read_text(encoding="utf-8")) if hints.exists() else {},
        brought=brought,
    )
