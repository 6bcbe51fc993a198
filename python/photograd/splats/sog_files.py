"""Gaussians in .sog files: an archive of lossless WebP images and meta.json, which scales them.

Version 2, as PlayCanvas's SplatTransform reads and writes it. Pixel i of an image, row by row,
belongs to Gaussian i, in the frame of .ply files:

    means_l, means_u   low and high bytes of sign(x) log(1 + |x|), 16 bits between two limits
    quats              three components of the unit quaternion (w, x, y, z), 127.5 (1 + sqrt2 q),
                       and 252 + the number of the fourth, the largest, which is positive
    scales             logarithms, as entries of a table of 256
    sh0                coefficients of degree 0 as entries of another, and 255 times the opacity
    shN_labels         two bytes: which row of a palette has the other coefficients
    shN_centroids      64 rows of the palette side by side, as entries of a third table

Here Gaussians are sorted along a Morton curve, which the images compress better for.
"""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.atomic_io import atomic_write
from PIL import Image

from photograd.errors import IoError, message
from photograd.splats.coding import Coding, Codings, opacity_of, turn_of_error, unit_quats
from photograd.splats.palette import palette_of, table_of
from photograd.splats.splat_files import morton_order
from photograd.splats.splatting import Gaussians
from photograd.types import Array

_WRITER = "write_gaussian_sog"
LARGEST_PALETTE = 1 << 16
A_ROW = 64
"""Entries of the palette side by side."""
LOG_SCALES = (-87.0, 88.0)
"""Logarithms of what float32 holds in full precision."""
_OTHERS = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest of an archive: the same Gaussians, the same bytes
_Images = dict[str, NDArray[np.uint8]]


def write_gaussian_sog(path: Path, gaussians: Gaussians, *, antialiased: bool = False) -> None:
    """Write Gaussians, sorted, whole or not at all.

    Args:
        path: of the file.
        gaussians: to be written, in the frame of .ply files.
        antialiased: whether they were fitted so.

    Raises:
        IoError: none to write, or the file cannot be written.
    """
    if not len(gaussians):
        raise IoError(message(_WRITER, "gaussians", "at least one", 0))
    ordered = sorted_gaussians(gaussians)
    meta, images = encode_sog(ordered)
    meta["antialias"] = antialiased
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        for name, pixels in images.items():
            archive.writestr(zipfile.ZipInfo(f"{name}.webp", _DATE), _webp(pixels))
        archive.writestr(zipfile.ZipInfo("meta.json", _DATE), json.dumps(meta))
    atomic_write(path, stream.getvalue())


def sorted_gaussians(gaussians: Gaussians) -> Gaussians:
    """The same along a Morton curve, as `write_gaussian_sog` writes them.

    Args:
        gaussians: in any order.
    """
    order = morton_order(gaussians.means.astype(np.float64))
    return Gaussians(**{name: rows[order] for name, rows in gaussians.arrays().items()})


def encode_sog(gaussians: Gaussians) -> tuple[dict[str, Any], _Images]:
    """What meta.json says, and the images (H, W, 3 or 4), by name.

    Args:
        gaussians: in the order of the file.
    """
    n = len(gaussians)
    width = 4 * int(np.ceil(np.sqrt(n) / 4))
    shape = (4 * int(np.ceil(n / width / 4)), width)
    bent = _bent(gaussians.means.astype(np.float64))
    lowest, extent = bent.min(axis=0), np.ptp(bent, axis=0)
    steps = np.rint((bent - lowest) * (65535 / np.where(extent > 0, extent, 1.0)))
    words = steps.astype(np.uint16)
    table, scales = table_of(gaussians.log_scales.astype(np.float64).clip(*LOG_SCALES))
    colors, constant = table_of(gaussians.sh[:, 0].astype(np.float64))
    opacity = np.rint(255.0 * opacity_of(gaussians.opacity_logits)).astype(np.uint8)
    rows: _Images = {
        "means_l": (words & 0xFF).astype(np.uint8),
        "means_u": (words >> 8).astype(np.uint8),
        "quats": _smallest_three(unit_quats(gaussians.quats)),
        "scales": scales,
        "sh0": np.concatenate([constant, opacity[:, None]], axis=1),
    }
    meta: dict[str, Any] = {
        "version": 2,
        "count": n,
        "means": {
            "mins": lowest.tolist(),
            "maxs": (lowest + extent).tolist(),
            "files": ["means_l.webp", "means_u.webp"],
        },
        "scales": {"codebook": table.tolist(), "files": ["scales.webp"]},
        "quats": {"files": ["quats.webp"]},
        "sh0": {"codebook": colors.tolist(), "files": ["sh0.webp"]},
    }
    images = {name: _laid_out(each, shape) for name, each in rows.items()}
    if gaussians.degree:
        palette, labels = palette_of(gaussians.sh[:, 1:].reshape(n, -1), LARGEST_PALETTE)
        values, entries = table_of(palette)
        images["shN_centroids"] = _side_by_side(entries.reshape(len(palette), -1, 3))
        two = np.stack([labels & 0xFF, labels >> 8, np.zeros_like(labels)], axis=1)
        images["shN_labels"] = _laid_out(two.astype(np.uint8), shape)
        meta["shN"] = {
            "count": len(palette),
            "bands": gaussians.degree,
            "codebook": values.tolist(),
            "files": ["shN_centroids.webp", "shN_labels.webp"],
        }
    return meta, images


