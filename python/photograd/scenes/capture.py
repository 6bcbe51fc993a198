"""Photographing a described scene: cameras all around it, and what a loader will find on disk.

The directions of cameras are a Fibonacci lattice [Gonzalez2010]: equal steps in height, which are
equal areas of the sphere, each turned by the golden angle against the one before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course import random
from photograd_course.checks import require_integer, require_number
from photograd_course.color import srgb_encode, unpremultiply

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.capture.write import Frame
from photograd.errors import RangeError, message
from photograd.scenes.description import Points, SceneDescription

LOWEST, HIGHEST = -0.3, 0.92
"""Sines of the least and the greatest elevation, -17 and 67 degrees: nothing stands on a floor, so
that pictures from slightly below see something, and no camera looks straight down."""

FIELD_OF_VIEW = 40.0
"""Degrees, across the whole picture."""

FILL = 0.9
"""How much of the picture's width a ball around the scene takes up."""

_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))


@typed_call
def capture_cameras(
    bounds: Points,
    views: int,
    test_views: int = 0,
    *,
    size: int,
    seed: int,
    radius: float | None = None,
) -> dict[str, list[Camera]]:
    """Square cameras around the middle of a box, all equally far from it, in one or two splits.

    Together they look along one lattice of views + test_views directions. The test cameras are
    those next to a lattice of test_views directions, so they too are all around; and as every
    direction occurs once, none repeats what a training camera sees. `seed` turns all about +Y.

    Args:
        bounds: (2, 3) box, low < high.
        views: number of training cameras, at least 1.
        test_views: number of test cameras, at least 0.
        size: width and height in pixels; square pixels, principal point in the middle.
        seed: of the turn.
        radius: of a ball around the box's middle that is to be seen whole, in meters; None takes
            the ball through the box's corners.

    Returns:
        "train", and "test" if there are test views.

    Raises:
        ShapeError, RangeError, DtypeError: a bad box, number of views, size, seed or radius.
    """
    name = "capture_cameras"
    box = Arguments(name, np.float64).box("bounds", bounds)
    require_integer(name, "views", views, least=1, most=1 << 16)
    require_integer(name, "test_views", test_views, least=0, most=1 << 16)
    require_integer(name, "size", size, least=1, most=1 << 16)
    if radius is None:
        radius = 0.5 * float(np.linalg.norm(box[1] - box[0]))
    require_number(name, "radius", radius, least=0.0, open_ends=True)
    rays = _lattice(views + test_views, seed)
    is_test = np.zeros(len(rays), dtype=np.bool_)
    is_test[_nearest(rays, _lattice(test_views, seed))] = True
    splits = {"train": rays[~is_test], "test": rays[is_test]}
    return {
        split: [_camera(box.mean(axis=0), ray, radius, size) for ray in chosen]
        for split, chosen in splits.items()
        if len(chosen)
    }


def _camera(center: Points, ray: Points, radius: float, size: int) -> Camera:
    """The camera that sees a ball around `center` over FILL of its width, from along `ray`."""
    half = np.radians(0.5 * FIELD_OF_VIEW)
    # A ball's outline at the angle a from the axis is tan(a) / tan(half) of half the width away.
    distance = radius / np.sin(np.arctan(FILL * np.tan(half)))
    focal, middle = 0.5 * size / np.tan(half), 0.5 * size
    pose = look_at(center + distance * ray, center)
    return Camera(size, size, focal, focal, middle, middle, pose)


def _lattice(count: int, seed: int) -> Points:
    """Unit vectors (count, 3) between the lowest and the highest elevation."""
    height = HIGHEST - (HIGHEST - LOWEST) * (np.arange(count) + 0.5) / max(count, 1)
    turn = 2.0 * np.pi * float(random.uniform(seed))
    angle = turn + _GOLDEN_ANGLE * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.sin(angle), height, across * np.cos(angle)], axis=-1)


def _nearest(rays: Points, wanted: Points) -> npt.NDArray[np.int64]:
    """For each of `wanted` in turn, the index of the nearest ray that is not taken yet."""
    taken: list[int] = []
    for direction in wanted:
        likeness = rays @ direction
        likeness[taken] = -np.inf
        taken.append(int(np.argmax(likeness)))
    return np.array(taken, dtype=np.int64)


# Photographing a described scene: cameras all around it, and what a loader will find on disk.


Picture: TypeAlias = npt.NDArray[np.floating]

