"""Take a submission into memory from an archive, a folder or single files; nothing is unpacked."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ..assignment.manifest import Manifest
from ..printable import printable
from .containers import file_entry, is_archive, is_unread_archive, open_archive, walk_folder
from .listing import Entry, choose, key_of, last_of
from .submission import Refused, Submission, missing_module, refused, wanted_names

DEEPEST_ARCHIVE = 2  # an archive within an archive is looked into, one within that is not
DOCUMENTS = (".docx", ".doc", ".odt", ".rtf", ".pdf", ".gdoc", ".pages", ".txt", ".html", ".md")
_COPY = re.compile(r"(?:-\d{1,3}| ?\(\d{1,3}\))(?=\.[A-Za-z]+$)")


def take(manifest: Manifest, path: Path) -> Submission:
    """Whatever lies at ``path``: an archive, a folder or the graded module itself.

    Never raises for what a submission holds: the result's `problem` says what is wrong with it.
    The ``manifest`` names the files that are taken.
    """
    try:
        entry = file_entry(path.name, path)
        if entry.kind == "folder":
            return take_entries(manifest, walk_folder(path))
        if entry.kind != "file":
            return refused(f"{path.name} is no plain file")
        return take_entries(manifest, [entry])
    except OSError as error:
        return refused(f"{path.name} cannot be read: {error.strerror or error}")


def take_entries(manifest: Manifest, entries: Sequence[Entry]) -> Submission:
    """The submission among entries; where it is one archive, the submission in that.

    Never raises for what a submission holds.

    Args:
        manifest: of the assignment.
        entries: all that was handed in, names as the student gave them.
    """
    try:
        return _taken(manifest, entries, 0)
    except Refused as error:
        return refused(str(error))
    except OSError as error:
        return refused(f"the submission cannot be read: {error.strerror or error}")


def _taken(manifest: Manifest, entries: Sequence[Entry], depth: int) -> Submission:
    if _has_module(manifest, entries):
        return choose(manifest, entries)
    archives = [entry for entry in _own_files(entries) if is_archive(entry.name)]
    if len(archives) > 1:
        names = ", ".join(entry.name for entry in archives[:4])
        raise Refused(f"there are several archives ({names}) and no order: keep one")
    if archives and depth < DEEPEST_ARCHIVE:
        beside = [each for each in _own_files(entries) if each is not archives[0]]
        inner, left = _joined(manifest, open_archive(archives[0]), beside)
        taken = _taken(manifest, inner, depth + 1)
        return replace(taken, ignored=(*taken.ignored, *left))
    taken = choose(manifest, entries)
    if taken.problem == missing_module(manifest):
        taken = replace(taken, problem=_what_is_there(manifest, entries))
    return taken


def _joined(
    manifest: Manifest, inner: list[Entry], beside: Sequence[Entry]
) -> tuple[list[Entry], list[str]]:
    """What an archive holds, with files of the assignment that it lacks and that lie beside it."""
    module = key_of(f"{manifest.module}.py")
    tops = [each.name for each in inner if key_of(last_of(each.name)) == module]
    folder = tops[0].removesuffix(last_of(tops[0])) if len(tops) == 1 else ""
    there = {key_of(each.name) for each in inner}
    wanted = {key_of(name) for name in wanted_names(manifest)}
    added: list[Entry] = []
    left: list[str] = []
    for each in beside:
        if key_of(each.name) not in wanted:
            left.append(printable(f"{each.name}: not a file of this assignment", 160))
        elif key_of(folder + each.name) in there:
            left.append(f"{each.name}: lies beside an archive whose own counts")
        else:
            added.append(replace(each, name=folder + each.name))
    return [*inner, *added], left


def as_wanted(manifest: Manifest, name: str) -> str:
    """The name that a file had before a learning system or a browser put "-1" or " (1)" behind it.

    Only where that makes it a name of the assignment's, which its ``manifest`` lists.
    """
    plain = _COPY.sub("", name)
    return plain if plain in wanted_names(manifest) else name


def _has_module(manifest: Manifest, entries: Sequence[Entry]) -> bool:
    module = key_of(f"{manifest.module}.py")
    return any(key_of(last_of(entry.name)) == module for entry in entries)


def _own_files(entries: Sequence[Entry]) -> list[Entry]:
    """Files, without what operating systems add."""
    plain = [entry for entry in entries if "file" in entry.kind]
    return [
        each
        for each in plain
        if not any(part.startswith(("._", "__MACOSX")) for part in each.name.split("/"))
    ]


def _what_is_there(manifest: Manifest, entries: Sequence[Entry]) -> str:
    """Why a submission without the graded module cannot be judged, by what it holds instead."""
    module = f"{manifest.module}.py"
    missing = f"there is no {module} in the submission"
    files = _own_files(entries)
    if not files and not any(entry.kind in ("link", "device") for entry in entries):
        return f"{missing}, which is empty: hand in a file of this name"
    for entry in files:
        name = last_of(entry.name)
        lower = name.lower()
        if lower.endswith(".ipynb"):
            return f"{missing}: {name} is a notebook, hand in {module} itself"
        if is_unread_archive(name) or is_archive(name):
            return f"{missing}: {name} is an archive that is not read, hand in a zip of {module}"
        if lower.endswith((".py", ".pyw", ".py.txt")):
            return f"{missing}, but {name}: rename it to {module}"
        if lower.endswith(DOCUMENTS) and not lower.startswith("readme"):
            return f"{missing}: {name} is a document, hand in {module} itself, not converted"
    for entry in entries:
        if entry.kind in ("link", "device"):
            return f"{missing}: {entry.name} is a {entry.kind}, not a plain file or folder"
    return missing_module(manifest)
