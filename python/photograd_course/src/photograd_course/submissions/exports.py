"""Find the submissions in a folder or archive, as learning systems export them, or in a table.

Each entry of the folder is taken for exactly one thing: a submission or a part of one, or a file
that is none, which is named with the reason. None is passed over.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..assignment.manifest import Manifest
from ..errors import IoError, message
from .containers import (
    file_entry,
    first_level,
    is_archive,
    is_unread_archive,
    list_folder,
    open_archive,
    zip_entries,
)
from .gradescope_names import METADATA, Submitted, read_metadata
from .grouping import Claim, grouped, stem_of
from .intake import as_wanted
from .layouts import COMPANION, Label, read_name
from .listing import NOISE, Entry, key_of, last_of
from .source import Person, Source
from .submission import Refused
from .table import read_table

CODE = (".py", ".pyw", ".ipynb", ".py.txt")
CONVERTED = (".docx", ".doc", ".odt", ".rtf", ".pdf", ".gdoc", ".pages")  # out of code
_DEEPEST_WRAPPING = 3


@dataclass(frozen=True)
class Ignored:
    """An entry that is no submission, and why; `is_noise`: an operating system made it."""

    name: str
    reason: str
    is_noise: bool = False


@dataclass(frozen=True)
class Export:
    """All that lies at a path: submissions by student, and what is none.

    Attributes:
        sources: the submissions.
        ignored: entries that are none.
        is_batch: this is a folder, archive or table of submissions, and not one of them.
    """

    sources: tuple[Source, ...]
    ignored: tuple[Ignored, ...] = ()
    is_batch: bool = True


def find_sources(manifest: Manifest, path: Path) -> list[Source]:
    """All submissions at ``path``, sorted by student; ``manifest`` as of `read_export`."""
    return list(read_export(manifest, path).sources)


def is_batch(manifest: Manifest, path: Path) -> bool:
    """Whether ``path`` is a table, folder or archive of submissions rather than one of them.

    Args:
        manifest: of the assignment.
        path: as of `read_export`.
    """
    return read_export(manifest, path).is_batch


def read_export(manifest: Manifest, path: Path) -> Export:
    """Submissions at ``path``, and what lies beside them.

    Args:
        manifest: of the assignment.
        path: one submission; a folder or zip of submissions; or a CSV table with the columns
            student and path, where paths are relative to the table.

    Raises:
        IoError: nothing is there, or it cannot be read.
        SceneError: the table lacks a column, or a student occurs twice.
    """
    if not path.exists():
        expected = "a submission, a folder or a CSV table"
        raise IoError(message("grade", str(path), expected, "nothing"))
    if path.suffix.lower() == ".csv":
        return Export(tuple(read_table(path)))
    one = Source(path.name if path.is_dir() else stem_of(path.name), path)
    try:
        entries = list_folder(path) if path.is_dir() else _inside(path)
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message("grade", str(path), "a readable folder", got)) from error
    if entries is None:
        return Export((one,), is_batch=False)
    entries = _unwrapped(manifest, entries)
    if not _is_several(manifest, entries, is_folder=path.is_dir()):
        return Export((one,), _beside(manifest, entries), is_batch=False)
    found = sort_entries(manifest, path, entries)
    if not found.sources:
        named = ", ".join(each.name for each in found.ignored[:4])
        got = f"nothing but {named}" if named else "an empty folder"
        raise IoError(message("grade", str(path), "submissions", got))
    return found


def sort_entries(manifest: Manifest, path: Path, entries: Sequence[Entry]) -> Export:
    """What each entry of one level is; together they are all of them, and none is two things.

    Args:
        manifest: of the assignment.
        path: of the folder or archive, for messages.
        entries: the first level of it.

    Raises:
        IoError: Gradescope's list of names cannot be read.
    """
    entries = [each for entry in entries for each in _expanded(manifest, entry)]
    names = next((each for each in entries if last_of(each.name) == METADATA), None)
    submitted = read_metadata(names)
    claims: list[Claim] = []
    ignored: list[Ignored] = []
    for entry in entries:
        label = read_name(manifest, last_of(entry.name))
        if reason := _noise(entry.name):
            ignored.append(Ignored(entry.name, reason, is_noise=True))
        elif reason := _no_submission(entry, label):
            ignored.append(Ignored(entry.name, reason))
        else:
            claims.append(Claim(entry, label))
    sources = [_named(source, submitted) for source in grouped(manifest, path, claims)]
    sources += _absent(path, submitted, {last_of(entry.name) for entry in entries})
    return Export(tuple(_distinct(sources)), tuple(ignored))


def _noise(name: str) -> str:
    name = last_of(name)
    if name.lower() in NOISE or name.startswith("._"):
        return "made by an operating system or a program"
    return ""


def _no_submission(entry: Entry, label: Label | None) -> str:
    """Why an entry is none; "" where it is one, or a part of one."""
    if last_of(entry.name) == METADATA:
        return "Gradescope's list of names, which was read"
    if last_of(entry.name).startswith("."):
        return "hidden: its name begins with a dot"
    if entry.kind == "misplaced":
        return "leads out of the archive"
    if label is not None:
        return f"a file of {label.system}'s own" if label.role == COMPANION else ""
    lower = entry.name.lower()
    is_one = entry.kind != "file" or is_archive(lower) or is_unread_archive(lower)
    if is_one or lower.endswith((*CODE, *CONVERTED)):
        return ""
    return "neither a folder nor an archive, code or a document"


def _named(source: Source, submitted: dict[str, Submitted]) -> Source:
    """With the names of a Gradescope export, where it has them."""
    entry = last_of(source.entries[0]) if len(source.entries) == 1 else ""
    known = submitted.get(entry) or submitted.get(entry.rpartition(".")[0])
    if known is None:
        return source
    student = " & ".join(each.name for each in known.people) or source.student
    people = known.people or source.people
    return replace(source, student=student, people=people, is_late=known.is_late)


def _absent(path: Path, submitted: dict[str, Submitted], listed: set[str]) -> list[Source]:
    """Submissions that Gradescope's list names, and the export lacks."""
    stems = {name.rpartition(".")[0] for name in listed}
    return [
        Source(
            " & ".join(each.name for each in known.people) or folder,
            path / folder,
            people=known.people or (Person(folder),),
            is_late=known.is_late,
            problem=f"{METADATA} names {folder}, which is not in the export: export it again",
        )
        for folder, known in submitted.items()
        if folder not in listed and folder not in stems and known.people
    ]


