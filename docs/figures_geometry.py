"""Geometry that is written to be read: `python docs/figures_geometry.py` writes the picture.

Boxes of a hierarchy and what rays cost in it; triangles painted in a wrong and in the right order;
what an octree drops; a mesh in three levels; a signed distance function, and which way its hits
move when one of its numbers grows.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.geometry import (
    Body,
    BspTree,
    CullingTree,
    Frustum,
    LevelsOfDetail,
    ReferenceBvh,
    SdfHits,
    draw_body,
)
from photograd.geometry.mesh import Mesh
from photograd.geometry.sdf import (
    Shape,
    box,
    difference,
    placed,
    plane,
    smooth_union,
    sphere,
    torus,
    union,
)
from photograd.scenes.shapes import torus as torus_mesh
from photograd.transport.builtin import camera_at
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).resolve().parent / "images"
SIDE, GAP, LEFT = 2.1, 0.18, 0.15


def knot(rows: int = 40, columns: int = 96) -> Mesh:
    """A ring whose tube swells."""
    ring = torus_mesh(1.0, 0.36, rows=rows, columns=columns)
    angle = np.arctan2(ring.vertices[:, 0], ring.vertices[:, 2])
    swell = 1.0 + 0.18 * np.sin(5 * angle)
    return Mesh(ring.vertices * np.column_stack([swell, np.ones_like(swell), swell]), ring.faces)


def draw_boxes(axes: Axes, mesh: Mesh) -> None:
    """Nodes of three levels, seen from above."""
    bvh = ReferenceBvh(mesh)
    corners = mesh.vertices[mesh.faces][:, :, [0, 2]]
    axes.add_collection(PolyCollection(corners, facecolors="#dfe6ee", edgecolors="none"))
    for depth, color, width in ((2, style.INK, 1.6), (4, style.BLUE, 1.0), (7, style.GRAY, 0.4)):
        boxes = bvh.boxes[bvh.depth == depth][:, :, [0, 2]]
        patches = [Rectangle(tuple(lo), *(hi - lo)) for lo, hi in boxes]
        axes.add_collection(
            PatchCollection(patches, facecolors="none", edgecolors=color, linewidths=width)
        )
    axes.set(xlim=(-1.75, 1.75), ylim=(-1.75, 1.75), aspect="equal")
    axes.set_title("boxes of levels 2, 4 and 7")


def draw_cost(axes: Axes, mesh: Mesh, size: int = 180) -> None:
    """Tests a ray."""
    camera = camera_at([0.0, 3.2, 3.6], [0.0, 0.0, 0.0], 40.0, size, size)
    found = ReferenceBvh(mesh).trace(*camera.rays())
    tests = (found.boxes + found.triangles).reshape(size, size)
    axes.imshow(tests, cmap="viridis")
    axes.set_title(f"tests a ray: {tests.min()} to {tests.max()} of {len(mesh.faces):,}")


def bars() -> Array:
    """Three bars (6, 3, 3) as triangles, each over the next."""
    corners = []
    for angle in 2 * np.pi / 3 * np.arange(3):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        bar = np.array([[-1.1, 0.15, -0.3], [1.1, 0.15, 0.3], [1.1, 0.55, 0.3], [-1.1, 0.55, -0.3]])
        a, b, d, e = bar @ turn.T
        corners += [[a, b, d], [a, d, e]]
    return np.array(corners)


def paint(axes: Axes, polygons: list[Array], face: Array, title: str) -> None:
    """Polygons over each other, in the order of the list; seen from +Z."""
    colors = np.array([style.BLUE, style.GRAY, style.ORANGE])[face // 2]
    axes.add_collection(
        PolyCollection(
            [p[:, :2] for p in polygons], facecolors=colors, edgecolors=style.INK, linewidths=0.5
        )
    )
    axes.set(xlim=(-1.35, 1.35), ylim=(-1.35, 1.35), aspect="equal")
    axes.set_title(title)


def draw_orders(wrong: Axes, right: Axes) -> None:
    """Sorted by the distance of their middles, and by the tree."""
    whole, eye = bars(), np.array([0.0, 0.0, 6.0])
    order = np.argsort(-np.linalg.norm(whole.mean(axis=1) - eye, axis=1), kind="stable")
    paint(wrong, list(whole[order]), order, "whole triangles, by distance")
    tree = BspTree(Mesh(whole.reshape(-1, 3), np.arange(18).reshape(-1, 3)))
    order = tree.back_to_front([eye])[0]
    polygons = tree.polygons()
    paint(right, [polygons[p] for p in order], tree.face[order], f"{len(polygons)} pieces of a BSP")


def draw_culling(axes: Axes) -> None:
    """Objects from above, the cells that the camera's view reaches."""
    g = np.random.default_rng(3)
    center = g.uniform(-10, 10, (220, 3)) * [1, 0.1, 1]
    half = 0.08 + 0.7 * g.random((220, 1)) ** 4
    boxes = np.stack([center - half, center + half], axis=1)
    camera = camera_at([-8.0, 0.0, 8.0], [2.0, 0.0, -1.0], 40.0, 64, 64)
    frustum = Frustum.of_camera(camera, 0.1, 14.0)
    tree = CullingTree(boxes, max_depth=4)
    culled = tree.cull(frustum)
    for chosen, color, edge, width in (
        (tree.node_boxes[frustum.misses(tree.node_boxes)], "none", style.GUIDE, 0.4),
        (tree.node_boxes[~frustum.misses(tree.node_boxes)], "none", style.BLUE, 0.7),
        (boxes[~culled.visible], "#b8b8b8", "none", 0.0),
        (boxes[culled.visible], style.BLUE, "none", 0.0),
    ):
        patches = [Rectangle((lo[0], lo[2]), *(hi - lo)[[0, 2]]) for lo, hi in chosen]
        axes.add_collection(
            PatchCollection(patches, facecolors=color, edgecolors=edge, linewidths=width)
        )
    far = camera.position + 14.0 * np.array(
        [
            camera.forward + side * np.tan(np.radians(20)) * camera.world_from_camera[:3, 0]
            for side in (-1, 1)
        ]
    )
    view = np.array([camera.position, *far])[:, [0, 2]]
    axes.add_collection(PolyCollection([view], facecolors="none", edgecolors=style.INK))
    axes.set(xlim=(-11, 11), ylim=(11, -11), aspect="equal")
    kept, tests = int(culled.visible.sum()), culled.tested
    axes.set_title(f"{kept} of {len(boxes)} kept after {tests} tests")


