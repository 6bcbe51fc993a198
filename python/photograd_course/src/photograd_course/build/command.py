"""`photograd course build`, from its options to its output."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from ..cli.failures import complain
from ..cli.output import emit, note
from ..cli.progress import Progress
from ..errors import IoError, message
from .assignment_build import AssignmentBuild
from .course_file import NAME, course_findings, plan_without, read_course
from .course_files import build_of
from .hint_table import public_hints, write_hints
from .kits import match_folder, no_sources, source_folders, source_root
from .products import make_products, publishable, write_tree
from .public import GLOSSARY
from .rules import Finding, findings, reading_findings, seed_findings
from .secret import course_secret, secret_beside


@dataclass(frozen=True)
class Request:
    """The command's options; see `photograd course build --help`."""

    numbers: Sequence[str] = ()
    out: Path | None = None
    answers: bool = True
    secret_file: Path | None = None
    update_hints: bool = False
    wheels: Path | None = None
    as_json: bool = False


def build_command(request: Request) -> bool:
    """Build what was asked for; whether every rule is kept. Nothing is written where one is not.

    Raises:
        IoError: this is no checkout, or a file cannot be read or written.
        RangeError: there is no such assignment.
        SceneError: the secret is too short.
    """
    root, folders = chosen_folders(request.numbers)
    found = plan_findings(root)
    if not request.answers:
        out = request.out or root.parent / "build" / "course-public"
        written = _publish(root, folders, out, found)
        return _say(request, found, {"out": out, "assignments": written})
    out = request.out or root.parent / "build" / "course"
    secret = course_secret(request.secret_file, [secret_beside(out)])
    note(secret.explained())
    trees = {}
    for name, folder in folders.items():
        if request.update_hints:
            write_hints(folder, public_hints(build_of(folder, root=root, bar=bar)))
        judged = build_of(folder, root=root, bar=bar)
        build = replace(judged, secret=secret.value, public_from=judged)
        bad = findings(judged) or seed_findings(build)
        if not bad:
            trees[name] = make_products(build, read_wheels(request.wheels)).files()
        found += bad
    if not found:
        for name, files in trees.items():
            write_tree(out / name, files)
    written = [] if found else list(trees)
    return _say(request, found, {"out": out, "secret": secret.place, "assignments": written})


def chosen_folders(numbers: Sequence[str]) -> tuple[Path, dict[str, Path]]:
    """The folder of assignments, and those that are meant; all of them if none is named.

    Raises:
        IoError: there are no sources here.
        RangeError: there is no such assignment.
    """
    root, folders = source_root(), source_folders()
    if root is None or not folders:
        raise no_sources("course build", "assignments")
    names = [match_folder(number, list(folders)) for number in numbers] or list(folders)
    return root, {name: folders[name].resolve() for name in names}


def plan_findings(root: Path) -> list[Finding]:
    """What is wrong with the plan of the course, where there is one."""
    if not (root / NAME).exists():
        return []
    return [Finding("plan", NAME, text) for text in course_findings(read_course(root))]


def read_wheels(folder: Path | None) -> dict[str, bytes]:
    """Wheels to put into the Gradescope zip.

    Raises:
        IoError: the folder holds none.
    """
    if folder is None:
        return {}
    found = {path.name: path.read_bytes() for path in sorted(folder.glob("*.whl"))}
    if not found:
        raise IoError(message("course build", "--wheels", "a folder with wheels", str(folder)))
    return found


@contextmanager
def bar(title: str, total: int) -> Iterator[Callable[[int], None]]:
    """A progress bar for `AssignmentBuild`."""
    with Progress(title, total) as progress:
        yield progress.update


def _publish(root: Path, folders: dict[str, Path], out: Path, found: list[Finding]) -> list[str]:
    builds: list[AssignmentBuild] = [build_of(folder, root=root) for folder in folders.values()]
    for build in builds:
        found += reading_findings(build)
    if found:
        return []
    files: dict[str, bytes] = {}
    if (root / NAME).exists():
        files[NAME] = plan_without(root, folders)
    if (root / GLOSSARY).exists():
        files[GLOSSARY] = (root / GLOSSARY).read_bytes()
    for name, folder in folders.items():
        files.update({f"{name}/{path}": data for path, data in publishable(folder).items()})
    write_tree(out / "assignments", files)
    return list(folders)


def _say(request: Request, found: Sequence[Finding], result: dict[str, object]) -> bool:
    for each in found:
        complain(str(each))
    if found:
        note(f"{len(found)} findings: nothing was written", style="red")
    emit({"ok": not found, **result, "findings": len(found)}, as_json=request.as_json)
    sys.stdout.flush()
    return not found
