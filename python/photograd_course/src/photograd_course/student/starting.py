"""Lay out the kit of an assignment in a folder, with the student's own earlier modules."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..assignment.manifest import Manifest
from ..atomic_io import atomic_write
from ..errors import IoError, message
from .origins import Found, copies, functions_of, owner_of, text_of
from .record import Record
from .source_code import changed_code, unwritten


@dataclass(frozen=True)
class Taken:
    """One module of an earlier assignment, and where it was taken from.

    Attributes:
        module: its name.
        owner: the assignment whose graded module it is; None where no kit here has it.
        best: the copy that was taken; None where the kit's stub has to do.
        others: copies of it in other folders.
        stubs: the functions that are unwritten in what was laid out.
    """

    module: str
    owner: Manifest | None
    best: Found | None
    others: tuple[Found, ...]
    stubs: tuple[str, ...]


@dataclass(frozen=True)
class LaidOut:
    """What became of the files of a kit: written, or left as the student has them."""

    written: tuple[str, ...]
    edited: tuple[str, ...]


def with_own_modules(
    files: Mapping[str, bytes], manifest: Manifest, target: Path, manifests: Sequence[Manifest]
) -> tuple[dict[str, bytes], list[Taken]]:
    """A kit with the student's own earlier modules, where they lie in folders around the target.

    Args:
        files: of the kit; brought modules are stubs there.
        manifest: of the assignment.
        target: the folder in which the kit will lie.
        manifests: of all assignments, which say whose module it is.

    Returns:
        The files, and where each brought module comes from.

    Raises:
        IoError: a copy cannot be read.
    """
    found, taken = dict(files), []
    for name in manifest.brought:
        there = copies(name, target, manifests)
        best = there[0] if there else None
        if best is not None:
            found[f"{name}.py"] = best.content
        owner = owner_of(name, manifests)
        stubs = unwritten(text_of(found[f"{name}.py"]), functions_of(owner))
        taken.append(Taken(name, owner, best, tuple(there[1:]), tuple(stubs)))
    return found, taken


def taken_along(taken: Taken, number: str) -> str:
    """What `course start` says of a module: whence it comes, and what is not written there yet.

    Args:
        taken: the module.
        number: of the assignment that is started.
    """
    of = f" of assignment {taken.owner.id}" if taken.owner else ""
    update = f"'photograd course start {number} --update'"
    if taken.best is None:
        there = f"{taken.module}.py{of}: you have none in a folder beside this one"
        return f"{there}, so the kit's was laid out, with nothing written; when you have: {update}"
    said = f"Taken along: your {taken.best.path}"
    origin = next((each for each in taken.others if each.is_origin), None)
    if not taken.best.is_origin and origin is not None:
        said += f" (in {origin.path} {is_unwritten(origin.unwritten)})"
    elif not taken.best.is_origin:
        said += f" (a copy: there is no folder{of} beside this one)"
    if not taken.best.is_python:
        said += "; it cannot be read as Python"
    if taken.stubs:
        said += f"; {is_unwritten(taken.stubs)} there yet: when you have finished it, {update}"
    differing = [
        f"{each.path} differs in {', '.join(differs)}"
        for each in taken.others
        if not each.unwritten and (differs := changed_code(taken.best.source, each.source))
    ]
    return f"{said}. Another copy, {differing[0]}: is it the better one?" if differing else said


def is_unwritten(names: Sequence[str]) -> str:
    """Such as "gltf and ggx_pdf are not written".

    Args:
        names: of functions.
    """
    last = " and ".join(names) if len(names) < 3 else ", ".join(names)
    return f"{last} {'is' if len(names) == 1 else 'are'} not written"


def lay_out(
    files: Mapping[str, bytes], target: Path, module: str | None = None, brought: Sequence[str] = ()
) -> LaidOut:
    """Write those files of a kit that are not there; none is ever replaced.

    So a kit that was laid out in part can be completed, whatever has been edited since.

    Args:
        files: relative path to content.
        target: the folder, made if need be.
        module: name of the graded module; a folder that holds it is one of this assignment.
        brought: names of modules that were taken along.

    Raises:
        IoError: the folder holds something else, or all of the kit and work on it; a file cannot
            be written.
    """
    there = sorted(name for name in files if (target / name).exists())
    edited = tuple(name for name in there if not _is_equal(target / name, files[name]))
    missing = [name for name in files if name not in there]
    graded = f"{module}.py"
    if edited and (graded not in there or not missing):
        remedy = "nothing was written; give another folder, or go on with the work that is there"
        if brought:
            remedy += "; --update brings files of earlier assignments up to date"
        count = len(edited) - 1
        found = f"{edited[0]} and {count} more" if count else edited[0]
        raise IoError(message("start", str(target), "a folder without the kit", found, remedy))
    _make_folder(target)
    texts = {name: text_of(files[f"{name}.py"]) for name in brought if f"{name}.py" in missing}
    if texts:
        Record(target).note_taken(texts)
    # The graded module comes first: it makes this the assignment's folder, if all else is cut off.
    written = sorted(missing, key=lambda name: (name != graded, name))
    for name in written:
        _make_folder((target / name).parent)
        atomic_write(target / name, files[name])
    return LaidOut(tuple(written), edited)


def _is_equal(path: Path, content: bytes) -> bool:
    """Whether a file is as the kit has it; line ends do not count, which editors change."""
    try:
        return path.read_bytes().replace(b"\r\n", b"\n") == content.replace(b"\r\n", b"\n")
    except OSError:  # a folder of this name, or a file that may not be read
        return False


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message("start", str(folder), "a folder, or a place for one", got)) from error
