"""The files around an assignment: its neighbors, the wheels, the place for results."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from .assignment_build import AssignmentBuild, Bar, no_bar
from .judging import RULES_SECRET
from .kits import PACKAGE, source_folders
from .public import wheel_kits

TEXTS = (".py", ".md", ".toml", ".json", ".ipynb")


def build_of(
    folder: Path,
    *,
    secret: bytes = RULES_SECRET,
    root: Path | None = None,
    cache: Path | None = None,
    bar: Bar = no_bar,
) -> AssignmentBuild:
    """The build of one assignment, with its neighbors and both wheels to search for leaks.

    Args:
        folder: its source.
        secret: seeds of hidden checks.
        root: the folder of assignments, by default the parent.
        cache: where verdicts are kept, by default `default_cache`.
        bar: shows progress.
    """
    around = (root or folder.parent).resolve()
    neighbors = source_folders(around)
    haystacks = dict(wheel_texts())
    for name, path in neighbors.items():
        if name != folder.name:
            haystacks.update(_neighbor_texts(name, path))
    return AssignmentBuild(
        folder=folder.resolve(),
        secret=secret,
        cache=cache or default_cache(around),
        bar=bar,
        haystacks=haystacks,
        siblings=frozenset(name[:2] for name in neighbors),
    )


def default_cache(root: Path) -> Path:
    """Verdicts by content, in a folder that git ignores."""
    if root == PACKAGE.parents[3] / "assignments":
        return root.parent / "build" / "course-cache"
    return root / ".cache" / "course"


@lru_cache(maxsize=1)
def wheel_texts() -> dict[str, str]:
    """Python of the course's wheel and, in a checkout or where it is installed, of the core's."""
    found = _python_of(PACKAGE, "wheel/photograd_course")
    core = PACKAGE.parents[2] / "photograd"
    if core.is_dir():
        found.update(_python_of(core, "wheel/photograd"))
    return found


def _python_of(folder: Path, name: str) -> dict[str, str]:
    return {
        f"{name}/{path.relative_to(folder).as_posix()}": path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*.py"))
        if "kits" not in path.relative_to(folder).parts
    }


def _neighbor_texts(name: str, folder: Path) -> dict[str, str]:
    """What the wheel holds of another assignment; nothing while that one is not readable."""
    try:
        files = wheel_kits(folder)
    except (OSError, ValueError):
        return {}  # its own rules say why
    return {
        f"wheel/photograd_course/kits/{name}/{path}": data.decode("utf-8")
        for path, data in files.items()
        if path.endswith(TEXTS)
    }
