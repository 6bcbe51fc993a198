"""The gradient of a photograph's loss as `photograd view` shows it, from any camera.

    voxels, leaves   the derivative of largest magnitude along each ray
    Gaussians        splatted in the place of their colors
    meshes           arrows: where lower loss would take the vertices that are pulled most
    all others       that of the photograph's pixels, projected onto what the camera sees

Colors and the ends of their scale are those of `photograd gradients`.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from photograd import sh
from photograd.capture.camera import Camera
from photograd.commands.view_drawing import COARSE, Shown, reduced, refined
from photograd.errors import Error
from photograd.fields.surface import SurfaceField
from photograd.fitting.drawing import Picture, draw_field
from photograd.geometry.normals import vertex_normals
from photograd.representation import Fittable
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import Gaussians, render
from photograd.types import Array, FloatArray

if TYPE_CHECKING:
    from photograd.capture.view import View
    from photograd.fitting.photograph_gradient import PhotographGradient

HALF = 2
"""The gradient of voxels, which are larger than pixels, has so many times fewer along an edge."""
BEHIND = 0.03
"""What lies further behind the surface than this share of its distance, a photograph hides."""
ARROWS = 300
LONGEST = 0.09
"""Of the diagonal of a mesh: the arrow at the 98 % quantile."""
KEPT = 4
"""Gradients that are held in memory."""
EXPLAIN = {
    "voxels": "derivative with respect to sigma_t of each voxel, the largest along each ray. Blue: "
    "more density lowers the loss; red: less does; gray: no voxel there.",
    "gaussians": "derivative with respect to the opacity logit of each Gaussian. Blue: more "
    "opacity lowers the loss; red: less does.",
    "surface": "arrows go where lower loss would take the vertices that are pulled most; blue "
    "outward, orange inward.",
    "pixels": "derivative with respect to each pixel of the photograph, on what it shows. Blue: "
    "brighter lowers the loss; red: darker does; gray: hidden from the photograph.",
}


class GradientLayer:
    """Pictures of gradients, each found once and kept while it is looked at.

    Attributes:
        said: what the last picture shows, in Markdown.
        latest: the gradient of the last picture; None before there is one.
    """

    def __init__(self, on_change: Callable[[str], None] = lambda _: None) -> None:
        """Begin without any.

        Args:
            on_change: takes what a picture shows.
        """
        self.said = ""
        self.latest: PhotographGradient | None = None
        self._on_change = on_change
        self._lock = threading.Lock()
        self._kept: dict[tuple[int, str], tuple[Shown, PhotographGradient]] = {}

    def pictures(self, shown: Shown, view: View, camera: Camera) -> Iterator[Picture | None]:
        """From coarse to fine: first of the gradient at hand, then that of this photograph.

        Args:
            shown: whose gradient.
            view: the photograph, with its camera in the frame of the page.
            camera: of the page.

        Raises:
            Error: what `photograph_gradient` raises.
        """
        found = self.of(shown, view, search=False)
        if found is None:
            if self.latest is not None and self._belongs(shown):
                yield signed_picture(self.latest, shown)(reduced(camera, HALF * COARSE))
            yield None
            found = self.of(shown, view)
            assert found is not None
        self._say(found, view)
        draw = signed_picture(found, shown)
        if found.kind == "surface":  # whose arrows need a whole picture
            yield draw(camera)
            return
        yield from refined(draw)(reduced(camera, HALF if found.kind == "voxels" else 1))

    def of(self, shown: Shown, view: View, *, search: bool = True) -> PhotographGradient | None:
        """The gradient of a photograph's loss; None if it is not there and not searched for.

        Args:
            shown: whose gradient.
            view: the photograph, with its camera in the frame of the page.
            search: whether to calculate it.

        Raises:
            Error: what `photograph_gradient` raises.
        """
        key = (id(shown), view.name)
        if key in self._kept:
            return self._kept[key][1]
        if not search:
            return None
        with self._lock:  # the thread that draws and a click may both ask
            return self._search(shown, view, key)

    def _search(self, shown: Shown, view: View, key: tuple[int, str]) -> PhotographGradient:
        from photograd.fitting.photograph_gradient import photograph_gradient

        if key in self._kept:
            return self._kept[key][1]
        if shown.field is None:
            raise Error("view: gradient: expected a field, got a scene")
        placed = replace(view, camera=shown.camera(view.camera))
        found = photograph_gradient(shown.field(), shown.background, placed)
        self._kept[key] = shown, found
        while len(self._kept) > KEPT:
            del self._kept[next(iter(self._kept))]
        return found

    def _belongs(self, shown: Shown) -> bool:
        return any(of is shown and found is self.latest for of, found in [*self._kept.values()])

    def _say(self, found: PhotographGradient, view: View) -> None:
        self.latest = found
        ends = "" if found.kind == "surface" else f" Colors end at ±{found.limit:.3g}."
        self.said = (
            f"**Gradient** of the loss against {view.name}, {found.loss:.4g}: "
            f"{EXPLAIN[found.kind]}{ends}"
        )
        self._on_change(self.said)


def signed_picture(gradient: PhotographGradient, shown: Shown) -> Callable[[Camera], Picture]:
    """A gradient as a camera of the page sees it.

    Args:
        gradient: of what is shown.
        shown: a field at a step of its fit.
    """
    assert shown.field is not None
    field = shown.field()

    def draw(camera: Camera) -> Picture:
        if isinstance(field, SurfaceField):
            drawn = draw_field(field, shown.background, shown.camera(camera))
            color = with_arrows(gradient, field, drawn, shown.camera(camera))
            return replace(drawn, color=color)
        values, missing = signed_values(gradient, field, shown, shown.camera(camera))
        color = signed_colors(values, gradient.limit, missing)
        size = values.shape
        return Picture(color, np.ones(size), np.full(size, np.nan))

    return draw


def signed_values(
    gradient: PhotographGradient, field: Fittable, shown: Shown, camera: Camera
) -> tuple[Array, NDArray[np.bool_]]:
    """Values (H, W), and where there is nothing to be shown (H, W).

    Args:
        gradient: of the field.
        field: what is shown.
        shown: has the background.
        camera: in the frame of the field.
    """
    size = camera.height, camera.width
    if gradient.kind == "voxels":
        assert gradient.active is not None
        origins, directions = camera.rays()
        grid = gradient.values, gradient.active, field.box
        values, met, entered = strongest_along(origins, directions, *grid)
        return values.reshape(size), (entered & ~met).reshape(size)
    none = np.zeros(size, bool)
    if isinstance(field, GaussianScene):
        return splatted(field, gradient.values, gradient.limit, camera), none
    return projected(gradient, draw_field(field, shown.background, camera), camera, field)


def signed_colors(values: Array, limit: float, missing: NDArray[np.bool_]) -> FloatArray:
    """(H, W, 3) in the colors of signed pictures: blue below 0, white, red above.

    Args:
        values: (H, W).
        limit: of the scale.
        missing: (H, W) gray.
    """
    from matplotlib.colors import to_rgb
    from photograd_course.viz import style

    shares = style.symmetric_scale(limit)(np.nan_to_num(values))
    colors = np.array(style.signed_color_map()(np.asarray(shares)))[..., :3]
    colors[missing] = to_rgb(style.MISSING)
    return colors


def strongest_along(
    origins: FloatArray,
    directions: FloatArray,
    values: Array,
    active: NDArray[np.bool_],
    box: Array,
) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """Of R rays: the value of largest magnitude, whether any active voxel, and the box, was met.

    A ray is looked at every half voxel.

    Args:
        origins, directions: (R, 3), of length one.
        values: (X, Y, Z).
        active: (X, Y, Z).
        box: (2, 3) around the voxels.
    """
    shape = np.array(values.shape)
    voxel = (np.asarray(box[1]) - box[0]) / shape
    start, end = box_interval(origins, directions, box)
    best, met = np.zeros(len(origins), values.dtype), np.zeros(len(origins), bool)
    step = 0.5 * float(voxel.min())
    rows = np.flatnonzero(end > start)
    at = (origins[rows] - box[0]) / voxel + (start[rows, None] + 0.5 * step) * (
        directions[rows] / voxel
    )
    ahead, left = step * directions[rows] / voxel, np.ceil((end - start)[rows] / step)
    strides = np.array([shape[1] * shape[2], shape[2], 1])
    flat, there = values.reshape(-1), active.reshape(-1)
    while len(rows):
        cell = np.clip(at.astype(np.int64), 0, shape - 1) @ strides
        found = flat[cell]
        stronger = np.abs(found) > np.abs(best[rows])
        best[rows[stronger]] = found[stronger]
        met[rows] |= there[cell]
        left -= 1
        going = left > 0
        rows, at, ahead, left = rows[going], at[going] + ahead[going], ahead[going], left[going]
    return best, met, end > start


def box_interval(
    origins: FloatArray, directions: FloatArray, box: Array
) -> tuple[FloatArray, FloatArray]:
    """(R,) distances at which rays enter a box and leave it; the second is not larger outside.

    Args:
        origins, directions: (R, 3).
        box: (2, 3).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = (np.asarray(box)[:, None] - origins) / directions
    near, far = np.fmin(*ends).max(axis=1), np.fmax(*ends).min(axis=1)
    return np.maximum(near, 0.0), far


