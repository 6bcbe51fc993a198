"""Simplifies and recovers meshes, and writes docs/rasterizer.md: `python docs/results_meshes.py`.

With DATA, a folder with stanford-bunny.obj, the real mesh is simplified too; its rows stay as they
are otherwise. `--picture` draws docs/images/simplified.png, `--only` measures one table.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.capture.capture import Capture
from photograd.capture.orbit import spiral_cameras
from photograd.capture.view import View
from photograd.fields import MeshSurface, TexturedSurface
from photograd.fields.layered_picture import Unwrapped
from photograd.fields.lit_surface import lit
from photograd.fields.surface import SurfaceField
from photograd.fitting import Fit, Model, options_for
from photograd.fitting.drawing import display_field
from photograd.fitting.evaluate import evaluate, render_camera
from photograd.fitting.simplify import SimplifiedMesh, SimplifyOptions, simplify
from photograd.geometry import nearest_on_mesh
from photograd.geometry.icosphere import icosphere
from photograd.geometry.octahedron import unwrapped_sphere
from photograd.raster import interpolate, rasterize
from photograd.transport.mesh_files import read_mesh_surface
from photograd_course.color import unpremultiply
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
ROOT = Path(__file__).resolve().parent
PAGE, PICTURE = ROOT / "rasterizer.md", ROOT / "images" / "simplified.png"
BALL, BUNNY, RECOVERED, TEXTURED = "ball with waves", "bunny", "recovered", "textured"
MATTES, FEW = "mattes", 300
NUMBERS = {BALL: (200, 500), BUNNY: (500, 1000, 2000)}
VIEWS, HELD_OUT, SIZE, STEPS, DIVISIONS = 60, 8, 96, 1000, 12
TEXTURE, TEXTURE_STEPS = 152, 600  # texels along an edge: 2,888 triangles
SAMPLES = 4000  # points on each mesh, for the Chamfer distance
HEADS = ("| mesh |", "| state", "| scene", "| ---")
PANEL, GAP = 1.9, 0.08  # inches


def ball(divisions: int = 24) -> MeshSurface:
    """A unit ball with three waves on it, the colors of its vertices others at each side."""
    mesh = icosphere(divisions)
    directions = mesh.vertices.astype(np.float64)
    radius, (x, y, z) = waves(directions), directions.T
    logits = 2 * np.stack([np.sin(3 * x), np.cos(4 * y + z), np.sin(3 * z - y)], axis=-1)
    return MeshSurface.of_mesh(radius[:, None] * mesh.vertices, mesh.faces, logits, smoothness=0.0)


def simplified(name: str, dense: MeshSurface) -> Iterator[tuple[str, SimplifiedMesh]]:
    """A row of the table for each number of triangles."""
    for triangles in NUMBERS[name]:
        began = time.perf_counter()
        found = simplify(dense, SimplifyOptions(triangles))
        seconds = time.perf_counter() - began
        before, after, left = found.before, found.after, len(found.surface.faces)
        yield (
            (
                f"| {name} | {len(dense.faces):,} | {left:,} | {before.psnr:.2f} "
                f"| {after.psnr:.2f} | {before.iou:.4f} | {after.iou:.4f} | {seconds:.0f} |"
            ),
            found,
        )


def photographed(model: Model, cameras: list[Any], first: int) -> tuple[View, ...]:
    """Views of a model, with alpha."""
    views = []
    for number, camera in enumerate(cameras):
        color, opacity, _ = render_camera(model, camera)
        straight = np.clip(unpremultiply(color, opacity), 0, 1)
        image = np.concatenate([straight, opacity[..., None]], axis=-1).astype(np.float32)
        views.append(View(f"view_{first + number}", camera, image))
    return tuple(views)


def samples(surface: SurfaceField) -> Array:
    """(N, 3) points on a mesh, evenly by area."""
    corners = surface.vertices[surface.faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(cross, axis=1)
    g = np.random.default_rng(5)
    face = g.choice(len(area), SAMPLES, p=area / area.sum())
    u, v = np.sqrt(g.random(SAMPLES)), g.random(SAMPLES)
    weights = np.stack([1 - u, u * (1 - v), u * v], axis=-1)
    found: Array = np.einsum("nk,nkc->nc", weights, corners[face])
    return found


def chamfer(a: SurfaceField, b: SurfaceField) -> float:
    """Mean distance of points on each of two meshes from the other mesh, millimeters."""
    there = nearest_on_mesh(samples(a), b.mesh)[0].mean()
    back = nearest_on_mesh(samples(b), a.mesh)[0].mean()
    return 1000 * float(there + back) / 2


def waves(directions: Array) -> Array:
    """(N,) radius of the ball in unit directions (N, 3)."""
    x, y, z = directions.T
    radius: Array = 0.5 + 0.1 * np.sin(4 * x + 1) * np.cos(3 * y) + 0.08 * np.sin(5 * z)
    return radius


def painted(*, opacity: bool, size: int = 256) -> TexturedSurface:
    """The ball with a pattern finer than its triangles; with `opacity`, with bands cut out."""
    sphere, uv, corners, vertex = unwrapped_sphere(16)
    flat = np.concatenate([size * uv, np.ones((len(uv), 1))], axis=1)
    towards = interpolate(sphere[vertex], corners, rasterize(flat, corners, (size, size)))
    x, y, z = np.moveaxis(towards / np.linalg.norm(towards, axis=2, keepdims=True), 2, 0)
    texels = [
        2 * np.sin(3 * x) + 2 * np.sin(30 * x) * np.sin(30 * y),
        2 * np.cos(4 * y + z) + 2 * np.sin(28 * z) * np.sin(24 * x),
        2 * np.sin(3 * z - y) + 2 * np.sin(32 * y),
    ]
    if opacity:
        texels.append(2 + 6 * np.sin(9 * y + 2 * np.sin(3 * x)))
    unwrapped = Unwrapped(uv, corners, vertex)
    mesh = waves(sphere)[:, None] * sphere
    return TexturedSurface.of_mesh(mesh, unwrapped, np.stack(texels, -1), smoothness=0.0)


def textured_recovery() -> list[str]:
    """The painted balls from 60 views, by what a fit recovers: rows of end states."""
    rows = []
    opaque = {"resolution": TEXTURE}
    for scene, truth, kinds in (
        (
            "painted",
            painted(opacity=False),
            (("mesh", {"resolution": DIVISIONS}), ("textured_surface", opaque)),
        ),
        (
            "with bands cut out",
            painted(opacity=True),
            (("textured_surface", opaque), ("textured_surface", {**opaque, "opacity": True})),
        ),
    ):
        capture = photographs(truth)
        for kind, changes in kinds:
            options = options_for(kind, steps=TEXTURE_STEPS, seed=1, **changes)
            job = Fit.start(capture, options)
            start = evaluate(Model.of(job.model), capture.test).psnr
            began = chamfer(job.model, truth)  # type: ignore[arg-type]
            while job.step_number < options.steps:
                job.step()
            field: Any = job.model
            end = evaluate(Model.of(field), capture.test).psnr
            label = f"`{kind}`" + (" with opacity" if options.opacity else "")
            rows.append(
                f"| {scene} | {label} | {len(field.faces):,} | {began:.1f} "
                f"| {chamfer(field, truth):.1f} | {start:.2f} | {end:.2f} |"
            )
            print(rows[-1], flush=True)  # noqa: T201
    return rows


def photographs(truth: SurfaceField) -> Capture:
    """60 training views all around, and 8 that are held out."""
    box = truth.box + np.array([[-0.15], [0.15]])
    train = spiral_cameras(box, VIEWS, size=SIZE)
    held_out = spiral_cameras(box, HELD_OUT, size=SIZE, turn=90.0)
    model = Model.of(truth)
    return Capture(
        photographed(model, train, 0),
        photographed(model, held_out, VIEWS),
        "memory",
        Path("memory"),
        "display",
        True,
        bounds=box,
    )


def recovery() -> list[str]:
    """The ball from 60 views: rows of start and end."""
    truth = ball(16)
    capture = photographs(truth)
    job = Fit.start(capture, options_for("mesh", resolution=DIVISIONS, steps=STEPS, seed=1))
    rows = []
    for label in ("start, an ellipsoid", f"end, {STEPS} steps"):
        field: Any = job.model
        psnr = evaluate(Model.of(field), capture.test).psnr
        distance = chamfer(field, truth)
        rows.append(f"| {label} | {len(field.faces):,} | {distance:.1f} | {psnr:.2f} |")
        while job.step_number < STEPS:
            job.step()
    return rows


def mattes() -> list[str]:
    """The painted balls as few triangles: rows by what the simple mesh has."""
    rows = []
    for scene, dense, kinds in (
        ("painted", painted(opacity=False), ({}, {"texture": 128})),
        (
            "with bands cut out",
            painted(opacity=True),
            ({"texture": 128}, {"texture": 128, "opacity": True}),
        ),
    ):
        for more in kinds:
            changes: dict[str, Any] = dict(more)
            found = simplify(dense, SimplifyOptions(FEW, **changes))
            label = "texture and opacity" if "opacity" in more else "texture"
            label = label if more else "vertex colors"
            before, after, left = found.before, found.after, len(found.surface.faces)
            rows.append(
                f"| {scene} | {label} | {len(dense.faces):,} | {left:,} | {before.psnr:.2f} "
                f"| {after.psnr:.2f} | {before.iou:.4f} | {after.iou:.4f} |"
            )
            print(rows[-1], flush=True)  # noqa: T201
    return rows


def picture(dense: MeshSurface, found: SimplifiedMesh) -> Figure:
    """Mesh, decimation and result from one camera."""
    camera = spiral_cameras(dense.box, 12, size=320, turn=90.0)[6]
    faces = len(found.surface.faces)
    panels = (
        (dense, f"{len(dense.faces):,} triangles"),
        (found.start, f"decimation, {faces:,}"),
        (found.surface, f"optimized, {faces:,}"),
    )
    with style.house_style():
        figure = style.new_figure(3 * (PANEL + GAP) + GAP, PANEL + 0.45)
        for k, (surface, title) in enumerate(panels):
            axes = style.place_axes(figure, GAP + k * (PANEL + GAP), 0.35, PANEL, PANEL)
            axes.imshow(np.clip(display_field(surface, None, camera), 0, 1))
            axes.set(xticks=[], yticks=[], title=title)
    return figure


def replace_rows(marker: str, rows: list[str]) -> None:
    """Write rows of a table between <!-- marker --> and <!-- end of marker -->."""
    text = PAGE.read_text()
    begin, end = f"<!-- {marker} -->\n", f"<!-- end of {marker} -->"
    head, rest = text.split(begin, 1)
    table, tail = rest.split(end, 1)
    kept = [line for line in table.splitlines() if line.startswith(HEADS)]
    old = [line for line in table.splitlines() if line.startswith("| ") and line not in kept]
    names = {row.split("|")[1] for row in rows}
    if marker == "simplified":
        rows += [line for line in old if line.split("|")[1] not in names]
        rows.sort(key=lambda row: (row.split("|")[1], int(row.split("|")[3].replace(",", ""))))
    PAGE.write_text(head + begin + "\n".join([*kept, *rows]) + "\n" + end + tail)


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, nargs="?")
    parser.add_argument("--picture", action="store_true", help="draw the picture, too")
    parser.add_argument("--only", choices=("simplified", RECOVERED, TEXTURED, MATTES))
    given = parser.parse_args()
    if given.only in (None, "simplified"):
        replace_rows("simplified", simplification(given.data, with_picture=given.picture))
    if given.only in (None, RECOVERED):
        replace_rows(RECOVERED, recovery())
    if given.only in (None, TEXTURED):
        replace_rows(TEXTURED, textured_recovery())
    if given.only in (None, MATTES):
        replace_rows(MATTES, mattes())


def simplification(data: Path | None, *, with_picture: bool) -> list[str]:
    """Rows of all meshes that there are; draws the picture if asked."""
    rows = [row for row, _ in simplified(BALL, ball())]
    if data:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            bunny = lit(read_mesh_surface(data / "stanford-bunny.obj"))
        for row, found in simplified(BUNNY, bunny):
            rows.append(row)
            if with_picture and len(found.surface.faces) == NUMBERS[BUNNY][0]:
                save_figure(picture(bunny, found), PICTURE)
    return rows


if __name__ == "__main__":
    main()
