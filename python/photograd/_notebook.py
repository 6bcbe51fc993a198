"""What a notebook shows of an object: a small picture, and a table of facts. Without Matplotlib."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping, Sequence

import numpy as np
from PIL import Image

from photograd.types import Array

EDGE = 256
"""Pixels along the longest edge of a picture at most."""
GAP = 4
BLUE, RED = np.array([0.13, 0.4, 0.67]), np.array([0.7, 0.09, 0.17])


def smaller(image: Array, edge: int = EDGE) -> Array:
    """An image (H, W, ...) of at most `edge` pixels along an edge, by an integer box average."""
    factor = -(-max(image.shape[:2]) // edge)
    if factor < 2:
        return image
    found = image.astype(np.float64)
    for axis in (0, 1):
        starts = np.arange(0, image.shape[axis], factor)
        sizes = np.diff(np.append(starts, image.shape[axis]))
        shape = [1] * image.ndim
        shape[axis] = len(starts)
        found = np.add.reduceat(found, starts, axis=axis) / sizes.reshape(shape)
    return found


def signed_colors(values: Array) -> Array:
    """(H, W, 3) display colors of signed values (H, W): blue below 0, white at 0, red above.

    The scale ends at the 99.5 % quantile of the absolute values; values that are not finite are
    shown as 0.
    """
    finite = np.nan_to_num(values.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    limit = float(np.quantile(np.abs(finite), 0.995)) or float(np.abs(finite).max()) or 1.0
    share = np.clip(finite / limit, -1, 1)[..., None]
    end = np.where(share < 0, BLUE, RED)
    colors: Array = 1 + np.abs(share) * (end - 1)
    return colors


def sheet(images: Sequence[Array], columns: int, edge: int) -> Array:
    """Images (H, W, 3) in rows, each at most `edge` pixels along an edge, on white."""
    small = [smaller(image, edge) for image in images]
    height, width = (max(image.shape[axis] for image in small) for axis in (0, 1))
    columns = min(columns, len(small))
    rows = -(-len(small) // columns)
    found = np.ones((rows * (height + GAP) - GAP, columns * (width + GAP) - GAP, 3))
    for k, image in enumerate(small):
        top, left = k // columns * (height + GAP), k % columns * (width + GAP)
        found[top : top + image.shape[0], left : left + image.shape[1]] = image
    return found


def png(image: Array) -> bytes:
    """A PNG file, at most `EDGE` pixels along an edge, of display values (H, W, 3) in 0 to 1."""
    return png_of_sheet(smaller(image))


def png_of_sheet(image: Array) -> bytes:
    """A PNG file of display values (H, W, 3) at their own size; values that are not finite: 0."""
    pixels = np.rint(255 * np.clip(np.nan_to_num(image, nan=0.0), 0, 1)).astype(np.uint8)
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


def as_html(title: str, facts: Mapping[str, object], picture: bytes | None) -> str:
    """A heading, a table of facts, and below it a PNG file, which the text holds."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
        f"<td style='text-align:left'>{html.escape(str(value))}</td></tr>"
        for name, value in facts.items()
    )
    text = f"<b>{html.escape(title)}</b><table>{rows}</table>"
    if picture is not None:
        data = base64.b64encode(picture).decode("ascii")
        text += f"<img alt='{html.escape(title)}' src='data:image/png;base64,{data}'>"
    return f"<div>{text}</div>"
