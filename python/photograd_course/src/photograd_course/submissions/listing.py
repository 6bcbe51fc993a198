"""Choose the files of a submission from a list of names, whatever else stands in that list."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..assignment.manifest import Manifest
from ..printable import printable
from .submission import Refused, Submission, finish, refused, size_limit, wanted_names

MOST_ENTRIES = 5000
DEEPEST = 3  # folders around a submission that are looked through
NOISE = {"__macosx", "__pycache__", ".git", ".svn", ".hg", ".ds_store", ".venv", "venv", ".idea"}


@dataclass(frozen=True)
class Entry:
    """One name in an archive or a folder.

    Attributes:
        name: with "/" between folders, none at the end.
        kind: "file", "folder", or what else it is: "link", "device", "encrypted".
        size: bytes, as declared.
        read: the content, at most so many bytes.
    """

    name: str
    kind: str
    size: int
    read: Callable[[int], bytes]


def choose(manifest: Manifest, entries: Sequence[Entry]) -> Submission:
    """Take the files on the assignment's list, from the top or from a folder around everything.

    Never raises for what a submission holds; the result's `problem` says what is wrong.
    """
    ignored: list[str] = []
    try:
        usable = [entry for entry in entries if _usable(entry, ignored)]
        if len(usable) > MOST_ENTRIES:
            raise Refused(f"more than {MOST_ENTRIES} files: hand in those of the assignment only")
        top = _top(usable, wanted_names(manifest))
        raw = _take(manifest, usable, top, ignored)
    except Refused as error:
        return refused(str(error), ignored)
    return finish(manifest, raw, ignored)


def _usable(entry: Entry, ignored: list[str]) -> bool:
    parts = entry.name.split("/")
    if entry.name.startswith("/") or ":" in parts[0]:
        ignored.append(f"{entry.name}: an absolute name")
    elif ".." in parts:
        ignored.append(f"{entry.name}: leads out of the submission")
    elif "" in parts or "." in parts or printable(entry.name, 2000) != entry.name:
        ignored.append(f"{entry.name}: not a proper name")
    elif any(part.lower() in NOISE for part in parts):
        if entry.kind == "file" and len(parts) <= 2:
            ignored.append(f"{entry.name}: does not belong to a submission")
        elif entry.kind == "folder" and len(parts) == 1:
            ignored.append(f"{entry.name}/: does not belong to a submission")
    else:
        return True
    return False


def _top(entries: Sequence[Entry], wanted: Sequence[str]) -> str:
    """The folder that holds the submission, "" or with "/" at its end."""
    keys = {_key(name) for name in wanted}
    top = ""
    for _ in range(DEEPEST):
        below = [entry.name[len(top) :] for entry in entries if entry.name.startswith(top)]
        if any("/" not in name and _key(name) in keys for name in below):
            return top
        folders = sorted({name.split("/")[0] for name in below if "/" in name})
        if len(folders) > 1:
            having = [name.split("/")[0] for name in below if _key(name.partition("/")[2]) in keys]
            folders = sorted(set(having))
        if len(folders) > 1:
            raise Refused(
                f"{wanted[0]} lies in several folders ({', '.join(folders[:4])}): keep one"
            )
        if not folders:
            return top
        top += folders[0] + "/"
    return top


def _take(
    manifest: Manifest, entries: Sequence[Entry], top: str, ignored: list[str]
) -> dict[str, bytes]:
    wanted = {_key(name): name for name in wanted_names(manifest)}
    found: dict[str, Entry] = {}
    for entry in entries:
        inner = entry.name[len(top) :] if entry.name.startswith(top) else ""
        name = wanted.get(_key(inner))
        if name is None:
            if entry.kind != "folder":
                ignored.append(f"{entry.name}: not a file of this assignment")
            continue
        if name in found:
            how = "twice" if found[name].name == entry.name else f"also as {inner}"
            raise Refused(f"{name} is there {how}: keep one")
        found[name] = entry
    return {name: _content(name, top, entry) for name, entry in found.items()}


def _content(name: str, top: str, entry: Entry) -> bytes:
    if entry.name != top + name:
        raise Refused(f"expected a file {name}, found {entry.name[len(top) :]}: rename it")
    if entry.kind != "file":
        raise Refused(f"{name} is a {entry.kind}, not a plain file")
    limit = size_limit(name)
    data = b"" if entry.size > limit else entry.read(limit + 1)
    if max(entry.size, len(data)) > limit:
        raise Refused(f"{name} is longer than the {limit >> 10} KB that are allowed")
    return data


def _key(name: str) -> str:
    """Equal for names that some file system takes for the same."""
    return unicodedata.normalize("NFKC", name).casefold()
