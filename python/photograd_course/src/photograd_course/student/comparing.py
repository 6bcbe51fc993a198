"""How a folder's copy of an earlier module differs from the one in the folder of its origin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..assignment.manifest import Manifest
from .folder import WorkFolder
from .kept import read_file
from .origins import Found, copies, functions_of, owner_of, text_of
from .record import Record
from .source_code import changed_code, unwritten
from .starting import is_unwritten


@dataclass(frozen=True)
class Difference:
    """One copy beside its origin.

    Attributes:
        module: its name.
        owner: the assignment that owns it.
        origin: the file to compare with.
        unwritten: functions that are stubs in the copy.
        code: the functions whose code differs.
        here, there: those that have changed here, or there, since the module was taken along;
            None where that is not known.
    """

    module: str
    owner: Manifest | None
    origin: Found
    unwritten: tuple[str, ...]
    code: tuple[str, ...]
    here: tuple[str, ...] | None
    there: tuple[str, ...] | None

    @property
    def copy_is_newer(self) -> bool:
        """Whether the copy has what the origin lacks, and nothing the other way round."""
        missing_here = [name for name in self.unwritten if name not in self.origin.unwritten]
        missing_there = [name for name in self.origin.unwritten if name not in self.unwritten]
        if missing_here or missing_there:
            return not missing_here
        return bool(self.here) and self.there == ()


def difference(
    work: WorkFolder, module: str, manifests: Sequence[Manifest], record: Record
) -> Difference | None:
    """How the copy in a work folder differs; None where there is nothing to compare, or no code.

    Args:
        work: the folder.
        module: one that the assignment brings.
        manifests: of all assignments.
        record: of the folder.

    Raises:
        IoError: a copy cannot be read.
    """
    path = work.path / f"{module}.py"
    origins = [each for each in copies(module, work.path, manifests) if each.is_origin]
    if not origins or not path.exists():
        return None
    owner, origin = owner_of(module, manifests), origins[0]
    own = text_of(read_file(path))
    code = tuple(changed_code(own, origin.source))
    if not code:
        return None
    taken = record.taken(module)
    here = there = None
    if taken is not None:
        here = tuple(changed_code(taken, own))
        there = tuple(changed_code(taken, origin.source))
    missing = tuple(unwritten(own, functions_of(owner)))
    return Difference(module, owner, origin, missing, code, here, there)


def differences(work: WorkFolder, manifests: Sequence[Manifest]) -> list[Difference]:
    """Those of all modules that the assignment brings.

    Args:
        work: the student's folder.
        manifests: of all assignments.
    """
    record = Record(work.path)
    found = (difference(work, name, manifests, record) for name in work.manifest.brought)
    return [each for each in found if each is not None]


def said_of_difference(found: Difference, number: str) -> str:
    """One line: in what the two differ, which one is newer if that is known, and what to do.

    Args:
        found: the difference.
        number: of the assignment in whose folder the copy lies.
    """
    functions = ", ".join(found.code)
    said = [f"{found.module}.py here differs from {found.origin.path} in {functions}"]
    if found.unwritten:
        said.append(f"here {is_unwritten(found.unwritten)}")
    if found.origin.unwritten:
        said.append(f"there {is_unwritten(found.origin.unwritten)}")
    if not found.origin.is_python:
        said.append("that one cannot be read as Python")
    if found.unwritten == found.origin.unwritten:  # else that tells
        said.append(_which_is_newer(found))
    return f"{'; '.join(said)}. {_step(found, number)}"


def _which_is_newer(found: Difference) -> str:
    if found.here is None or found.there is None:
        return "which is newer cannot be told from them"
    here, there = ", ".join(found.here), ", ".join(found.there)
    if here and there:
        return f"since it was taken along, you have changed {here} here and {there} there"
    where = f"{here} here" if here else f"{there} there"
    return f"since it was taken along, you have changed {where}"


def _step(found: Difference, number: str) -> str:
    if found.copy_is_newer:
        owner = f" of {found.owner.id}" if found.owner else ""
        return f"The one here is used; the folder{owner} has the older one"
    command = f"photograd course start {number} --update"
    return f"To take that one: '{command}' (the file here is kept beside it)"
