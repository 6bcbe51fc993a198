"""What lies in a folder or an archive, as entries that are read within limits; never unpacked."""

from __future__ import annotations

import io
import os
import stat
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from .listing import MOST_ENTRIES, NOISE, Entry
from .submission import Refused
from .tar import Member, TarError, members

LARGEST_ARCHIVE = 16 << 20  # bytes on disk; the files of an assignment are a hundredth of it
TARS = (".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tbz2", ".tbz", ".tar.xz", ".txz")
# Archives without a reader in Python's standard library, and single compressed files.
UNREAD = (
    *(".7z", ".rar", ".zipx", ".tzst", ".ace", ".arj", ".lzh", ".cab", ".dmg", ".iso", ".sit"),
    *(".gz", ".bz2", ".xz", ".zst", ".z", ".lzma"),
)
_PLAIN_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_READ_ONLY = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)


def is_archive(name: str) -> bool:
    """Whether a file of this `name` is an archive that can be read here."""
    return name.lower().endswith((".zip", *TARS))


def is_unread_archive(name: str) -> bool:
    """Whether a file of this `name` is an archive, but of no kind that can be read here."""
    return name.lower().endswith(UNREAD) and not is_archive(name)


def file_entry(name: str, path: Path) -> Entry:
    """What lies at a path, whatever it is, under a name.

    Raises:
        OSError: nothing does, or it cannot be reached.
    """
    status = path.lstat()
    kind = _kind(status.st_mode)
    below = (lambda: walk_folder(path)) if kind == "folder" else None
    return Entry(name, kind, status.st_size, _reader(path), below)


def list_folder(folder: Path) -> list[Entry]:
    """The first level of a folder, by name.

    Raises:
        OSError: it cannot be read.
    """
    return [_listed(path.name, path) for path in sorted(folder.iterdir())]


def walk_folder(folder: Path) -> list[Entry]:
    """Everything below a folder, names from it on; links are not followed."""
    entries: list[Entry] = []
    for parent, folders, files in os.walk(folder, followlinks=False):
        for name in sorted([*folders, *files]):
            path = Path(parent) / name
            entries.append(_listed(path.relative_to(folder).as_posix(), path))
        folders[:] = sorted(name for name in folders if name.lower() not in NOISE)
        if len(entries) > MOST_ENTRIES:
            break
    return entries


def _listed(name: str, path: Path) -> Entry:
    """A name of a folder, even where no more than the name can be seen."""
    try:
        return file_entry(name, path)
    except OSError:
        return Entry(name, "file without access", 0, _reader(path))


def open_archive(entry: Entry) -> list[Entry]:
    """The entries of a zip or tar archive.

    Args:
        entry: the archive, whose name says its kind.

    Raises:
        Refused: it is too large or cannot be read; the text says so.
    """
    if entry.size > LARGEST_ARCHIVE:
        raise Refused(f"{entry.name} is larger than {LARGEST_ARCHIVE >> 20} MB")
    # A copy in memory: what is looked at is what is read, even if the file changes meanwhile.
    data = entry.read(LARGEST_ARCHIVE + 1)
    if len(data) > LARGEST_ARCHIVE:
        raise Refused(f"{entry.name} is larger than {LARGEST_ARCHIVE >> 20} MB")
    if entry.name.lower().endswith(TARS):
        try:
            found = members(data, MOST_ENTRIES + 1)
        except TarError as error:
            said = f"{entry.name} is no readable tar archive ({error}): hand in a zip"
            raise Refused(said) from error
        return [_tar_entry(each) for each in found if each.name not in (".", "")]
    return zip_entries(entry.name, io.BytesIO(data))


def zip_entries(name: str, file: Path | io.BytesIO) -> list[Entry]:
    """The entries of a zip archive, which are read from it when they are asked for.

    Args:
        name: of the archive, for messages.
        file: the archive.

    Raises:
        Refused: it cannot be read.
    """
    try:
        archive = zipfile.ZipFile(file)
        return [_zip_entry(archive, info) for info in archive.infolist()]
    except Exception as error:  # zipfile answers damage with a dozen types
        raise Refused(f"{name} is no readable zip archive: {type(error).__name__}") from error


def first_level(entries: Sequence[Entry]) -> list[Entry]:
    """Entries of an archive put into their first folders, as `list_folder` gives a disk's.

    One whose name leads elsewhere gets the kind "misplaced".

    Args:
        entries: all of the archive.
    """
    folders: dict[str, list[Entry]] = {}
    files: list[Entry] = []
    for entry in entries:
        first, slash, rest = entry.name.removeprefix("./").partition("/")
        if entry.name.startswith("/") or ".." in entry.name.split("/"):
            files.append(replace(entry, kind="misplaced"))
        elif not slash and entry.kind != "folder":
            files.append(entry)
        elif first:
            inside = folders.setdefault(first, [])
            if rest:
                inside.append(Entry(rest, entry.kind, entry.size, entry.read))
    made = [folder_entry(name, inside) for name, inside in folders.items()]
    return sorted([*made, *files], key=lambda entry: entry.name)


def folder_entry(name: str, inside: Sequence[Entry]) -> Entry:
    """A folder of an archive, by its `name` and what is `inside`."""
    return Entry(name, "folder", 0, lambda _limit: b"", lambda: list(inside))


def _tar_entry(member: Member) -> Entry:
    name, data = member.name.removeprefix("./"), member.data
    return Entry(name, member.kind, len(data), lambda limit: bytes(data[:limit]))


def _zip_entry(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> Entry:
    def read(limit: int) -> bytes:
        try:
            with archive.open(info) as file:
                return file.read(limit)
        except Exception as error:  # zipfile answers damage with a dozen types
            said = f"{info.filename} is no readable file of its zip archive"
            raise Refused(f"{said}: {type(error).__name__}") from error

    name = info.orig_filename.replace("\\", "/")  # some Windows programs write backslashes
    unix = info.external_attr >> 16 if info.create_system == 3 else 0
    kind = _kind(unix) if stat.S_IFMT(unix) else "folder" if name.endswith("/") else "file"
    if kind == "file" and info.flag_bits & 0x1:
        kind = "encrypted file"
    if kind == "file" and info.compress_type not in _PLAIN_METHODS:
        kind = "file of an unusual compression"
    return Entry(name.removesuffix("/"), kind, info.file_size, read)


def _reader(path: Path) -> Callable[[int], bytes]:
    def read(limit: int) -> bytes:
        # Looked at again once open, since a name may stand for another file by now.
        with os.fdopen(os.open(path, _READ_ONLY | getattr(os, "O_BINARY", 0)), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                return b""
            return file.read(limit)

    return read


def _kind(mode: int) -> str:
    if stat.S_ISREG(mode):
        return "file"
    if stat.S_ISDIR(mode):
        return "folder"
    return "link" if stat.S_ISLNK(mode) else "device"
