"""Gaussians in .spz files, as Niantic defines them: attributes rounded to bytes, in streams.

    positions  24-bit integers, little-endian, times 2^-fractional_bits
    alphas     opacity times 255
    colors     255 (1/2 + 0.15 sh_0)
    scales     16 (10 + logarithm)
    rotations  version 2: x, y, z as 127.5 (1 + q), w >= 0 follows from the length
               from 3 on: the index of the largest of x, y, z, w in the two upper bits of 32; of
               the others, in this order, a sign and 9 bits of magnitude, 511 for sqrt(1/2)
    harmonics  128 (1 + sh_k), coefficient by coefficient, red, green, blue

Their axes are x right, y up, z backward; those of .ply files y down, z forward. Reading and writing
turn half around x, so that a scene looks the same from every format. It stays right-handed.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write
from photograd_course.input_files import read_file

from photograd import sh
from photograd.errors import RangeError, message
from photograd.splats.coding import (
    Coding,
    Codings,
    logit_of,
    opacity_of,
    require_room,
    turn_of_error,
    unit_quats,
)
from photograd.splats.frames import USUAL_UP, Presentation, half_turn
from photograd.splats.splatting import MAX_DEGREE, Gaussians
from photograd.splats.spz_streams import (
    FLAG_ANTIALIASED,
    READER,
    VERSIONS,
    SpzHeader,
    extensions_of,
    packed,
    read_header,
    read_streams,
)
from photograd.types import Array

LOG_SCALES = (-10.0, 255.0 / 16.0 - 10.0)
HARMONICS = (-1.0, 127.0 / 128.0)
COLOR_GAIN = 0.15
MAX_BITS = 12
"""Fractional bits of positions, as the format's own writer has them; fewer for larger scenes."""
_LARGEST = (1 << 23) - 1
_MAGNITUDES = 511.0 * np.sqrt(2.0)  # of a component that is sqrt(1/2) at most
_XYZW_FROM_WXYZ, _WXYZ_FROM_XYZW = [1, 2, 3, 0], [3, 0, 1, 2]


def read_gaussian_spz(
    path: Path, *, memory_limit: int | None = None
) -> tuple[Gaussians, list[str], Presentation]:
    """Read Gaussians in float32, in the frame of .ply files, and sentences for the log.

    Opacities of 0 and 255 have infinite logits. What is up follows from the format; that a file
    does not say "antialiased" says nothing, since few programs set the flag.

    Args:
        path: of the file.
        memory_limit: bytes that may be taken; None takes what there is.

    Raises:
        IoError: no file, a damaged one, another version than 2, 3 or 4, more than memory holds.
    """
    content = read_file(READER, path)
    header = read_header(path, content)
    bands = min(header.degree, MAX_DEGREE)
    require_room(READER, path, header.count, (bands + 1) ** 2, memory_limit)
    streams = {
        name: np.frombuffer(data, np.uint8)
        for name, data in read_streams(path, content, header).items()
    }
    n, coefficients = header.count, (header.degree + 1) ** 2
    harmonics = np.empty((n, coefficients, 3))
    harmonics[:, 0] = (streams["colors"].reshape(n, 3) / 255.0 - 0.5) / COLOR_GAIN
    harmonics[:, 1:] = streams["harmonics"].reshape(n, coefficients - 1, 3) / 128.0 - 1.0
    coordinates = streams["positions"].reshape(n, 3, 3).astype(np.int32)
    fixed = coordinates @ np.array([1, 1 << 8, 1 << 16], np.int32)
    fixed -= (fixed >> 23) << 24  # the sign of 24 bits
    unpack = _unpack_three if header.version == 2 else _unpack_smallest_three
    gaussians = Gaussians(
        means=(fixed * 0.5**header.fractional_bits).astype(np.float32),
        log_scales=(streams["scales"].reshape(n, 3) / 16.0 - 10.0).astype(np.float32),
        quats=unpack(streams["rotations"])[:, _WXYZ_FROM_XYZW].astype(np.float32),
        opacity_logits=logit_of(streams["alphas"] / 255.0).astype(np.float32),
        sh=harmonics[:, : (bands + 1) ** 2].astype(np.float32),
    )
    lines = [f"version {header.version}, {header.fractional_bits} fractional bits of positions"]
    lines.append("half a turn about x: y up, z backward -> y down, z forward (right-handed both)")
    if header.degree > bands:
        lines.append(f"harmonics of degree {header.degree} dropped: {MAX_DEGREE} is ours")
    antialiased = bool(header.flags & FLAG_ANTIALIASED)
    if antialiased:
        lines.append("the file says: fitted with antialiasing")
    kinds = extensions_of(path, content, header)
    if kinds:
        lines.append(f"extensions left aside: {', '.join(kinds)}")
    return half_turn(gaussians), lines, Presentation(USUAL_UP, None, antialiased or None)


