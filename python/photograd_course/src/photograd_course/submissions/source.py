"""One student's submission before it is looked into: whose it is, and where its parts lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..assignment.manifest import Manifest
from .intake import take, take_entries
from .listing import Entry
from .submission import Submission, refused


@dataclass(frozen=True)
class Person:
    """Who a gradebook knows: a student, or one of a group; "" for what is not known."""

    name: str = ""
    id: str = ""
    email: str = ""


@dataclass(frozen=True)
class Part:
    """A file or folder of a submission, under the name that its student gave it.

    The name of a folder is "" where it is the submission, and not a folder in it.
    """

    name: str
    entry: Entry

    def entries(self) -> list[Entry]:
        """The part itself, and all that lies below it."""
        if self.entry.below is None:
            return [replace(self.entry, name=self.name)]
        start = f"{self.name}/" if self.name else ""
        own = [replace(self.entry, name=self.name, below=None)] if self.name else []
        return own + [replace(each, name=start + each.name) for each in self.entry.below()]


@dataclass(frozen=True)
class Source:
    """Where one student's submission lies: at a path, or in several parts.

    Attributes:
        student: no other submission of the batch has this name; it stays the same next time.
        path: where, for one that is a file or folder by itself.
        parts: of one that was put together from the entries of an export.
        people: whose it is, as the export names them; several for a group.
        is_late: the export says so.
        entries: names in the export that were taken for it, those of other attempts included.
        notes: what its student should know, such as which attempt counts.
        problem: why it cannot be judged, where that is known without looking at it.
    """

    student: str
    path: Path
    parts: Sequence[Part] = ()
    people: tuple[Person, ...] = ()
    is_late: bool = False
    entries: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    problem: str = ""

    @property
    def name(self) -> str:
        """As a gradebook may know it."""
        return " & ".join(each.name for each in self.people if each.name) or self.student

    @property
    def id(self) -> str:
        """The number or login that the learning system has for them."""
        return "; ".join(each.id for each in self.people if each.id)

    @property
    def email(self) -> str:
        """Their addresses, where the export has them."""
        return "; ".join(each.email for each in self.people if each.email)

    def take(self, manifest: Manifest) -> Submission:
        """Take it into memory; never raises for what it holds.

        Args:
            manifest: of the assignment.
        """
        if self.problem:
            taken = refused(self.problem)
        elif self.parts:
            taken = self._taken_parts(manifest)
        elif not self.path.exists() and not self.path.is_symlink():
            taken = refused(f"there is nothing at {self.path.name}")
        else:
            taken = take(manifest, self.path)
        return replace(taken, warnings=(*self.notes, *taken.warnings)) if self.notes else taken

    def _taken_parts(self, manifest: Manifest) -> Submission:
        try:
            entries = [entry for part in self.parts for entry in part.entries()]
        except Exception as error:  # of reading a folder or an archive that changed meanwhile
            return refused(f"the submission cannot be read: {type(error).__name__}")
        return take_entries(manifest, entries)
