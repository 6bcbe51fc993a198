"""The two envelopes of .spz files, a format of Niantic: a header and six compressed streams.

    versions 2 and 3: all of this within one gzip stream
        u32 "NGSP", u32 version, u32 count, u8 degree, u8 fractional bits, u8 flags, u8 0
        positions, alphas, colors, scales, rotations, harmonics
    version 4: the header in the open, each stream compressed by Zstandard
        the 16 bytes above, the last of them the number of streams; u32 offset of the table, 12
        bytes; extensions, which end where the table begins
        for each stream: u64 bytes compressed, u64 bytes; then the streams, in the same order

Flag 1: fitted with antialiasing. Flag 2: there are extensions; versions 2 and 3 have them at the
end. Sizes are believed only as far as they follow from the count.
"""

from __future__ import annotations

import gzip
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from photograd.errors import IoError, message

MAGIC, GZIP = b"NGSP", b"\x1f\x8b\x08"
VERSIONS = (2, 3, 4)
STREAMS = ("positions", "alphas", "colors", "scales", "rotations", "harmonics")
FLAG_ANTIALIASED, FLAG_EXTENSIONS = 1, 2
MAX_DEGREE = 4
MAX_FRACTIONAL_BITS = 23
_HEADER = struct.Struct("<4sIIBBBB")
_ENTRY = struct.Struct("<QQ")
_TABLE_AT = 32
READER = "read_gaussian_spz"


@dataclass(frozen=True)
class SpzHeader:
    """What a file states: `degree` of harmonics, `fractional_bits` of positions, `flags`."""

    version: int
    count: int
    degree: int
    fractional_bits: int
    flags: int

    def sizes(self) -> dict[str, int]:
        """Bytes of each stream."""
        n, coefficients = self.count, (self.degree + 1) ** 2 - 1
        quat = 3 if self.version == 2 else 4
        sizes = (9 * n, n, 3 * n, 3 * n, quat * n, 3 * coefficients * n)
        return dict(zip(STREAMS, sizes, strict=True))


def refuse(path: Path, expected: str, got: object, remedy: str | None = None) -> IoError:
    """The error of a file that is not what it should be, ready to be raised.

    Args:
        path: of the file.
        expected: what would have been read.
        got: what stands there.
        remedy: what can be done about it.
    """
    return IoError(message(READER, f"{path}", expected, f"{got}", remedy))


def read_header(path: Path, content: bytes) -> SpzHeader:
    """The header of a file in either envelope, without what follows.

    Args:
        path: of the file, for errors.
        content: of the file.

    Raises:
        IoError: not an .spz file, another version, or values without meaning.
    """
    start = content[: _HEADER.size]
    if content[:3] == GZIP:
        start, _ = _inflate(path, content, _HEADER.size)
    if len(start) < _HEADER.size or start[:4] != MAGIC:
        got = repr(bytes(start[:4])) if start else "an empty file"
        raise refuse(path, "an .spz file, gzip or 'NGSP'", got)
    _, version, count, degree, bits, flags, _ = _HEADER.unpack(start)
    known = VERSIONS if content[:4] == MAGIC else VERSIONS[:2]  # 2 and 3 are also found bare
    if version not in known:
        raise refuse(path, f"version {' or '.join(map(str, known))} in this envelope", version)
    if degree > MAX_DEGREE:
        raise refuse(path, f"harmonics of degree 0 to {MAX_DEGREE}", degree)
    if bits > MAX_FRACTIONAL_BITS:
        raise refuse(path, f"0 to {MAX_FRACTIONAL_BITS} fractional bits", bits)
    return SpzHeader(version, count, degree, bits, flags)


def read_streams(path: Path, content: bytes, header: SpzHeader) -> dict[str, bytes]:
    """{name: bytes} of the streams, each as long as the header says.

    Args:
        path: of the file, for errors.
        content: of the file.
        header: of the file.

    Raises:
        IoError: truncated, damaged, or of other lengths.
    """
    if header.version == 4:
        return _read_zstd(path, content, header)
    sizes = header.sizes()
    wanted = _HEADER.size + sum(sizes.values())
    if content[:3] == GZIP:
        data, end = _inflate(path, content, wanted)
    else:
        data, end = content[:wanted], "whole" if len(content) <= wanted else "more"
    if len(data) < wanted:
        raise refuse(path, f"{wanted:,} bytes for {header.count:,} Gaussians", f"{len(data):,}")
    if end == "cut" or (end == "more" and not header.flags & FLAG_EXTENSIONS):
        got = {"cut": "a gzip stream without its end", "more": "more"}[end]
        raise refuse(path, f"the end of the file after {wanted:,} bytes", got)
    streams, at = {}, _HEADER.size
    for name, size in sizes.items():
        streams[name] = data[at : at + size]
        at += size
    return streams


