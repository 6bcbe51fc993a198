"""`photograd bake-ao`: ambient occlusion of a mesh as a texture."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from photograd_course.cli import DebugOption, JsonOption, Progress, SeedOption, ThreadsOption, emit
from photograd_course.cli import note as say

from photograd._signals import StopRequest, stop_on_signals
from photograd.commands.shared import RadiusOption, hold_output, out_option, use_threads
from photograd.commands.trace import SceneArgument, load_scene
from photograd.errors import SceneError, message
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.write import write_png, write_radiance
from photograd.transport.occlusion_map import OcclusionBake
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape

PASS_SPP = 16
ShapeOption = Annotated[
    str, typer.Option("--shape", help="The mesh; may be left out if one alone has coordinates.")
]
OutOption = Annotated[
    Path, out_option("The texture: .exr, .hdr or .pfm, with a .png beside it, or .png alone.")
]
TexelsOption = Annotated[
    int, typer.Option("--texels", min=1, max=1 << 14, help="Along each edge of the texture.")
]
SppOption = Annotated[int, typer.Option("--spp", min=1, help="Rays a texel.")]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("bake-ao")(bake_ao)


def bake_ao(
    context: typer.Context,
    scene: SceneArgument,
    shape: ShapeOption = "",
    out: OutOption = Path("occlusion.exr"),
    texels: TexelsOption = 512,
    spp: SppOption = 256,
    radius: RadiusOption = math.inf,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Bake how much of the sky each texel of a mesh sees.

    The texture is linear (1 is open, 0 is blocked), in the mesh's own texture coordinates, which
    must lie in 0..1 and unfold it without overlap. Around what it covers it goes on, so that
    lookups between texels see nothing else. It is for renderers that cast no shadows of a sky: a
    path tracer finds them itself.

    Example: photograd bake-ao chair.glb --shape seat --texels 1024 --radius 0.5 --out seat_ao.exr
    """
    use_threads(threads)
    hold_output(context, "bake-ao", out, beside=[out.with_suffix(".png")])
    described, _ = load_scene(scene, 16)
    bake = OcclusionBake(
        described, shape or _only_mesh(described), texels, radius=radius, seed=seed
    )
    began = time.monotonic()
    with stop_on_signals() as stopping:
        _run(bake, spp, stopping)
    seconds = time.monotonic() - began
    if bake.count:
        values = np.repeat(bake.texture().values, 3, axis=2)
        if out.suffix.lower() in LINEAR_SUFFIXES:
            write_radiance(out, values)
        write_png(out.with_suffix(".png"), values)
        covered = bake.points.covered
        open_sky = float(values[covered].mean(dtype=np.float64))
        result = {
            "out": out,
            "texels": texels,
            "covered": f"{100 * covered.mean():.1f} %",
            "mean": round(open_sky, 4),
            "spp": bake.count,
            "seconds": round(seconds, 3),
            "bytes": out.stat().st_size,
        }
        emit(result, as_json=as_json, title="bake-ao")
    if bake.count < spp:
        say(f"stopped at {bake.count} of {spp} samples")
        raise typer.Exit(stopping.exit_code or 1)


def _run(bake: OcclusionBake, spp: int, stopping: StopRequest) -> None:
    with Progress("bake-ao", spp, []) as bar:
        while bake.count < spp and not stopping():
            bake.add_samples(min(PASS_SPP, spp - bake.count))
            bar.update(bake.count)


def _only_mesh(scene: Scene) -> str:
    named = [s.name for s in scene.shapes if isinstance(s, MeshShape) and s.uv is not None]
    if len(named) == 1:
        return named[0]
    found = ", ".join(named[:8]) + (", ..." if len(named) > 8 else "")
    expected, remedy = "a mesh with texture coordinates", "name one of them"
    raise SceneError(message("bake-ao", "--shape", expected, found or "no such mesh", remedy))