def splatted(field: GaussianScene, values: Array, limit: float, camera: Camera) -> Array:
    """(H, W) values of Gaussians, blended as their colors are; those beyond the limit end there.

    Args:
        field: N Gaussians.
        values: (N,).
        limit: of the scale.
        camera: in the frame of the field.
    """
    share = 0.5 * np.clip(values / limit, -1, 1)  # a color is 1/2 + Y_0 sh
    own = field.gaussians
    plain = np.repeat((share / sh.Y_0)[:, None, None], 3, axis=2).astype(own.means.dtype)
    picture, _ = render(
        Gaussians(**{**own.arrays(), "sh": plain}), camera, options=replace(field.policy, stop=1e-4)
    )
    found: Array = 2 * limit * (picture.color[..., 0] - 0.5 * picture.opacity)
    return found


def with_arrows(
    gradient: PhotographGradient, field: SurfaceField, picture: Picture, camera: Camera
) -> FloatArray:
    """A paled picture (H, W, 3) of a mesh, with arrows at the vertices that it shows.

    Args:
        gradient: of the mesh.
        field: the mesh.
        picture: of it, by the camera.
        camera: in the frame of the field.
    """
    starts, ends, outward = arrows(field, gradient.groups["vertices"])
    pale = Image.fromarray(np.rint(255 * (0.55 + 0.45 * picture.color)).astype(np.uint8))
    from photograd_course.viz import style

    drawing = ImageDraw.Draw(pale)
    (tail, depth), (head, ahead) = camera.project(starts), camera.project(ends)
    for k in np.flatnonzero((depth > 0) & (ahead > 0))[::-1]:  # the strongest on top
        column, row = tail[k].astype(np.int64)
        inside = 0 <= row < camera.height and 0 <= column < camera.width
        if not inside or depth[k] > (1 + BEHIND) * picture.depth[row, column]:
            continue  # hidden; not where nothing is: NaN
        color = style.BLUE if outward[k] else style.ORANGE
        drawing.line([*tail[k], *head[k]], fill=color, width=2)
        along = head[k] - tail[k]
        wing = np.array([-along[1], along[0]])
        corners = (head[k], *(head[k] - 0.3 * along + side * 0.18 * wing for side in (1, -1)))
        drawing.polygon([tuple(corner.tolist()) for corner in corners], fill=color)
    return np.asarray(pale, np.float64) / 255


