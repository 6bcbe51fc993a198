"""`photograd simplify`: a mesh of few triangles that looks like a mesh of many."""

from __future__ import annotations

import time
import warnings
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit
from photograd_course.cli import note as say

from photograd._signals import stop_on_signals
from photograd.commands.shared import hold_output, out_option, use_threads
from photograd.errors import RangeError, SceneError
from photograd.fields.lit_surface import lit
from photograd.fields.mesh_surface import MeshSurface
from photograd.fields.surface import SurfaceField
from photograd.fitting.simplify import SimplifyOptions, simplify
from photograd.transport.mesh_files import SUFFIXES, read_mesh_surface, read_textured_surface

DEFAULTS = SimplifyOptions(4)
MeshArgument = Annotated[
    Path, typer.Argument(help=f"A mesh file ({', '.join(SUFFIXES)}).", metavar="MESH")
]
TrianglesOption = Annotated[
    int, typer.Option("--triangles", min=4, help="Most triangles that are left.")
]
OutOption = Annotated[
    Path, out_option("The simple mesh: .glb with its colors or texture, or .npz with all arrays.")
]
ViewsOption = Annotated[
    int, typer.Option("--views", min=2, help="Cameras around the mesh that it is drawn from.")
]
SizeOption = Annotated[int, typer.Option("--size", min=16, help="Pixels along an edge of a view.")]
StepsOption = Annotated[
    int, typer.Option("--steps", min=0, help="Of gradient descent; 0 leaves the decimation.")
]
TextureOption = Annotated[
    int,
    typer.Option(
        "--texture", min=0, help="Texels along an edge of its texture; 0: colors of vertices."
    ),
]
OpacityOption = Annotated[
    bool, typer.Option("--opacity", help="Texels have an opacity, too; needs --texture.")
]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("simplify")(simplify_mesh)


def simplify_mesh(
    context: typer.Context,
    mesh: MeshArgument,
    triangles: TrianglesOption,
    out: OutOption = Path("simple.glb"),
    views: ViewsOption = DEFAULTS.views,
    size: SizeOption = DEFAULTS.size,
    steps: StepsOption = DEFAULTS.steps,
    texture: TextureOption = DEFAULTS.texture,
    opacity: OpacityOption = DEFAULTS.opacity,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Make a mesh of few triangles look like the mesh it comes from.

    A mesh of one shape with a texture shows that; any other is drawn in gray under a light from
    above, and the colors that are written contain the light. A decimation of the mesh is the start;
    its vertices and colors, or texels, then follow the derivative of the pictures, silhouettes
    included (Hasselgren and others, 2021). The report compares decimation and result with the mesh,
    from views that the descent has not seen.

    Needs fast_simplification, and xatlas for --texture: pip install 'photograd[simplify]'. Ctrl-C
    writes what there is.

    Example: photograd simplify bunny.obj --triangles 1000 --out bunny_1000.glb
    """
    use_threads(threads)
    hold_output(context, "simplify", out, MeshSurface.export_suffixes)
    options = SimplifyOptions(
        triangles, views=views, size=size, steps=steps, texture=texture, opacity=opacity, seed=seed
    )
    dense = dense_mesh(mesh)
    began = time.monotonic()
    with stop_on_signals() as stopping:
        found = simplify(dense, options, bar=True, should_stop=stopping)
    for line in found.surface.export(out, None):
        say(f"{out.name}: {line}")
    result = {
        "out": out,
        "triangles": len(found.surface.faces),
        "triangles_before": len(dense.faces),
        "psnr_decimated": round(found.before.psnr, 2),
        "psnr": round(found.after.psnr, 2),
        "iou_decimated": round(found.before.iou, 4),
        "iou": round(found.after.iou, 4),
        "steps": len(found.history),
        "seconds": round(time.monotonic() - began, 3),
    }
    emit(result, as_json=as_json, title="simplify")
    if not found.finished:
        say(f"stopped at step {len(found.history)} of {steps}")
        raise typer.Exit(stopping.exit_code or 1)


def dense_mesh(path: Path) -> SurfaceField:
    """A mesh file with its texture, or gray under a light; what is left out is said on stderr.

    Args:
        path: of the file.

    Raises:
        IoError, RangeError, SceneError: as `read_mesh_surface`.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found: SurfaceField = read_textured_surface(path)
        except (SceneError, RangeError):
            caught.clear()
            found = lit(read_mesh_surface(path))
    for warning in caught:
        say(f"{warning.message}")
    return found