def packed(header: SpzHeader, streams: dict[str, bytes]) -> bytes:
    """The bytes of a file, the same for the same input.

    Args:
        header: of the file.
        streams: {name: bytes}.
    """
    names = [name for name in STREAMS if name != "harmonics" or header.degree]
    fields = (MAGIC, header.version, header.count, header.degree, header.fractional_bits)
    if header.version != 4:
        start = _HEADER.pack(*fields, header.flags, 0)
        return gzip.compress(start + b"".join(streams[name] for name in names), mtime=0)
    start = _HEADER.pack(*fields, header.flags, len(names)) + struct.pack("<I12x", _TABLE_AT)
    compressor = zstandard().ZstdCompressor(level=12)
    bodies = [compressor.compress(streams[name]) for name in names]
    table = b"".join(
        _ENTRY.pack(len(body), len(streams[name])) for name, body in zip(names, bodies, strict=True)
    )
    return start + table + b"".join(bodies)


def extensions_of(path: Path, content: bytes, header: SpzHeader) -> list[str]:
    """Hexadecimal types of the extensions of a version 4 file, which we leave aside.

    Args:
        path: of the file, for errors.
        content: of the file.
        header: of the file.

    Raises:
        IoError: records that do not end where the table begins.
    """
    if header.version != 4 or not header.flags & FLAG_EXTENSIONS:
        return []
    found, at, end = [], _TABLE_AT, _table_at(path, content)
    while at < end:
        if at + 8 > end:
            raise refuse(path, f"extensions up to byte {end}", f"a piece of one at byte {at}")
        kind, length = struct.unpack_from("<II", content, at)
        found.append(f"0x{kind:08x}")
        at += 8 + length
    if at > end:
        raise refuse(path, f"extensions up to byte {end}", f"one that reaches to {at}")
    return found


def zstandard() -> Any:
    """The module.

    Raises:
        IoError: it is not installed.
    """
    try:
        import zstandard as module
    except ImportError as failure:
        remedy = "pip install zstandard, or convert to version 3 elsewhere"
        expected = "the package zstandard, for version 4"
        raise IoError(message(READER, "version", expected, "none", remedy)) from failure
    return module


def _table_at(path: Path, content: bytes) -> int:
    if len(content) < _TABLE_AT:
        raise refuse(path, f"a header of {_TABLE_AT} bytes", f"{len(content)} bytes")
    at = int(struct.unpack_from("<I", content, _HEADER.size)[0])
    if not _TABLE_AT <= at <= len(content):
        raise refuse(path, f"a table at byte {_TABLE_AT} to {len(content)}", f"at {at}")
    return at


def _read_zstd(path: Path, content: bytes, header: SpzHeader) -> dict[str, bytes]:
    at, sizes = _table_at(path, content), header.sizes()
    names = [name for name in STREAMS if name != "harmonics" or header.degree]
    count = content[_HEADER.size - 1]
    if count != len(names):
        raise refuse(path, f"{len(names)} streams", count)
    if at + count * _ENTRY.size > len(content):
        raise refuse(path, f"a table of {count} streams", "the end of the file")
    offset, streams = at + count * _ENTRY.size, {"harmonics": b""}
    for i, name in enumerate(names):
        short, size = _ENTRY.unpack_from(content, at + i * _ENTRY.size)
        if size != sizes[name] or offset + short > len(content):
            got = f"{size:,}, compressed to {short:,} of {len(content) - offset:,} left"
            raise refuse(path, f"{sizes[name]:,} bytes of {name} within the file", got)
        streams[name] = _unzstd(path, name, content[offset : offset + short], size)
        offset += short
    if offset != len(content):
        raise refuse(path, "the end of the file", f"{len(content) - offset:,} more bytes")
    return streams


def _unzstd(path: Path, name: str, body: bytes, size: int) -> bytes:
    module = zstandard()
    try:
        stated = module.frame_content_size(body)
        if stated not in (-1, size):  # -1: the frame does not say
            raise refuse(path, f"{size:,} bytes of {name}", f"{stated:,} stated")
        data: bytes = module.ZstdDecompressor().decompress(body, max_output_size=size)
    except module.ZstdError as failure:
        raise refuse(path, f"{name} compressed by Zstandard", failure) from failure
    if len(data) != size:
        raise refuse(path, f"{size:,} bytes of {name}", f"{len(data):,}")
    return data


def _inflate(path: Path, content: bytes, limit: int) -> tuple[bytes, str]:
    """At most `limit` bytes of a gzip stream, and what comes then: "whole", "more" or "cut"."""
    stream = zlib.decompressobj(wbits=31)
    try:
        data = stream.decompress(content, limit)
        rest = b"" if stream.eof else stream.decompress(stream.unconsumed_tail, 1)
    except zlib.error as failure:
        raise refuse(path, "a whole gzip stream", failure) from failure
    if rest or stream.unused_data:
        return data, "more"
    return data, "whole" if stream.eof else "cut"
