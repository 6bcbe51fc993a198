"""How pictures change when triangles move: `python docs/figures_raster.py` writes raster.png.

A point sample and the coverage of a pixel under a moving edge; the gradient of a mesh at each of
its vertices, through silhouettes and through shading; one derivative by five methods.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    antialias,
    antialias_backward,
    edge_gradient,
    find_crossings,
    interpolate,
    interpolate_backward,
    polygon_coverage,
    polygon_coverage_backward,
    project,
    rasterize,
    rasterize_backward,
    sample_edges,
    soft_silhouette_backward,
)
from photograd.scenes.shapes import sphere
from photograd.transport.builtin import camera_at
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "raster.png"
PANEL, GAP, LEFT = 2.3, 0.15, 0.55  # inches
SIDE = 48  # pixels of the sphere's picture
SMALL, LARGE = 0.8, 1.0  # radius now, and in the target
TRIANGLE = np.array([[2.3, 1.8], [7.6, 3.1], [4.2, 7.4]])
RAMP = np.tile(np.linspace(-1.0, 1.0, 11), (10, 1))
SIGMA = 1.0  # square pixels, of the soft rasterizer


def moving_edge(shifts: Array) -> dict[str, Array]:
    """A pixel that is covered left of x = shift: its center's sample, its coverage, derivatives."""
    area, d_area = [], []
    for shift in shifts:
        points = np.array([[-1.0, -1], [shift, -1], [shift, 2], [-1, 2]])
        area.append(polygon_coverage(points, (1, 1))[0, 0])
        d_area.append(polygon_coverage_backward(points, [[1.0]])[[1, 2], 0].sum())
    sample = (shifts > 0.5).astype(float)
    return {
        "sample": sample,
        "d_sample": np.zeros_like(shifts),
        "coverage": np.array(area),
        "d_coverage": np.array(d_area),
    }