def write_gaussian_spz(
    path: Path, gaussians: Gaussians, *, version: int = 3, antialiased: bool = False
) -> None:
    """Write Gaussians of the frame of .ply files, -y up, in their order, whole or not at all.

    Harmonics keep all of their 8 bits; the format's own writer drops 3 and 4 of them, for smaller
    files. What lies outside of `spz_codings` is moved to the limit.

    Args:
        path: of the file.
        gaussians: to be written.
        version: of the format, 2, 3 or 4.
        antialiased: the flag of the header.

    Raises:
        RangeError: another version than 2, 3 or 4.
        IoError: the file cannot be written, or version 4 without the package zstandard.
    """
    if version not in VERSIONS:
        expected = f"one of {', '.join(map(str, VERSIONS))}"
        raise RangeError(message("write_gaussian_spz", "version", expected, version))
    bits, turned = fractional_bits(gaussians), half_turn(gaussians)
    fixed = np.rint(turned.means.astype(np.float64) * 2.0**bits).clip(-_LARGEST, _LARGEST)
    low_bytes = fixed.astype("<i4").view(np.uint8).reshape(-1, 4)[:, :3]
    pack = _pack_three if version == 2 else _pack_smallest_three
    streams = {
        "positions": low_bytes.tobytes(),
        "alphas": _bytes(255.0 * opacity_of(turned.opacity_logits)),
        "colors": _bytes(255.0 * (0.5 + COLOR_GAIN * turned.sh[:, 0].astype(np.float64))),
        "scales": _bytes(16.0 * (10.0 + turned.log_scales.astype(np.float64))),
        "rotations": pack(unit_quats(turned.quats)[:, _XYZW_FROM_WXYZ]),
        "harmonics": _bytes(128.0 * (1.0 + turned.sh[:, 1:].astype(np.float64))),
    }
    flags = FLAG_ANTIALIASED if antialiased else 0
    header = SpzHeader(version, len(gaussians), gaussians.degree, bits, flags)
    atomic_write(path, packed(header, streams))


def spz_codings(gaussians: Gaussians, version: int = 3) -> Codings:
    """Errors of half a step, and of float32 where the file's numbers are none.

    Rotations of version 2: the error of x, y, z is e = sqrt(3)/255 long; w^2 is off by 2 e + e^2 at
    most, w by the root of that. Of the others: each component is off by d = sqrt(1/2)/1022, the
    largest, which is 1/2 at least and not smaller than they, by 3.02 d.

    Args:
        gaussians: to be written.
        version: of the format.
    """
    bits = fractional_bits(gaussians)
    e, d = np.sqrt(3.0) / 255.0, np.sqrt(0.5) / 1022.0
    rotation = np.sqrt(2.0 * e + 2.0 * e * e) if version == 2 else np.sqrt(3.0 + 3.02**2) * d
    limit, dc = _LARGEST / 2.0**bits, 0.5 / COLOR_GAIN * sh.Y_0
    return {
        "means": Coding(0.5 / 2.0**bits, -limit, limit),
        "log_scales": Coding(1.0 / 32.0, *LOG_SCALES),
        "rotation": Coding(turn_of_error(rotation) + 1e-5),
        "opacity": Coding(0.5 / 255.0 + 1e-7),
        "color": Coding(dc / 255.0 + 1e-6, 0.5 - dc, 0.5 + dc),
        "harmonics": Coding(1.0 / 256.0, *HARMONICS),
    }


def fractional_bits(gaussians: Gaussians) -> int:
    """Most bits, 12 at most, with which all positions stay inside of 24 bits with a sign.

    Args:
        gaussians: to be written.
    """
    largest = float(np.abs(gaussians.means).max(initial=0.0))
    room = np.floor(np.log2(_LARGEST / largest)) if largest > 0 else MAX_BITS
    return int(np.clip(room, 0, MAX_BITS))


def _bytes(values: Array) -> bytes:
    """Nearest of 0 to 255; -inf is 0."""
    return bytes(np.rint(values.clip(0.0, 255.0)).astype(np.uint8).tobytes())


def _pack_three(quats: Array) -> bytes:
    return _bytes(127.5 * (1.0 + quats[:, :3] * np.where(quats[:, 3:] < 0, -1.0, 1.0)))


def _unpack_three(data: Array) -> Array:
    xyz = data.reshape(-1, 3) / 127.5 - 1.0
    w = np.sqrt((1.0 - np.square(xyz).sum(axis=1, keepdims=True)).clip(min=0.0))
    return unit_quats(np.concatenate([xyz, w], axis=1))


def _others(largest: Array) -> Array:
    """(N, 3) indices of the components beside the largest, ascending."""
    return np.asarray([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])[largest]


def _pack_smallest_three(quats: Array) -> bytes:
    largest = np.abs(quats).argmax(axis=1)
    rows = np.arange(len(quats))
    positive = quats * np.where(quats[rows, largest] < 0, -1.0, 1.0)[:, None]
    small = positive[rows[:, None], _others(largest)]
    magnitude = np.rint(np.abs(small) * _MAGNITUDES).clip(0, 511).astype(np.uint32)
    fields = magnitude | (small < 0).astype(np.uint32) << 9
    word = largest.astype(np.uint32) << 30 | fields[:, 0] << 20 | fields[:, 1] << 10 | fields[:, 2]
    return bytes(word.astype("<u4").tobytes())


def _unpack_smallest_three(data: Array) -> Array:
    word = data.view("<u4").astype(np.uint32)
    fields = (word[:, None] >> np.array([20, 10, 0], np.uint32)) & 1023
    small = (fields & 511) / _MAGNITUDES * np.where(fields >> 9, -1.0, 1.0)
    largest, rows = (word >> 30).astype(np.intp), np.arange(len(word))
    quats = np.empty((len(word), 4))
    quats[rows[:, None], _others(largest)] = small
    quats[rows, largest] = np.sqrt((1.0 - np.square(small).sum(axis=1)).clip(min=0.0))
    return unit_quats(quats)