def sog_codings(gaussians: Gaussians) -> Codings:
    """Errors of half a step of each quantity; of harmonics, what the palette leaves.

    Args:
        gaussians: to be written.
    """
    meta, images = encode_sog(sorted_gaussians(gaussians))
    extent = np.subtract(meta["means"]["maxs"], meta["means"]["mins"])
    largest = float(np.abs(gaussians.means).max(initial=0.0))
    step = 0.5 / 65535 * float(extent.max()) * (1.0 + largest)
    codings = {
        # Half a step of the bent axis, times the slope 1 + |x| there.
        "means": Coding(1.001 * step + 1e-6 * largest),
        "log_scales": Coding(_half_gap(meta["scales"]["codebook"]), *LOG_SCALES),
        # Three components are off by 1/(255 sqrt 2) each; the fourth, which is no smaller than
        # they are, by the sum of the three at most.
        "rotation": Coding(turn_of_error(np.sqrt(3.0 + 9.0) / (255.0 * np.sqrt(2.0)))),
        "opacity": Coding(0.5 / 255.0 + 1e-7),
        "color": Coding(0.2820948 * _half_gap(meta["sh0"]["codebook"])),
    }
    if gaussians.degree:
        decoded = decode_sog(meta, images).sh[:, 1:]
        error = np.abs(decoded - sorted_gaussians(gaussians).sh[:, 1:]).max(initial=0.0)
        codings["harmonics"] = Coding(float(error) * 1.001 + 1e-6)
    return codings


def decode_sog(meta: dict[str, Any], images: _Images) -> Gaussians:
    """The Gaussians, float32, that `encode_sog` has encoded.

    Args:
        meta: as meta.json has it.
        images: by name.
    """
    n = int(meta["count"])
    rows = {
        name: pixels.reshape(-1, pixels.shape[2])[:n]
        for name, pixels in images.items()
        if name != "shN_centroids"
    }
    words = rows["means_l"].astype(np.int64) + 256 * rows["means_u"].astype(np.int64)
    low, high = np.array(meta["means"]["mins"]), np.array(meta["means"]["maxs"])
    bent = low + (high - low) * (words / 65535)
    coefficients = [np.array(meta["sh0"]["codebook"])[rows["sh0"][:, :3]][:, None]]
    if "shN" in meta:
        count, bands = int(meta["shN"]["count"]), int(meta["shN"]["bands"])
        per_entry = (bands + 1) ** 2 - 1
        entries = images["shN_centroids"].reshape(-1, A_ROW, per_entry, 3)
        entries = entries.reshape(-1, per_entry, 3)[:count]
        label = rows["shN_labels"].astype(np.int64)
        chosen = entries[label[:, 0] + 256 * label[:, 1]]
        coefficients.append(np.array(meta["shN"]["codebook"])[chosen])
    alpha = rows["sh0"][:, 3] / 255.0
    with np.errstate(divide="ignore"):
        logits = np.log(alpha) - np.log1p(-alpha)
    return Gaussians(
        means=(np.sign(bent) * np.expm1(np.abs(bent))).astype(np.float32),
        log_scales=np.array(meta["scales"]["codebook"])[rows["scales"]].astype(np.float32),
        quats=_from_smallest_three(rows["quats"]).astype(np.float32),
        opacity_logits=logits.astype(np.float32),
        sh=np.concatenate(coefficients, axis=1).astype(np.float32),
    )


def _bent(x: Array) -> Array:
    return np.asarray(np.sign(x) * np.log1p(np.abs(x)))


def _smallest_three(quats: Array) -> NDArray[np.uint8]:
    """(N, 4) bytes of unit quaternions."""
    largest = np.abs(quats).argmax(axis=1)
    signed = quats * np.where(np.take_along_axis(quats, largest[:, None], 1) < 0, -1.0, 1.0)
    three = np.take_along_axis(signed, _OTHERS[largest], axis=1)
    packed = np.rint(255.0 * (0.5 + three / np.sqrt(2.0))).clip(0, 255)
    return np.concatenate([packed, 252.0 + largest[:, None]], axis=1).astype(np.uint8)


def _from_smallest_three(packed: NDArray[np.uint8]) -> Array:
    three = (packed[:, :3] / 255.0 - 0.5) * np.sqrt(2.0)
    largest = packed[:, 3].astype(np.int64) - 252
    quats = np.zeros((len(packed), 4))
    np.put_along_axis(quats, _OTHERS[largest], three, axis=1)
    fourth = np.sqrt(np.maximum(1.0 - (three * three).sum(axis=1), 0.0))
    np.put_along_axis(quats, largest[:, None], fourth[:, None], axis=1)
    return quats


def _half_gap(table: list[float]) -> float:
    """Half of the widest step of a sorted table: the largest error inside of it."""
    return float(0.5 * np.diff(table).max(initial=0.0)) * 1.001 + 1e-6


def _laid_out(rows: NDArray[np.uint8], shape: tuple[int, int]) -> NDArray[np.uint8]:
    pixels = np.zeros((shape[0] * shape[1], rows.shape[1]), np.uint8)
    pixels[: len(rows)] = rows
    return pixels.reshape(*shape, rows.shape[1])


def _side_by_side(entries: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A palette (P, K, 3) as an image of 64 entries a row."""
    filled = np.zeros((-(-len(entries) // A_ROW) * A_ROW, *entries.shape[1:]), np.uint8)
    filled[: len(entries)] = entries
    return filled.reshape(-1, A_ROW * entries.shape[1], 3)


def _webp(pixels: NDArray[np.uint8]) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "WEBP", lossless=True, exact=True, quality=100, method=4)
    return stream.getvalue()
