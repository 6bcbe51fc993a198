"""Read the names and files of a tar archive that lies in memory; nothing is unpacked.

Headers are blocks of 512 bytes [POSIX.1-2017, pax, "ustar Interchange Format"]. What a header says
about lengths is held against the archive itself, so that damaged ones end in an error and none in a
loop or beyond the data.
"""

from __future__ import annotations

import bz2
import lzma
import zlib
from dataclasses import dataclass

BLOCK = 512
MOST_UNPACKED = 64 << 20  # bytes of the archive, decompressed
MOST_LZMA = 96 << 20  # bytes that a decompressor may take for its window
MOST_NAME = 64 << 10
_KINDS = {b"0": "file", b"\0": "file", b"7": "file", b"5": "folder", b"1": "link", b"2": "link"}


class TarError(Exception):
    """No tar archive, a damaged one, or one that unpacks to too much."""


@dataclass(frozen=True)
class Member:
    """One name of an archive, "file", "folder", "link" or "device", and its content."""

    name: str
    kind: str
    data: memoryview


def members(data: bytes, most: int) -> list[Member]:
    """The members of an archive, which may be compressed with gzip, bzip2 or xz.

    Args:
        data: the whole file.
        most: so many of them; the rest is not looked at.

    Raises:
        TarError: it is none, is damaged, or unpacks to more than `MOST_UNPACKED` bytes.
    """
    archive = memoryview(_decompressed(data))
    found: list[Member] = []
    at, long_name = 0, ""
    while len(found) < most:
        header = bytes(archive[at : at + BLOCK])
        if len(header) < BLOCK or not header.strip(b"\0"):
            break
        if not _checksum_fits(header):
            raise TarError("its headers are damaged")
        size = _number(header[124:136])
        content = archive[at + BLOCK : at + BLOCK + size]
        if len(content) < size:
            raise TarError("it is cut off")
        at += BLOCK + -(-size // BLOCK) * BLOCK
        kind = header[156:157]
        if kind == b"L":  # GNU: the name of the next member
            long_name = _text(bytes(content[:MOST_NAME]))
        elif kind == b"x":
            long_name = _pax_path(bytes(content[:MOST_NAME])) or long_name
        elif kind not in b"gK":
            name = long_name or _name(header)
            is_folder = name.endswith("/")
            told = "folder" if is_folder else _KINDS.get(kind, "device")
            found.append(Member(name.rstrip("/"), told, content))
            long_name = ""
    if not found:
        raise TarError("it holds nothing")
    return found


def _decompressed(data: bytes) -> bytes:
    try:
        if data[:2] == b"\x1f\x8b":
            return _whole(zlib.decompressobj(wbits=31).decompress(data, MOST_UNPACKED + 1))
        if data[:3] == b"BZh":
            return _whole(bz2.BZ2Decompressor().decompress(data, MOST_UNPACKED + 1))
        if data[:6] == b"\xfd7zXZ\0":
            unpack = lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=MOST_LZMA)
            return _whole(unpack.decompress(data, MOST_UNPACKED + 1))
    except (zlib.error, OSError, ValueError, EOFError, lzma.LZMAError) as error:
        raise TarError("it does not decompress") from error
    return _whole(data)


def _whole(data: bytes) -> bytes:
    if len(data) > MOST_UNPACKED:
        raise TarError(f"it unpacks to more than {MOST_UNPACKED >> 20} MB")
    return data


def _number(field: bytes) -> int:
    digits = field.strip(b"\0 ")
    try:
        size = int(digits or b"0", 8)  # also refuses the binary numbers of sizes above 8 GB
    except ValueError as error:
        raise TarError("its headers are damaged") from error
    if size < 0:
        raise TarError("its headers are damaged")
    return size


def _checksum_fits(header: bytes) -> bool:
    try:
        stated = int(header[148:156].strip(b"\0 ") or b"0", 8)
    except ValueError:
        return False
    return stated == sum(header[:148]) + 8 * ord(" ") + sum(header[156:])


def _name(header: bytes) -> str:
    name = _text(header[:100])
    is_ustar = header[257:263] == b"ustar\0"
    prefix = _text(header[345:500]) if is_ustar else ""
    return f"{prefix}/{name}" if prefix else name


def _pax_path(records: bytes) -> str:
    """The value of "path" among records such as "18 path=ada/toy.py", each with its length."""
    at = 0
    while at < len(records):
        length, _, _ = records[at : at + 20].partition(b" ")
        if not length.isdigit() or int(length) <= len(length) + 1:
            break
        key, _, value = records[at + len(length) + 1 : at + int(length)].partition(b"=")
        if key == b"path":
            return _text(value.rstrip(b"\n"))
        at += int(length)
    return ""


def _text(data: bytes) -> str:
    return data.split(b"\0")[0].decode("utf-8", errors="surrogateescape")
