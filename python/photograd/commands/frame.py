"""`photograd frame`: a picture of a described scene by the passes of a real-time frame."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import typer
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit, note
from photograd_course.color import srgb_encode

from photograd.commands.frame_options import (
    AberrationOption,
    AgainstOption,
    BloomOption,
    CullingOption,
    DetailOption,
    DirectionsOption,
    DitherOption,
    ExposureOption,
    FocusOption,
    FogColorOption,
    FogOption,
    FxaaOption,
    GatherOption,
    OutOption,
    PointsOption,
    PrepassOption,
    ShadingOption,
    ShadowSizeOption,
    ShowOption,
    SkyOption,
    SupersamplingOption,
    ToneOption,
    TransparencyOption,
    VignetteOption,
    options_of,
)
from photograd.commands.shared import DepthOption, SppOption, hold_output, use_threads
from photograd.commands.trace import CameraOption, SceneArgument, SizeOption, load_scene
from photograd.errors import RangeError, message
from photograd.frame.against import Comparison, compare_with_paths
from photograd.frame.detail import SceneDetail
from photograd.frame.graph import FrameResult, PassGraph
from photograd.frame.options import FrameOptions
from photograd.frame.panels import PANELS, panels
from photograd.frame.pipeline import frame_graph
from photograd.frame.scene import KINDS, FrameScene
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.write import write_png, write_radiance
from photograd.transport.scene import Scene
from photograd.types import Array

GRAPH = "graph"


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("frame")(frame)


def frame(
    context: typer.Context,
    scene: SceneArgument,
    out: OutOption = Path("frame.png"),
    size: SizeOption = 512,
    camera: CameraOption = None,
    show: ShowOption = None,
    against: AgainstOption = "",
    spp: SppOption = 256,
    max_depth: DepthOption = 64,
    shading: ShadingOption = "deferred",
    depth_prepass: PrepassOption = False,
    culling: CullingOption = "frustum",
    detail: DetailOption = 0.0,
    sky_visibility: SkyOption = "occlusion",
    surface_points: PointsOption = 16,
    sky_directions: DirectionsOption = 32,
    shadow_size: ShadowSizeOption = 1024,
    gather: GatherOption = 0,
    transparency: TransparencyOption = "peeled",
    fog: FogOption = 0.0,
    fog_color: FogColorOption = "0.5,0.5,0.5",
    supersampling: SupersamplingOption = 1,
    tone_curve: ToneOption = "none",
    exposure: ExposureOption = 0.0,
    bloom: BloomOption = 0.0,
    depth_of_field: FocusOption = 0,
    aberration: AberrationOption = 0.0,
    vignette: VignetteOption = 0.0,
    fxaa: FxaaOption = False,
    dithered: DitherOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,
) -> None:
    """Draw a scene as a real-time engine does: rasterized, lit pass by pass.

    Prints the milliseconds of each pass. With --show, buffers are written beside the picture as
    OUT.BUFFER.png. With --against path, each kind of light is path traced as well, OUT.against.png
    shows frame, truth and five times their difference, and a row tells the root of the mean squared
    difference of displayed colors.

    Example: photograd frame cornell-box --show gbuffer --against path --out frame.png
    """
    options = options_of(locals())
    use_threads(threads)
    if against not in ("", "path"):
        raise RangeError(message("frame", "--against", "'path'", against))
    shown = _shown(show or [])
    others = [*shown, *(["against"] if against else [])]
    beside = [out.with_suffix(f".{name}.png") for name in others]
    hold_output(context, "frame", out, beside=[out.with_suffix(".png"), *beside])
    described, _ = load_scene(scene, size, camera)
    if detail:
        described = SceneDetail(described).at(described.camera, detail)
    graph, result, report = _draw(described, options)
    _write(result, out)
    for name in shown:
        _write_buffer(graph, result, name, out.with_suffix(f".{name}.png"))
    report = {"out": out} | report
    if against:
        rows = compare_with_paths(
            described, options, spp=spp, seed=seed, max_depth=max_depth, report=note
        )
        report |= _written(rows, out)
    emit(report, as_json=as_json, title="frame")


def _draw(scene: Scene, options: FrameOptions) -> tuple[PassGraph, FrameResult, dict[str, Any]]:
    """The passes, their buffers, and what is reported of them."""
    ready = FrameScene(scene)
    if (ready.kind == KINDS.index("glass")).any():
        note("surfaces that light passes through are left out; they cast shadows")
    began = time.monotonic()
    graph = frame_graph(ready, options)
    result = graph.run({"camera": scene.camera})
    seconds = time.monotonic() - began
    report: dict[str, Any] = {"triangles": len(ready.faces)}
    report |= {f"{name} ms": round(spent, 1) for name, spent in result.milliseconds.items()}
    return graph, result, report | {"seconds": round(seconds, 3)}


def _shown(names: list[str]) -> list[str]:
    for name in names:
        if name not in (*PANELS, "all", GRAPH):
            expected = f"all, {GRAPH}, or one of {', '.join(PANELS)}"
            raise RangeError(message("frame", "--show", expected, name))
    every = [*PANELS, GRAPH]
    return every if "all" in names else list(dict.fromkeys(names))


def _write_buffer(graph: PassGraph, result: FrameResult, name: str, path: Path) -> None:
    if name == GRAPH:
        from photograd_course.viz import save_figure

        from photograd.frame.graph_picture import draw_graph

        save_figure(draw_graph(graph, result.milliseconds), path)
    else:
        _write_sheet(path, list(panels(result, name).values()))


def _write(result: FrameResult, out: Path) -> None:
    if out.suffix.lower() in LINEAR_SUFFIXES:
        write_radiance(out, result["radiance"].astype(np.float32))
    display = srgb_encode(np.clip(result["display"], 0.0, 1.0))
    write_png(out.with_suffix(".png"), display.astype(np.float32))


def _written(rows: list[Comparison], out: Path) -> dict[str, Any]:
    """What is reported of comparisons, whose pictures are written."""
    pictures = [picture for row in rows for picture in _beside(row)]
    _write_sheet(out.with_suffix(".against.png"), pictures, columns=3)
    report: dict[str, Any] = {f"{row.technique} rms": round(row.rms, 4) for row in rows}
    return report | {f"{row.technique} noise": f"{100 * row.noise:.1f} %" for row in rows}


def _beside(row: Comparison) -> list[Array]:
    return [row.frame, row.truth, np.clip(5.0 * np.abs(row.frame - row.truth), 0.0, 1.0)]


def _write_sheet(path: Path, pictures: list[Array], columns: int = 0) -> None:
    """Pictures of one size side by side, in rows of `columns`; 0 for one row."""
    columns = columns or len(pictures)
    rows = [pictures[i : i + columns] for i in range(0, len(pictures), columns)]
    blank = np.zeros_like(pictures[0])
    sheet = np.vstack([np.hstack([*row, *[blank] * (columns - len(row))]) for row in rows])
    write_png(path, sheet.astype(np.float32))
