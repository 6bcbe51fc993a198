"""Make an assignment's products, or the whole course as it may be published."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import IoError, message
from .assignment_build import AssignmentBuild
from .gradescope import EXECUTABLE, gradescope_zip
from .hint_table import hints_of
from .matrix import matrix_files
from .page.page import handout_page, with_figures
from .public import PAGE, glossary, kit_files, public_files
from .seal import bundle_files, seal_bundle

BUILT = ".built"  # marks what `photograd course build` has written, and may replace
BUILT_TEXT = "Written by photograd course build, which replaces this folder as a whole.\n"


@dataclass(frozen=True)
class Products:
    """The five products of one assignment, files by path.

    Attributes:
        kit: the student's folder.
        public: the public checks, with what running them takes.
        hidden: the sealed bundle, a zip.
        solution: module, worked handout, figures, mutants, alternatives, questions with keys, and
            which check kills which mutant.
        gradescope: the autograder's zip.
    """

    kit: Mapping[str, bytes]
    public: Mapping[str, bytes]
    hidden: bytes
    solution: Mapping[str, bytes]
    gradescope: bytes

    def files(self) -> dict[str, bytes]:
        """All of them, by path in the output folder."""
        return {
            **{f"kit/{path}": data for path, data in self.kit.items()},
            **{f"public/{path}": data for path, data in self.public.items()},
            **{f"solution/{path}": data for path, data in self.solution.items()},
            "hidden.zip": self.hidden,
            "gradescope.zip": self.gradescope,
        }


def make_products(build: AssignmentBuild, wheels: Mapping[str, bytes] | None = None) -> Products:
    """The products of an assignment that keeps the rules.

    Args:
        build: with the course's secret, so that hints fit the hidden seeds.
        wheels: for the Gradescope zip.
    """
    hidden = sealed(build)
    number, secret = build.manifest.id, build.secret
    return Products(
        kit=complete_kit(build.folder),
        public=public_files(build.folder),
        hidden=hidden,
        solution=solution_files(build),
        gradescope=gradescope_zip(number, hidden, secret, wheels),
    )


def complete_kit(folder: Path) -> dict[str, bytes]:
    """The student's folder with the handout as a page that holds its figures.

    Args:
        folder: an assignment's source folder.
    """
    files = kit_files(folder)
    if "README.md" in files:
        page = handout_page(files["README.md"].decode("utf-8"), glossary(folder.parent))
        files[PAGE] = with_figures(page, files).encode("utf-8")
    return dict(sorted(files.items()))


def sealed(build: AssignmentBuild) -> bytes:
    """The sealed bundle, with hints for all checks."""
    mutants, verdicts = build.mutants, build.mutant_verdicts
    hints = hints_of(mutants, verdicts, build.checks, build.secret)
    return seal_bundle(bundle_files(build.folder, hints), build.secret)


def solution_files(build: AssignmentBuild) -> dict[str, bytes]:
    """What instructors read: the source folder without what tools left there, and `kills.png`."""
    found = matrix_files(build)
    for path in sorted(build.folder.rglob("*")):
        inside = path.relative_to(build.folder)
        hidden = any(part.startswith((".", "__pycache__")) for part in inside.parts)
        if path.is_file() and not hidden:
            found[inside.as_posix()] = path.read_bytes()
    return found


def publishable(folder: Path) -> dict[str, bytes]:
    """A source folder as it may be published: stubs, no hidden checks, no keys, no mutants."""
    kit, public = kit_files(folder), public_files(folder)
    made = {"README.md", "answers.toml", "explore.ipynb"}  # students get them from the kit
    files = {path: data for path, data in kit.items() if path not in made}
    if "README.md" in kit:
        files["handout.md"] = kit["README.md"]
    return {**files, **public}


def write_tree(target: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a folder that holds nothing else afterwards.

    Only what an earlier build has written is replaced; anything else is refused.

    Args:
        target: the folder.
        files: path to content.

    Raises:
        IoError: the folder holds something else.
    """
    if (found := _foreign(target)) is not None:
        remedy = "nothing was written; remove it, or give another folder with --out"
        expected = "a new folder, or one that an earlier build has written"
        raise IoError(message("build", str(target), expected, f"one with {found}", remedy))
    fresh = target.with_name(f".{target.name}.new")
    shutil.rmtree(fresh, ignore_errors=True)
    for path, data in sorted(files.items()):
        place = fresh / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(data)
        if place.name in EXECUTABLE:
            place.chmod(0o755)
    (fresh / BUILT).write_text(BUILT_TEXT, encoding="utf-8")
    shutil.rmtree(target, ignore_errors=True)
    fresh.rename(target)


def _foreign(target: Path) -> str | None:
    """What lies in a folder that no build has written; None where a build may replace it."""
    if not target.exists() or (target / BUILT).is_file():
        return None
    if not target.is_dir():
        return "a file of this name"
    return next((path.name for path in sorted(target.iterdir())), None)