def arrows(
    field: SurfaceField, d_vertices: FloatArray
) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
    """Starts and ends (N, 3) of arrows downhill, the strongest first, and which go outward (N,).

    The 98 % quantile of their lengths is a fixed share of the mesh, the longest half more.

    Args:
        field: the mesh.
        d_vertices: (V, 3) dL/dx.
    """
    strength = np.sqrt(np.square(d_vertices).sum(axis=1))
    rows = np.argsort(-strength, kind="stable")[:ARROWS]
    rows = rows[strength[rows] > 0]
    longest = LONGEST * float(np.linalg.norm(field.box[1] - field.box[0]))
    vertices = field.vertices
    if not len(rows):
        return vertices[rows], vertices[rows], np.zeros(0, bool)
    scale = longest / float(np.quantile(strength[rows], 0.98))
    length = strength[rows] * scale
    way = -d_vertices[rows] * (scale * np.minimum(1, 1.5 * longest / length))[:, None]
    outward = (way * vertex_normals(vertices, field.faces)[rows]).sum(axis=1) > 0
    return vertices[rows], vertices[rows] + way, outward


def projected(
    gradient: PhotographGradient, picture: Picture, camera: Camera, field: Fittable
) -> tuple[Array, NDArray[np.bool_]]:
    """Values (H, W) of a photograph's pixels on what a camera sees, and what it does not show.

    Args:
        gradient: of the photograph.
        picture: what the camera sees.
        camera: in the frame of the field.
        field: says whether depths lie along rays or along the axis of the camera.
    """
    assert gradient.depth is not None
    along_ray = "rays" in field.capabilities
    origins, directions = camera.rays()
    depth = picture.depth.reshape(-1, 1).astype(np.float64)
    if not along_ray:
        depth = depth / (directions @ camera.forward)[:, None]
    far = 1e3 * float(np.linalg.norm(field.box[1] - field.box[0]))
    points = origins + np.where(np.isnan(depth), far, depth) * directions
    pixel, ahead = gradient.camera.project(points)
    distance = np.linalg.norm(points - gradient.camera.position, axis=1) if along_ray else ahead
    values = np.zeros(len(points))
    with np.errstate(invalid="ignore"):
        inside = np.asarray(
            (pixel >= 0).all(axis=1) & (pixel < gradient.values.shape[::-1]).all(axis=1)
        )
    column, row = pixel[inside].astype(np.int64).T
    surface = gradient.depth[row, column]
    hidden = distance[inside] > (1 + BEHIND) * surface  # not where nothing is: NaN
    values[inside] = np.where(hidden, 0.0, gradient.values[row, column])
    missing: NDArray[np.bool_] = np.logical_not(inside)
    missing[inside] = hidden
    size = camera.height, camera.width
    return values.reshape(size), missing.reshape(size)


def scale_bar() -> Any:
    """(16, 256, 3) bytes: the colors from -limit to limit."""
    row = np.linspace(-1.0, 1.0, 256)
    colors = signed_colors(np.tile(row, (16, 1)), 1.0, np.zeros((16, 256), bool))
    return np.floor(255 * colors + 0.5).astype(np.uint8)
