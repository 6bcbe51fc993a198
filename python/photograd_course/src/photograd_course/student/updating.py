"""Bring a folder's copies of earlier modules up to date, without losing what stands in them."""

from __future__ import annotations

from collections.abc import Sequence

from ..assignment.manifest import Manifest
from ..atomic_io import atomic_write
from .comparing import difference
from .folder import WorkFolder
from .kept import keep_copy, read_file
from .origins import Found, copies, functions_of, owner_of, text_of
from .record import Record
from .source_code import changed_code, unwritten
from .starting import is_unwritten


def update_brought(work: WorkFolder, manifests: Sequence[Manifest]) -> list[str]:
    """Replace each copy by a better one, keep what it was beside it, and say so; a line each.

    A copy that has what the other lacks, or was changed here alone, stays.

    Args:
        work: the folder.
        manifests: of all assignments.

    Raises:
        IoError: a file cannot be read, or not be written.
    """
    record = Record(work.path)
    if not work.manifest.brought:
        return [f"{work.manifest.id} brings no file of an earlier assignment"]
    return [_update(work, name, manifests, record) for name in work.manifest.brought]


def _update(work: WorkFolder, module: str, manifests: Sequence[Manifest], record: Record) -> str:
    path, owner = work.path / f"{module}.py", owner_of(module, manifests)
    found = copies(module, work.path, manifests)
    if not found:
        number = f" of assignment {owner.id}" if owner else ""
        return f"{path.name}: no copy in a folder beside this one; put your file{number} here"
    best = found[0]
    if not path.exists():
        _write(work, module, best, record)
        return f"{path.name}: taken from {best.path}"
    own = read_file(path)
    if not changed_code(text_of(own), best.source):
        record.note_taken({module: text_of(own)})  # also where a run was cut off before that
        return f"{path.name}: the same code as {best.path}"
    here = unwritten(text_of(own), functions_of(owner))
    if len(here) < len(best.unwritten):
        return f"{path.name}: stays, for in {best.path} {is_unwritten(best.unwritten)}"
    if not best.is_origin and len(here) == len(best.unwritten):
        return f"{path.name}: stays; {best.path} differs, but is only another copy"
    found_difference = difference(work, module, manifests, record)
    if found_difference is not None and found_difference.copy_is_newer:
        what = ", ".join(found_difference.here or found_difference.code)
        return f"{path.name}: stays, for it has what {found_difference.origin.path} lacks: {what}"
    kept = None if _is_stub(here, functions_of(owner)) else keep_copy(path)
    _write(work, module, best, record)
    said = f"{path.name}: taken from {best.path}"
    if best.unwritten:
        said += f", where {is_unwritten(best.unwritten)} yet"
    return said if kept is None else f"{said}; what was here is kept as {kept.name}"


def _is_stub(missing: Sequence[str], expected: Sequence[str]) -> bool:
    """Whether nothing that the owner asks for is written: there is no work to keep."""
    return bool(expected) and set(expected) <= set(missing)


def _write(work: WorkFolder, module: str, best: Found, record: Record) -> None:
    # In this order: were it cut off between the two, the new file would pass for edited, no more.
    atomic_write(work.path / f"{module}.py", best.content)
    record.note_taken({module: best.source})