def _distinct(sources: Sequence[Source]) -> list[Source]:
    """Students of the same name told apart by what their submissions are called."""
    names = Counter(key_of(source.student) for source in sources)
    told: dict[str, Source] = {}
    for source in sources:
        name = source.student
        if names[key_of(name)] > 1:
            name = f"{name} ({source.path.name})"
        while name in told:  # the same name twice, as archives may have it
            name += "*"
        told[name] = replace(source, student=name)
    return sorted(told.values(), key=lambda source: source.student)


def _inside(path: Path) -> list[Entry] | None:
    """The first level of an archive; None for any other file, and for one that cannot be read."""
    if not path.is_file() or not is_archive(path.name):
        return None
    try:
        if path.suffix.lower() == ".zip":  # of a whole class, read entry by entry from the disk
            return first_level(zip_entries(path.name, path))
        return first_level(open_archive(file_entry(path.name, path)))
    except Refused:  # said in its row
        return None


def _unwrapped(manifest: Manifest, entries: list[Entry]) -> list[Entry]:
    """The entries of a learning system's export itself, where it lies in a folder of its own."""
    for _ in range(_DEEPEST_WRAPPING):
        visible = [entry for entry in entries if not _noise(entry.name)]
        if len(visible) != 1 or visible[0].below is None or read_name(manifest, visible[0].name):
            break
        inner = first_level(visible[0].below())
        if not _systems(manifest, inner):
            break
        noise = [entry for entry in entries if entry is not visible[0]]
        start = f"{visible[0].name}/"
        entries = [*noise, *(replace(each, name=start + each.name) for each in inner)]
    return entries


def _expanded(manifest: Manifest, entry: Entry) -> list[Entry]:
    """The entry; or, of a folder of files that bear names of students, those.

    Moodle lays files that a student had in a folder into a folder beside the others.
    """
    if entry.below is None or read_name(manifest, last_of(entry.name)) or _noise(entry.name):
        return [entry]
    inner = [each for each in first_level(entry.below()) if not _noise(each.name)]
    if not inner or not all(_systems(manifest, [each]) for each in inner):
        return [entry]
    return [replace(each, name=f"{entry.name}/{each.name}") for each in inner]


def _systems(manifest: Manifest, entries: Sequence[Entry]) -> set[str]:
    """The learning systems in whose layouts students are named here."""
    if any(last_of(entry.name) == METADATA for entry in entries):
        return {"Gradescope"}
    labels = [read_name(manifest, last_of(entry.name)) for entry in entries]
    return {label.system for label in labels if label and label.key} - {"Classroom"}


def _is_several(manifest: Manifest, entries: Sequence[Entry], *, is_folder: bool) -> bool:
    """Whether a level holds submissions, and not the files of one."""
    systems = _systems(manifest, entries)
    module = key_of(f"{manifest.module}.py")
    if any(key_of(last_of(entry.name)) == module for entry in entries):
        return is_folder and bool(systems)
    if is_folder or systems:
        return True
    archives = [entry for entry in entries if is_archive(entry.name)]
    holding = [
        entry
        for entry in entries
        if entry.below is not None
        and any(key_of(last_of(each.name)) == module for each in entry.below())
    ]
    return len(archives) + len(holding) > 1


def _beside(manifest: Manifest, entries: Sequence[Entry]) -> tuple[Ignored, ...]:
    """Copies of files beside one submission, which may be another: downloads that were numbered."""
    reason = f"lies beside {manifest.module}.py: if it is of another student, give each a folder"
    return tuple(
        Ignored(entry.name, reason)
        for entry in entries
        if as_wanted(manifest, entry.name) != entry.name
    )