def sphere_gradients(shaded: bool) -> dict[str, Array]:
    """A sphere that is smaller than in the target: dL/d vertex by silhouettes and by shading.

    Args:
        shaded: colors from the positions of the vertices, else one constant color.

    Returns:
        "pixels" (V, 2), "front" (V,) whether a vertex is on the near side, "silhouette" and
        "interior" (V, 2), dL/d(x, y) in pixels, "center" (2,), "picture" (H, W).
    """
    camera = camera_at([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 34.0, SIDE, SIDE)
    mesh = sphere(1.0, rows=8, columns=14)
    unit = mesh.vertices.astype(np.float64)
    faces, edges = mesh.faces, MeshEdges.of(mesh.faces, unit)
    color = 0.6 + 0.35 * unit @ np.array([[0.5], [0.7], [0.5]]) if shaded else 0.8 + 0 * unit[:, :1]

    def draw(radius: float) -> tuple[Array, Array, Any, Any]:
        positions = project(radius * unit, camera)
        visibility = rasterize(positions, faces, (SIDE, SIDE))
        shown = interpolate(color, faces, visibility)
        crossings = find_crossings(positions, faces, visibility, edges)
        return positions, shown, visibility, crossings

    _, target, _, there = draw(LARGE)
    positions, shown, visibility, crossings = draw(SMALL)
    picture = antialias(shown, crossings)
    d = 2 * (picture - antialias(target, there))
    d_color, d_edges = antialias_backward(shown, crossings, d, positions, edges)
    _, d_b = interpolate_backward(color, faces, visibility, d_color)
    d_inside = rasterize_backward(positions, faces, visibility, d_b)
    depth = positions[:, 2:]
    return {
        "pixels": positions[:, :2] / depth,
        "front": positions[:, 2] < 4.0 + 0.1,
        "silhouette": d_edges[:, :2] * depth,
        "interior": d_inside[:, :2] * depth,
        "center": np.array([camera.cx, camera.cy]),
        "picture": picture[..., 0],
    }


def translation() -> dict[str, float]:
    """d(sum of RAMP times coverage)/dx of a triangle of 14 pixels, by five methods."""
    faces, size = np.array([[0, 1, 2]]), RAMP.shape
    positions, edges = np.insert(TRIANGLE, 2, 1.0, axis=1), MeshEdges.of(faces)
    visibility = rasterize(positions, faces, size)
    white, d = np.ones((3, 1)), RAMP[..., None]
    shown = interpolate(white, faces, visibility)
    _, d_b = interpolate_backward(white, faces, visibility, d)
    crossings = find_crossings(positions, faces, visibility, edges)
    lookup = FaceLookup(positions, faces, size)

    def shade(points: Array) -> Array:
        return (lookup.nearest(points)[0] >= 0)[:, None].astype(float)

    samples = sample_edges(positions, edges, size, per_pixel=64.0)
    found = {
        "interior": rasterize_backward(positions, faces, visibility, d_b),
        "antialias": antialias_backward(shown, crossings, d, positions, edges)[1],
        "edge sampling": edge_gradient(positions, edges, samples, shade, d),
        "soft": soft_silhouette_backward(positions, faces, RAMP, SIGMA),
        "exact": polygon_coverage_backward(TRIANGLE, RAMP),
    }
    return {name: float(each[:, 0].sum()) for name, each in found.items()}


def draw_edge(values: Axes, slopes: Axes) -> None:
    """Values and derivatives over the shift; the jump of the sample is not a derivative."""
    shifts = np.linspace(0.0025, 0.9975, 200)
    found = moving_edge(shifts)
    for axes, prefix in ((values, ""), (slopes, "d_")):
        axes.plot(shifts, found[f"{prefix}coverage"], color=style.BLUE, label="coverage")
        axes.plot(shifts, found[f"{prefix}sample"], color=style.ORANGE, label="sample")
        axes.set(xlim=(0, 1), ylim=(-0.1, 1.15), xlabel="edge at x, pixels")
        style.plain_axes(axes)
    values.legend(loc="upper left")
    values.set_title("a pixel under a moving edge")
    slopes.set_title("its derivative with respect to x")


def longest(found: dict[str, Array], term: str) -> float:
    """Length of the longest gradient on the near side."""
    return float(np.sqrt(np.square(found[term][found["front"]]).sum(axis=1)).max())


def draw_arrows(axes: Axes, found: dict[str, Array], term: str, title: str) -> None:
    """-dL/d vertex as arrows, the longest of 7 pixels; red outward, blue inward, on one scale."""
    axes.imshow(found["picture"], cmap="gray_r", vmin=0.0, vmax=3.0, extent=(0, SIDE, SIDE, 0))
    towards, at = -found[term], found["pixels"]
    outward = (towards * (at - found["center"])).sum(axis=1)
    chosen = found["front"] & (np.abs(towards).max(axis=1) > 1e-9)
    axes.quiver(
        *at[chosen].T,
        *towards[chosen].T,
        outward[chosen],
        cmap=style.signed_color_map(),
        norm=style.symmetric_scale(0.5 * float(np.abs(outward).max())),
        angles="xy",
        scale_units="xy",
        scale=longest(found, term) / 7,
        width=0.012,
    )
    axes.set(xlim=(0, SIDE), ylim=(SIDE, 0), xticks=[], yticks=[])
    axes.set_title(title)


def draw_bars(axes: Axes) -> None:
    """One derivative by five methods, with numbers."""
    found = translation()
    names, heights = list(found), list(found.values())
    colors = [style.GRAY, style.BLUE, style.BLUE, style.ORANGE, style.INK]
    axes.barh(names, heights, color=colors)
    for row, height in enumerate(heights):
        axes.text(height + 0.06, row, f"{height:.3f}", va="center", fontsize=style.SMALL_SIZE)
    axes.set(xlim=(0, 1.25 * max(heights)))
    axes.invert_yaxis()
    axes.set_title("d/dx of a triangle")
    style.plain_axes(axes)
    axes.set_axisbelow(True)


def raster_figure() -> Figure:
    """Two rows: the moving edge and the bars; the sphere's arrows."""
    plain, shaded = sphere_gradients(shaded=False), sphere_gradients(shaded=True)
    top, middle = 0.35, PANEL + 1.0
    step = PANEL + GAP + 0.5
    with style.house_style():
        figure = style.new_figure(LEFT + 3 * step - 0.2, 2 * PANEL + 2.0)
        edge = [style.place_axes(figure, LEFT + k * step, top, PANEL, PANEL) for k in range(2)]
        draw_edge(*edge)
        draw_bars(style.place_axes(figure, LEFT + 2 * step + 0.45, top, PANEL - 0.45, PANEL))
        ratio = longest(shaded, "silhouette") / longest(shaded, "interior")
        panels = [
            (plain, "silhouette", "constant color: silhouettes"),
            (shaded, "silhouette", "shaded: silhouettes"),
            (shaded, "interior", f"inside of faces, arrows x {ratio:.0f}"),
        ]
        for k, (found, term, title) in enumerate(panels):
            axes = style.place_axes(figure, LEFT + k * step, middle, PANEL, PANEL)
            draw_arrows(axes, found, term, title)
        style.write_caption(
            figure,
            "Above: the sample at the center of a pixel jumps, and its derivative is 0 wherever it "
            "has one; the area that is covered has a derivative. So a sum of samples tells nothing "
            "of a triangle that moves over a picture whose weight grows to the right; antialiasing "
            f"and edge sampling come near the exact number, a soft rasterizer (sigma {SIGMA:g} "
            "square pixels) is off. Below, shown as negatives: a sphere that should be larger. "
            "Arrows show where lower loss would take each vertex on the near side, red outward, "
            "blue inward. With one constant color, all of it comes from silhouettes.",
            left=LEFT,
            right=0.2,
        )
    return figure


if __name__ == "__main__":
    PICTURE.parent.mkdir(exist_ok=True)
    save_figure(raster_figure(), PICTURE)
