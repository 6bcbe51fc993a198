"""Take a submission into memory from a zip, a folder or single files. Nothing is ever unpacked."""

from __future__ import annotations

import io
import os
import re
import stat
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

from ..assignment.manifest import Manifest
from .listing import MOST_ENTRIES, NOISE, Entry, choose
from .submission import Submission, refused, wanted_names

LARGEST_ZIP = 16 << 20  # bytes on disk; the files of an assignment are a hundredth of it
_PLAIN_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_READ_ONLY = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)


def take(manifest: Manifest, path: Path) -> Submission:
    """Whatever lies at ``path``, a zip, a folder or the graded module itself.

    Never raises for what a submission holds: the result's `problem` says what is wrong with it.
    """
    try:
        kind = path.lstat().st_mode
        if stat.S_ISDIR(kind):
            return _take_folder(manifest, path)
        if not stat.S_ISREG(kind):
            return refused(f"{path.name} is no plain file")
        if path.suffix.lower() == ".py":
            return take_parts(manifest, {path.name: path})
        return take_zip(manifest, path)
    except OSError as error:
        return refused(f"{path.name} cannot be read: {error.strerror or error}")


def take_parts(manifest: Manifest, parts: Mapping[str, Path]) -> Submission:
    """Single files, named as their student named them; one zip among them stands for all.

    Canvas puts "-1" behind the name of a file that is handed in again; that is undone.
    """
    zips = [path for name, path in parts.items() if name.lower().endswith(".zip")]
    if len(parts) == 1 and zips:
        return take_zip(manifest, zips[0])
    entries = [_file_entry(_as_wanted(manifest, name), path) for name, path in parts.items()]
    return choose(manifest, entries)


def take_zip(manifest: Manifest, path: Path) -> Submission:
    """The files of a zip archive, read one by one against their limits."""
    try:
        if path.stat().st_size > LARGEST_ZIP:
            return refused(f"{path.name} is larger than {LARGEST_ZIP >> 20} MB")
        # A copy in memory: what is looked at is what is read, even if the file changes meanwhile.
        with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
            entries = [_zip_entry(archive, info) for info in archive.infolist()]
            return choose(manifest, entries)
    except Exception as error:  # zipfile answers damage with a dozen types
        return refused(f"{path.name} is no readable zip archive: {type(error).__name__}")


def _zip_entry(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> Entry:
    def read(limit: int) -> bytes:
        with archive.open(info) as file:
            return file.read(limit)

    name = info.orig_filename.replace("\\", "/")  # some Windows programs write backslashes
    unix = info.external_attr >> 16 if info.create_system == 3 else 0
    kind = _kind(unix) if stat.S_IFMT(unix) else "folder" if name.endswith("/") else "file"
    if kind == "file" and info.flag_bits & 0x1:
        kind = "encrypted file"
    if kind == "file" and info.compress_type not in _PLAIN_METHODS:
        kind = "file of an unusual compression"
    return Entry(name.removesuffix("/"), kind, info.file_size, read)


def _take_folder(manifest: Manifest, folder: Path) -> Submission:
    entries: list[Entry] = []
    for parent, folders, files in os.walk(folder, followlinks=False):
        for name in sorted([*folders, *files]):
            path = Path(parent) / name
            entries.append(_file_entry(path.relative_to(folder).as_posix(), path))
        folders[:] = sorted(name for name in folders if name.lower() not in NOISE)
        if len(entries) > MOST_ENTRIES:
            break
    zips = [entry for entry in entries if entry.name.lower().endswith(".zip")]
    others = [entry for entry in entries if entry not in zips and entry.kind != "folder"]
    if len(zips) == 1 and zips[0].kind == "file" and not _any_wanted(manifest, others):
        return take_zip(manifest, folder / zips[0].name)
    return choose(manifest, entries)


def _any_wanted(manifest: Manifest, entries: list[Entry]) -> bool:
    names = {name.casefold() for name in wanted_names(manifest)}
    return any(entry.name.rpartition("/")[2].casefold() in names for entry in entries)


def _file_entry(name: str, path: Path) -> Entry:
    status = path.lstat()
    return Entry(name, _kind(status.st_mode), status.st_size, _reader(path))


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


def _as_wanted(manifest: Manifest, name: str) -> str:
    plain = re.sub(r"-\d{1,3}(?=\.[a-z]+$)", "", name)
    return plain if plain in wanted_names(manifest) else name