def shaded(mesh: Mesh, camera: Camera) -> Array:
    """(H, W) light from beside the camera on flat triangles; NaN beside the mesh."""
    origins, directions = camera.rays()
    found = ReferenceBvh(mesh).trace(origins, directions)
    a, b, c = mesh.vertices.astype(np.float64)[mesh.faces[found.primitive]].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    light = 0.15 + 0.85 * (normal @ [0.48, 0.6, 0.64]).clip(0)
    return np.where(found.hit, light, np.nan).reshape(camera.height, camera.width)


def draw_levels(axes: Axes, mesh: Mesh) -> None:
    """Three levels, the coarser ones where they are seen smaller."""
    detail = LevelsOfDetail(mesh, [0.12, 0.25])
    parts = []
    for level, size in zip(detail.levels, (120, 60, 60), strict=True):
        camera = camera_at([0.0, 3.2, 3.6], [0.0, 0.0, 0.0], 40.0, size, size)
        parts.append((shaded(level.mesh, camera), len(level.mesh.faces)))
    canvas = np.full((180, 180), np.nan)
    canvas[5:125, 30:150] = parts[0][0]
    canvas[115:175, 20:80], canvas[115:175, 100:160] = parts[1][0], parts[2][0]
    axes.imshow(canvas, cmap="gray", vmin=0, vmax=1)
    axes.set_title(" / ".join(f"{n:,}" for _, n in parts) + " triangles")


def sculpture() -> Shape:
    """A ring grown together with a block that a ball was cut from, on a floor."""
    ring = placed(torus(0.62, 0.2), [0.0, 0.72, 0.0], [0.9, 0.5, 0.0, 0.25])
    block = difference(box([0.55, 0.3, 0.4]), placed(sphere(0.38), [0.3, 0.3, 0.35]))
    return union(
        smooth_union(ring, placed(block, [0.0, 0.3, 0.0]), 0.35), plane([0.0, 1.0, 0.0], 0.0)
    )


def draw_bodies(picture: Axes, change: Axes, size: int = 200) -> None:
    """The body, and the derivative of the distance along each ray by the width of its seam."""
    body = Body(sculpture())
    camera = camera_at([1.6, 2.2, 3.2], [0.0, 0.55, 0.0], 38.0, size, size)
    drawn = draw_body(body, camera, albedo=[0.75, 0.68, 0.55], sky=0.4)
    picture.imshow(srgb_encode(np.clip(drawn.radiance, 0, 1)))
    picture.set_title(f"a body: {drawn.steps.mean():.0f} steps a ray")
    origins, directions = camera.rays()
    hits = body.trace(origins, directions, t_max=100.0)
    width = next(i for i, name in enumerate(body.names) if "width" in name)
    slope = np.zeros(size * size)
    for ray in np.flatnonzero(hits.hit):  # the adjoint sums over rays: one at a time, here
        one = slice(ray, ray + 1)
        found = SdfHits(hits.t[one], hits.steps[one], hits.end[one], hits.march)
        d_numbers, _, _ = body.trace_backward(origins[one], directions[one], found, np.ones(1))
        slope[ray] = d_numbers[width]
    limit = float(np.quantile(np.abs(slope), 0.995))
    change.imshow(
        slope.reshape(size, size), cmap=style.signed_color_map(), norm=style.symmetric_scale(limit)
    )
    change.set_title("change with the seam's width")


def geometry_figure() -> Figure:
    """Two rows of four."""
    mesh = knot()
    with style.house_style():
        figure = style.new_figure(4 * SIDE + 3 * GAP + 2 * LEFT, 2 * SIDE + 1.5)
        grid = [
            style.place_axes(
                figure, LEFT + (k % 4) * (SIDE + GAP), 0.35 + (k // 4) * (SIDE + 0.4), SIDE, SIDE
            )
            for k in range(8)
        ]
        draw_boxes(grid[0], mesh)
        draw_cost(grid[1], mesh)
        draw_orders(grid[2], grid[3])
        draw_culling(grid[4])
        draw_levels(grid[5], mesh)
        draw_bodies(grid[6], grid[7])
        for axes in grid:
            axes.set(xticks=[], yticks=[])
        style.write_caption(
            figure,
            "A hierarchy of boxes spares a ray nearly all triangles. Bars that overlap in a circle "
            "have no order until they are cut. An octree drops whole cells (thin lines) that lie "
            "beside the view. Far away, fewer triangles do. A signed distance function has a "
            "derivative at every hit: where the seam is wider, the surface comes nearer (blue).",
            left=LEFT,
            right=LEFT,
        )
    return figure


if __name__ == "__main__":
    save_figure(geometry_figure(), IMAGES / "geometry.png")
