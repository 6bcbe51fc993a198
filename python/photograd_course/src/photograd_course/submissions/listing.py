"""Choose the files of a submission from a list of names, whatever else stands in that list."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from ..assignment.manifest import Manifest
from ..printable import printable
from .submission import Refused, Submission, finish, refused, size_limit, wanted_names

MOST_ENTRIES = 5000
DEEPEST = 3  # folders around a submission that are looked through
NOISE = {"__macosx", "__pycache__", ".git", ".svn", ".hg", ".ds_store", ".venv", "venv", ".idea"}
NOISE |= {"thumbs.db", "desktop.ini", ".ipynb_checkpoints", ".vscode", ".pytest_cache"}


@dataclass(frozen=True)
class Entry:
    """One name in an archive or a folder.

    Attributes:
        name: with "/" between folders, none at the end.
        kind: "file", "folder", or what else it is: "link", "device", "encrypted".
        size: bytes, as declared.
        read: the content, at most so many bytes.
        below: of a folder in a list of one level, everything below it, names from it on.
    """

    name: str
    kind: str
    size: int
    read: Callable[[int], bytes]
    below: Callable[[], list[Entry]] | None = None


def choose(manifest: Manifest, entries: Sequence[Entry]) -> Submission:
    """Take the files on the assignment's list, from the top or from a folder around everything.

    Never raises for what a submission holds; the result's `problem` says what is wrong.

    Args:
        manifest: of the assignment.
        entries: all names of the submission.
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
    keys = {key_of(name) for name in wanted}
    if any(key_of(last_of(entry.name)) == key_of(wanted[0]) for entry in entries):
        keys = {key_of(wanted[0])}  # the graded module says where, the rest lies beside it
    top = ""
    for _ in range(DEEPEST):
        below = [entry.name[len(top) :] for entry in entries if entry.name.startswith(top)]
        if any("/" not in name and key_of(name) in keys for name in below):
            return top
        folders = sorted({name.split("/")[0] for name in below if "/" in name})
        if len(folders) > 1:
            having = {
                name.split("/")[0] for name in below if key_of(name.partition("/")[2]) in keys
            }
            deeper = {name.split("/")[0] for name in below if key_of(last_of(name)) in keys}
            folders = sorted(having or deeper)
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
    wanted = {key_of(name): name for name in wanted_names(manifest)}
    found: dict[str, Entry] = {}
    for entry in entries:
        inner = entry.name[len(top) :] if entry.name.startswith(top) else ""
        name = wanted.get(key_of(inner))
        if name is None:
            if entry.kind != "folder":
                ignored.append(f"{entry.name}: {_why_left(entry.name, wanted, top)}")
            continue
        if name in found:
            how = "twice" if found[name].name == entry.name else f"also as {inner}"
            raise Refused(f"{name} is there {how}: keep one")
        found[name] = entry
    return {name: _content(name, top, entry) for name, entry in found.items()}


def _why_left(name: str, wanted: Mapping[str, str], top: str) -> str:
    if key_of(last_of(name)) in wanted:
        where = f"beside {next(iter(wanted.values()))}" if not top else f"in {top}"
        return f"lies elsewhere: move it, files are taken {where} only"
    return "not a file of this assignment"


def _content(name: str, top: str, entry: Entry) -> bytes:
    if entry.name != top + name:
        raise Refused(f"expected a file {name}, found {entry.name[len(top) :]}: rename it")
    if entry.kind == "encrypted file":
        raise Refused(f"{name} is encrypted: hand in a zip without a password")
    if entry.kind != "file":
        raise Refused(f"{name} is a {entry.kind}, not a plain file")
    limit = size_limit(name)
    data = b"" if entry.size > limit else entry.read(limit + 1)
    if max(entry.size, len(data)) > limit:
        raise Refused(f"{name} is longer than the {limit >> 10} KB that are allowed")
    return data


def last_of(name: str) -> str:
    """A name without the folders before it."""
    return name.rpartition("/")[2]


def key_of(name: str) -> str:
    """Equal for names that some file system takes for the same."""
    return unicodedata.normalize("NFKC", name).casefold()
