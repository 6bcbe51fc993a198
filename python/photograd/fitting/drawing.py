"""A field as a camera sees it, and as a notebook shows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.color import srgb_encode, unpremultiply
from photograd_course.metrics import round_to_8_bits

from photograd._notebook import as_html, png
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.errors import Error, ShapeError, message
from photograd.representation import Fittable, ImageBatch, Outputs, RayBatch, RenderOptions
from photograd.types import Array

RAYS_AT_ONCE = 1 << 16
PORTRAIT = 128
"""Pixels along an edge of the picture of a field in a notebook."""


def render_field(field: Fittable, camera: Camera, stop: float) -> tuple[Array, Array, Array]:
    """Premultiplied color (H, W, 3), opacity (H, W) and depth (H, W) seen by a camera.

    Colors are linear or display values, as the field's `color_space` says; `stop` is that of
    `RenderOptions`.

    Raises:
        ShapeError: a rendering without opacity or depth.
    """
    options = RenderOptions(stop=stop)
    size = (camera.height, camera.width)
    drawn: Any = field
    if "rays" not in drawn.capabilities:
        whole, _ = drawn.render(ImageBatch(camera), seed=0, step=0, options=options)
        color, opacity, depth = _require_all(field, whole)
        return color.reshape(*size, 3), opacity.reshape(size), depth.reshape(size)
    parts = []
    for start in range(0, camera.width * camera.height, RAYS_AT_ONCE):
        ids = np.arange(start, min(start + RAYS_AT_ONCE, camera.width * camera.height))
        origins, directions = camera.rays(ids)
        batch = RayBatch(origins, directions, ids.astype(np.uint32))
        outputs, _ = drawn.render(batch, seed=0, step=0, options=options)
        parts.append(_require_all(field, outputs))
    color, opacity, depth = (np.concatenate(part) for part in zip(*parts, strict=True))
    return color.reshape(*size, 3), opacity.reshape(size), depth.reshape(size)


def _require_all(field: Fittable, outputs: Outputs) -> tuple[Array, Array, Array]:
    """Color, opacity and depth of a rendering; what `Outputs` may leave out is needed to draw."""
    color, opacity, depth = outputs.color, outputs.opacity, outputs.depth
    for name, array in (("opacity", opacity), ("depth", depth)):
        if array is None or 3 * array.size != color.size:
            got = "None" if array is None else f"shape {array.shape}"
            expected = f"{color.size // 3} values, to be drawn over a background"
            remedy = "return Outputs(color, opacity, depth), ones and zeros if there are none"
            raise ShapeError(message(f"{field.name}.render", name, expected, got, remedy))
    assert opacity is not None
    assert depth is not None
    return color, opacity, depth


@dataclass(frozen=True, eq=False)
class Picture:
    """What a camera sees, for people to look at and for programs to measure.

    Attributes:
        color: (H, W, 3) display values over the background, multiples of 1/255.
        opacity: (H, W), 0 to 1.
        depth: (H, W) mean distance in meters, along the ray or, of Gaussians and meshes, along the
            viewing axis; NaN where hardly anything is, an opacity below 1/255.
    """

    color: Array
    opacity: Array
    depth: Array


def mean_depth(depth: Array, opacity: Array) -> Array:
    """Mean distance (H, W) from a sum of weight times distance; NaN for opacities below 1/255.

    Args:
        depth: (H, W) the sum, in meters.
        opacity: (H, W) the sum of the weights.
    """
    visible = opacity >= 1 / 255
    mean = np.full(depth.shape, np.nan, depth.dtype)
    np.divide(depth, opacity, out=mean, where=visible)
    return mean


def draw_field(
    field: Fittable, background: Array | None, camera: Camera, stop: float = 1e-4
) -> Picture:
    """The field as a camera sees it, over white or a linear background (3,).

    Args:
        field: what is drawn.
        background: linear (3,) behind it, or None for white.
        camera: where it is seen from.
        stop: transmittance below which a ray ends.
    """
    color, opacity, depth = render_field(field, camera, stop)
    over = _over_background(field, background, color, opacity)
    return Picture(over, opacity, mean_depth(depth, opacity))


def display_field(
    field: Fittable, background: Array | None, camera: Camera, stop: float = 1e-4
) -> Array:
    """The field (H, W, 3) in display values, over white or a linear background (3,).

    Args:
        field: what is drawn.
        background: linear (3,) behind it, or None for white.
        camera: where it is seen from.
        stop: transmittance below which a ray ends.
    """
    color, opacity, _ = render_field(field, camera, stop)
    return _over_background(field, background, color, opacity)


def _over_background(
    field: Fittable, background: Array | None, color: Array, opacity: Array
) -> Array:
    """Premultiplied colors of a field over white or a linear background, in display values."""
    if field.color_space == "display":
        behind = 1.0 if background is None else srgb_encode(background)
        over = color + (1 - opacity[..., None]) * behind
        return round_to_8_bits(over.astype(np.float64))
    if background is not None:
        over = color + (1 - opacity[..., None]) * background
        return round_to_8_bits(srgb_encode(over.astype(np.float64)))
    straight = unpremultiply(color.astype(np.float64), opacity.astype(np.float64))
    return over_white(srgb_encode(straight), opacity)


def over_white(encoded: Array, alpha: Array) -> Array:
    """Straight display values over white, clipped and rounded to 8 bits.

    Args:
        encoded: (H, W, 3) display values, straight.
        alpha: (H, W).
    """
    alpha = alpha[..., None]
    return round_to_8_bits(np.clip(encoded, 0, 1) * alpha + (1 - alpha))


def portrait(field: Fittable, background: Array | None) -> Array:
    """The field (H, W, 3) in display values, from a camera in front of its box.

    Args:
        field: what is drawn.
        background: linear (3,) behind it, or None for white.
    """
    (camera,) = orbit_cameras(field.box, 1, size=PORTRAIT)
    return display_field(field, background, camera)


def field_html(
    title: str, field: Fittable, background: Array | None, facts: Mapping[str, object]
) -> str:
    """What a notebook shows of a field: its size, some facts, a picture.

    A field that cannot be drawn is shown without a picture, and with the reason.

    Args:
        title: a heading.
        field: what is drawn.
        background: linear (3,) behind it, or None for white.
        facts: rows of the table, by name.
    """
    size = " x ".join(map(str, field.shape))
    stored = sum(array.nbytes for array in field.stored().values())
    rows: dict[str, object] = {"representation": field.name, "size": size}
    rows |= {"memory": f"{stored / 2**20:.1f} MiB", **facts}
    picture = None
    try:
        picture = png(portrait(field, background))
    except Error as failure:
        rows["picture"] = failure
    return as_html(title, rows, picture)
