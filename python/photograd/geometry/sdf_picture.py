"""A picture of a signed distance function: what the camera's rays meet, lit by a sun and a sky.

A renderer of its own, for these bodies alone; scenes for the path tracer take them as
`photograd.transport.SdfShape`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.checks import require_number

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
from photograd.geometry.sdf import GAVE_UP, Body
from photograd.types import Array

OFFSET = 1e-4  # m: where a shadow ray starts, so far above the surface


@typed_call
@dataclass(frozen=True, eq=False)
class BodyPicture:
    """What a camera sees of a body.

    Attributes:
        radiance: (H, W, 3) linear; 0 beside the body.
        depth: (H, W) distance along the ray, m; infinite beside the body.
        normal: (H, W, 3) out of the surface, unit; 0 beside the body.
        steps: (H, W) int32, how often the distance was asked for the camera's ray.
        shadow: (H, W) where the sun is hidden.
    """

    radiance: Array
    depth: Array
    normal: Array
    steps: npt.NDArray[np.int32]
    shadow: npt.NDArray[np.bool_]


@typed_call
def draw_body(
    body: Body,
    camera: Camera,
    *,
    albedo: Any = (0.7, 0.7, 0.7),
    towards_sun: Any = (0.4, 0.8, 0.5),
    irradiance: float = 3.0,
    sky: float = 0.3,
    t_max: float = 100.0,
) -> BodyPicture:
    """One ray through the middle of each pixel, and one towards the sun.

    A Lambertian surface: radiance = albedo / pi (irradiance cos_sun visible + pi sky (1 + n_y) / 2)
    where the sky shines evenly from the upper half; the body does not hide it from itself.

    Args:
        body: what is seen.
        camera: from where.
        albedo: (3,) in [0, 1].
        towards_sun: (3,), of any length but 0.
        irradiance: of what faces the sun, W/m^2.
        sky: radiance, W/(m^2 sr).
        t_max: m; nothing farther is seen, or throws a shadow.

    Raises:
        ShapeError, RangeError: arguments that are none of these.
        RangeError: a ray that needs more than 1000 steps; names the pixel.
    """
    call = Arguments("draw_body", np.float64)
    sun = call.array("towards_sun", towards_sun, (3,))
    color = call.array("albedo", albedo, (3,), low=0.0, high=1.0)
    if not sun.any():
        raise RangeError(message("draw_body", "towards_sun", "some length", sun))
    require_number("draw_body", "irradiance", irradiance, least=0.0)
    require_number("draw_body", "sky", sky, least=0.0)
    sun = sun / np.linalg.norm(sun)
    origins, directions = camera.rays()
    hits = body.trace(origins, directions, t_max=t_max)
    if (hits.end == GAVE_UP).any():
        row, column = divmod(int(np.argmax(hits.end == GAVE_UP)), camera.width)
        got = f"more in row {row}, column {column}"
        raise RangeError(message("draw_body", "body", "rays of at most 1000 steps", got))
    visible = np.flatnonzero(hits.hit)
    point = origins[visible] + hits.t[visible, None] * directions[visible]
    normal = body.normals(point)
    cosine = (normal @ sun).clip(0.0)
    start = point + OFFSET * normal
    hidden = body.trace(start, np.broadcast_to(sun, start.shape), t_max=t_max).hit & (cosine > 0)
    light = irradiance / np.pi * cosine * ~hidden + 0.5 * sky * (1.0 + normal[:, 1])
    shape = (camera.height, camera.width)
    return BodyPicture(
        _on_picture(visible, light[:, None] * color, (*shape, 3)),
        hits.t.reshape(shape),
        _on_picture(visible, normal, (*shape, 3)),
        hits.steps.reshape(shape),
        _on_picture(visible, hidden, shape),
    )


def _on_picture(visible: Array, rows: Array, shape: tuple[int, ...]) -> Array:
    picture = np.zeros((shape[0] * shape[1], *shape[2:]), rows.dtype)
    picture[visible] = rows
    return picture.reshape(shape)