RenderView: TypeAlias = Callable[[Camera, int, int], tuple[Picture, Picture]]
"""(camera, samples a pixel, seed) -> linear radiance (H, W, 3) premultiplied by alpha, and alpha
(H, W)."""

_SPLITS = {"train": 0, "test": 1}


@typed_call
def capture_scene(
    scene: SceneDescription,
    render_view: RenderView,
    *,
    views: int,
    test_views: int,
    size: int,
    seed: int,
    spp: int,
    on_view: Callable[[int, int], None] | None = None,
) -> dict[str, list[Frame]]:
    """Splits for `photograd.capture.write_blender_capture`; give it `aabb=scene.bounds`.

    Args:
        scene: what is photographed; its outermost vertex fills 90 % of each picture's half width.
        render_view: the renderer, with the scene already built into it.
        views, test_views: numbers of pictures, at least 1 and at least 0.
        size: width and height in pixels.
        seed: turns the cameras, and gives every view a seed of its own.
        spp: samples a pixel.
        on_view: called with (pictures done, pictures in all) after each.

    Returns:
        "train", and "test" if there are test views: name, camera, display-encoded RGBA (H, W, 4)
        float32 with straight alpha in 0..1, and linear radiance premultiplied with alpha
        (H, W, 4) float32.

    Raises:
        ShapeError, RangeError, DtypeError: numbers outside their range, or a renderer that returns
            other shapes, non-finite or negative radiance, or alpha outside 0..1.
    """
    require_integer("capture_scene", "spp", spp, least=1, most=1 << 20)
    radius = content_radius(scene)
    cameras = capture_cameras(scene.bounds, views, test_views, size=size, seed=seed, radius=radius)
    total = sum(len(members) for members in cameras.values())
    done = 0
    splits: dict[str, list[Frame]] = {}
    for split, members in cameras.items():
        splits[split] = []
        for index, camera in enumerate(members):
            name = f"r_{index:03d}"
            radiance, alpha = render_view(camera, spp, view_seed(seed, split, index))
            where = f"{split} '{name}'"
            linear = _checked(where, radiance, alpha, (camera.height, camera.width))
            splits[split].append((name, camera, display_image(linear), linear))
            done += 1
            if on_view is not None:
                on_view(done, total)
    return splits


def content_radius(scene: SceneDescription) -> float:
    """Radius of the ball around the middle of the bounds that holds all that can be seen.

    That is all vertices; with a density, of which only the box is known, it is the whole box.
    """
    center = scene.bounds.mean(axis=0)
    if scene.density is not None:
        return float(np.linalg.norm(scene.bounds[1] - center))
    reach = [np.linalg.norm(mesh.vertices - center, axis=1).max() for mesh in scene.meshes]
    return float(max(reach))


def view_seed(seed: int, split: str, index: int) -> int:
    """A 32-bit seed for one picture, hashed from the capture's seed, its split and its number."""
    address = {"step": _SPLITS[split], "pixel": index, "sample": 0, "dimension": 1}
    return int(random.random_words(seed, **address))


def display_image(linear: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Premultiplied linear (H, W, 4) as a picture file has it: straight, sRGB-encoded, 0..1.

    What is brighter than display white is clipped; where alpha is 0 the color is 0.
    """
    straight = unpremultiply(linear[..., :3], linear[..., 3])
    encoded = srgb_encode(np.clip(straight, 0.0, 1.0))
    return np.concatenate([encoded, linear[..., 3:]], axis=-1)


def _checked(
    where: str, radiance: Picture, alpha: Picture, shape: tuple[int, int]
) -> npt.NDArray[np.float32]:
    """What the renderer returned as (H, W, 4) float32, or why it cannot be that."""
    call = Arguments("capture_scene", np.float32)
    name = f"render_view: {where}"
    radiance = call.array(f"{name}: radiance", radiance, (*shape, 3), finite=False)
    alpha = call.array(f"{name}: alpha", alpha, shape, finite=False)
    linear = np.concatenate([radiance, alpha[..., None]], axis=-1)
    good = np.isfinite(linear).all(axis=-1) & (linear >= 0.0).all(axis=-1) & (linear[..., 3] <= 1.0)
    if not bool(good.all()):
        row, column = np.argwhere(~good)[0]
        got = f"{linear[row, column].tolist()} at pixel ({row}, {column})"
        expected_text = "finite radiance of at least 0 and alpha in 0..1"
        raise RangeError(message("capture_scene", f"render_view: {where}", expected_text, got))
    return linear
