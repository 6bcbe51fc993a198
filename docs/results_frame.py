"""Compares frames with path tracing, tunes their settings, times them, and writes docs/frame.md.

    python docs/results_frame.py DATA                 # all tables
    python docs/results_frame.py DATA --only tuned    # one of against, tuned, speed

DATA is a folder of meshes with gltf/ and spot/; without it, rows that need it stay as they are.
Processor time is that of all threads of this process, as other work on the machine does not count.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.commands.trace import load_scene
from photograd.frame import (
    FrameOptions,
    FrameScene,
    HorizonSettings,
    ScreenRaySettings,
    ShadowSettings,
    SsaoSettings,
    bloom,
    frame_graph,
    tone_map,
    tune_bloom,
    tune_occlusion,
    tune_tone_curve,
)
from photograd.frame.against import displayed, kinds_of_light, options_for
from photograd.geometry.icosphere import icosphere
from photograd.lights import DirectionalLight
from photograd.transport import Material, PathOptions, PathTracer, Scene, builtin_scene
from photograd.transport.scene import Environment
from photograd.transport.shapes import MeshShape, rectangle
from photograd_course.cli import note

Array = NDArray[Any]
PAGE = Path(__file__).resolve().parent / "frame.md"
SIZE, SPP, MAX_DEPTH = 256, 256, 8
LONG = 4  # long paths have as many times fewer samples
SCENES = {
    "cornell-box": "",
    "evening": "",
    "tree": "gltf/low-poly-tree.glb",
    "spot": "spot/spot.obj",
    "spheres": "gltf/SpecularTest.glb",
}


def scenes(data: Path | None) -> Iterator[tuple[str, Scene]]:
    """Those that are compared, by name; what light passes through is left out."""
    for name, path in SCENES.items():
        if path and data is None:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = load_scene(str(data / path), SIZE, None)[0] if data and path else None
        scene = scene or builtin_scene(name, SIZE)
        glass = [m for m, material in scene.materials.items() if material.model == "glass"]
        yield name, replace(scene, shapes=tuple(s for s in scene.shapes if s.material not in glass))


def techniques(kind: str, radius: float) -> dict[str, FrameOptions]:
    """Of a kind of light; names with a star claim to reproduce it."""
    rays = ScreenRaySettings(length=2 * radius, thickness=0.25 * radius, steps=48)
    common = FrameOptions(
        supersampling=2,
        surface_points=16,
        sky_directions=48,
        shadows=ShadowSettings(size=1024),
        screen_rays=rays,
    )
    by_maps = replace(common, sky_visibility="shadow_maps")
    if kind == "direct light":
        return {
            "one point, shadow map": replace(common, surface_points=1),
            "16 points, shadow maps": common,
            "16 points, gathered *": replace(common, gather_samples=8),
        }
    if kind == "sky light":
        occlusion = SsaoSettings(radius=0.25 * radius, strength=2.0)
        horizon = HorizonSettings(radius=0.5 * radius)
        return {
            "nothing hides": replace(common, sky_visibility="none"),
            "samples of obscurance": replace(common, occlusion=occlusion),
            "horizons": replace(common, sky_visibility="horizon", horizon=horizon),
            "disks": replace(common, sky_visibility="disks", disk_edge=0.05 * radius),
            "rays in screen space": replace(common, sky_visibility="directional"),
            "shadow maps": by_maps,
            "shadow maps, gathered *": replace(by_maps, gather_samples=8, sky_directions=96),
        }
    return {
        "light sent on once": by_maps,
        "and once more in screen space": replace(by_maps, gather_samples=8),
    }


def processor(make: Callable[..., Any], *args: Any, **more: Any) -> tuple[Any, float]:
    """What a function returns, and the processor time that it took, milliseconds."""
    began = time.process_time()
    made = make(*args, **more)
    return made, 1e3 * (time.process_time() - began)


def rms(a: Array, b: Array) -> float:
    """Root of the mean squared difference."""
    return float(np.sqrt(np.mean((np.asarray(a, np.float64) - b) ** 2)))


def path_traced(scene: Scene, spp: int, max_depth: int) -> tuple[Array, float]:
    """The mean of two pictures of half the samples, and half of the RMS difference between them."""
    tracer = PathTracer(scene, allow_incomplete=True)
    options, plain = PathOptions(max_depth=max_depth), FrameOptions()
    halves = [tracer.render(spp=spp // 2, seed=seed, options=options).mean for seed in (0, 1)]
    shown = [displayed(half, plain) for half in halves]
    mean: Array = 0.5 * (halves[0] + halves[1])
    return mean, 0.5 * rms(*shown)


def against(data: Path | None, spp: int) -> dict[str, dict[str, tuple[float, float]]]:
    """{kind of light | technique: {scene: (RMS, processor ms)}}."""
    found: dict[str, dict[str, tuple[float, float]]] = {}
    for name, scene in scenes(data):
        for kind, lit, depth in kinds_of_light(scene, MAX_DEPTH):
            ready = FrameScene(lit)
            count = spp if depth == 2 else max(spp // LONG, 2)
            (truth, noise), spent = processor(path_traced, lit, count, depth)
            traced = found.setdefault(f"{kind} | noise of the paths, {count} a pixel", {})
            traced[name] = (noise, spent)
            note(f"{name}: {kind}: noise {noise:.4f}")
            for technique, chosen in techniques(kind, ready.radius).items():
                graph = frame_graph(ready, options_for(chosen, depth))
                frame, spent = processor(graph.run, {"camera": lit.camera}, ["radiance"])
                error = rms(displayed(frame["radiance"], chosen), displayed(truth, chosen))
                found.setdefault(f"{kind} | {technique}", {})[name] = (error, spent)
                note(f"{name}: {kind}: {technique}: {error:.4f}, {spent:.0f} ms")
    return found


def against_table(data: Path | None, spp: int) -> list[str]:
    """A row for each technique, a column for each scene."""
    found = against(data, spp)
    names = [name for name in SCENES if any(name in row for row in found.values())]
    lines = [
        f"| Light | Technique | {' | '.join(names)} | Processor |",
        "| --- " * (len(names) + 3),
    ]
    lines[1] += "|"
    order = {"direct light": 0, "sky light": 1, "all light": 2}
    for key in sorted(found, key=lambda key: (order[key.split(" | ")[0]], "paths" in key)):
        row, kind = found[key], key.split(" | ")
        cells = [f"{row[n][0]:.3f}" if n in row else "" for n in names]
        mean = np.mean([spent for _, spent in row.values()]) / 1e3
        lines.append(f"| {kind[0]} | {kind[1]} | {' | '.join(cells)} | {mean:.1f} s |")
    return lines


def replace_table(marker: str, lines: list[str]) -> None:
    """Write a table between <!-- marker --> and <!-- end of marker -->."""
    text = PAGE.read_text(encoding="utf-8")
    begin, end = f"<!-- {marker} -->\n", f"<!-- end of {marker} -->"
    head, rest = text.split(begin, 1)
    PAGE.write_text(head + begin + "\n".join(lines) + "\n" + end + rest.split(end, 1)[1])


# Settings by descent.


def glare(color: Array) -> Array:
    """A picture behind a lens of which 20 % of the light is scattered, by 1 / (r + 1)^2.5.

    The convolution is done whole, with the picture mirrored at its borders.
    """
    height, width, _ = color.shape
    padded = np.pad(color, ((height // 2,) * 2, (width // 2,) * 2, (0, 0)), mode="symmetric")
    rows, columns = padded.shape[:2]
    y, x = np.fft.fftfreq(rows, 1 / rows), np.fft.fftfreq(columns, 1 / columns)
    spread = (np.hypot(y[:, None], x[None, :]) + 1.0) ** -2.5
    spread *= 0.2 / spread.sum()
    spread[0, 0] += 0.8
    by = np.fft.rfft2(spread)[..., None]
    out = np.fft.irfft2(np.fft.rfft2(padded, axes=(0, 1)) * by, s=(rows, columns), axes=(0, 1))
    inside: Array = out[height // 2 : -(height // 2), width // 2 : -(width // 2)]
    return inside[:height, :width]


def tuned_table(data: Path | None, spp: int) -> list[str]:
    """A row for each setting and scene."""
    lines = [
        "| Setting | Scene | Error before | after | Found |",
        "| --- | --- | --- | --- | --- |",
    ]
    for name, scene in scenes(data):
        camera = replace_size(scene.camera, 96)
        ready = FrameScene(scene, dtype=np.float64)
        start = SsaoSettings(radius=0.25 * ready.radius)
        reach = 0.5 * ready.radius
        tuned = tune_occlusion(ready, [camera], start, steps=120, spp=spp, radius=reach)
        found = tuned.settings
        numbers = f"radius {found.radius / ready.radius:.2f} R, falloff {found.falloff:.2f}, "
        numbers += f"distribution {found.distribution:.2f}, strength {found.strength:.2f}"
        lines.append(
            f"| ambient occlusion | {name} | {tuned.before:.3f} | {tuned.after:.3f} | {numbers} |"
        )
        note(lines[-1])
    for name, scene in scenes(data):
        small = replace(scene, camera=replace_size(scene.camera, 128))
        options = PathOptions(max_depth=MAX_DEPTH)
        truth = PathTracer(small, allow_incomplete=True).render(spp=spp, seed=0, options=options)
        mean = np.maximum(truth.mean, 0.0).astype(np.float64)
        graph = frame_graph(FrameScene(small), FrameOptions(sky_visibility="shadow_maps"))
        frame = graph.run({"camera": small.camera}, ["radiance"])["radiance"].astype(np.float64)
        curve = tune_tone_curve(frame, tone_map(mean, "agx"), "agx", steps=200, rate=0.04)
        shape = ", ".join(f"{key} {value:.2f}" for key, value in curve.params.items())
        lines.append(
            f"| tone curve, exposure | {name} | {curve.before:.3f} | {curve.after:.3f} "
            f"| exposure {curve.exposure:+.2f}, {shape} |"
        )
        note(lines[-1])
        spread = tune_bloom(mean, glare(mean), np.full(6, 0.2 / 6), steps=400, rate=0.1)
        plain = rms(bloom(mean, np.full(6, 0.2 / 6)), glare(mean))
        assert abs(plain - spread.before) < 1e-9
        weights = ", ".join(f"{value:.3f}" for value in spread.weights)
        lines.append(f"| bloom | {name} | {spread.before:.4f} | {spread.after:.4f} | {weights} |")
        note(lines[-1])
    return lines


def replace_size(camera: Camera, size: int) -> Camera:
    """The same view of at most `size` pixels along the longer edge."""
    by = size / max(camera.width, camera.height)
    width, height = round(by * camera.width), round(by * camera.height)
    return replace(
        camera,
        width=width,
        height=height,
        fx=by * camera.fx,
        fy=by * camera.fy,
        cx=by * camera.cx,
        cy=by * camera.cy,
    )


# Speed.


def pose(angle: float) -> Array:
    """World from camera, on a circle around the ball."""
    eye = np.array([3.2 * np.sin(angle), 1.6, 3.2 * np.cos(angle)])
    return look_at(eye, np.array([0.0, 0.8, 0.0]))


def waves(divisions: int = 71) -> Scene:
    """A ball with waves of about 100,000 triangles over a floor."""
    mesh = icosphere(divisions)
    x, y, z = mesh.vertices.T
    wave = 1.0 + 0.08 * np.sin(9 * x + 1) * np.cos(8 * y) + 0.05 * np.sin(13 * z)
    points = 0.9 * wave[:, None] * mesh.vertices + [0.0, 0.95, 0.0]
    floor = rectangle("floor", [-4, 0, 4], [8, 0, 0], [0, 0, -8], "gray", [0, 0, 0])
    materials = {
        "gray": Material("lambert", {"albedo": [0.5, 0.5, 0.5]}),
        "clay": Material("ggx_metal", {"roughness": 0.5, "f0": [0.8, 0.5, 0.35]}),
    }
    camera = Camera(640, 360, 500.0, 500.0, 320.0, 180.0, pose(0.0))
    light = DirectionalLight([0.4, 1.0, 0.5], [3.0, 2.8, 2.6])
    ball = MeshShape("ball", points, mesh.faces, "clay", normals=points - [0.0, 0.95, 0.0])
    sky = Environment([0.3, 0.4, 0.6], [0.6, 0.6, 0.6], [0.2, 0.2, 0.2])
    return Scene("waves", (floor, ball), materials, camera, sky, (light,))


def speed_table(frames: int = 12) -> list[str]:
    """Processor milliseconds of each pass of a frame whose camera and light move."""
    scene = waves()
    options = FrameOptions(
        culling="facing",
        sky_directions=4,
        occlusion_samples=8,
        shadows=ShadowSettings(size=1024),
        bloom_weights=(0.03,) * 6,
        tone_curve="aces",
    )
    ready, spent, wall = FrameScene(scene), {}, []  # type: ignore[var-annotated]
    for frame in range(frames + 1):
        angle = 0.1 * frame
        camera = replace(scene.camera, world_from_camera=pose(angle))
        sun = DirectionalLight([np.sin(2 * angle), 1.0, 0.5], [3.0, 2.8, 2.6])
        ready.scene = replace(scene, lights=(sun,))
        began = time.perf_counter()
        graph = frame_graph(ready, options)
        result = graph.run({"camera": camera}, clock=time.process_time)
        if frame:  # the first finds the clusters
            wall.append(1e3 * (time.perf_counter() - began))
            for name, took in result.milliseconds.items():
                spent.setdefault(name, []).append(took)
    covered = result["gbuffer"].covered.mean()
    note(f"{len(ready.faces)} triangles, {covered:.0%} of the picture; wall {np.median(wall):.0f}")
    means = {name: float(np.median(took)) for name, took in spent.items()}
    lines = ["| Pass | Processor ms |", "| --- | --- |"]
    lines += [f"| {name} | {took:.1f} |" for name, took in means.items() if took >= 0.1]
    return [*lines, f"| all | {sum(means.values()):.1f} |"]


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, nargs="?")
    parser.add_argument("--only", choices=("against", "tuned", "speed"))
    parser.add_argument("--spp", type=int, default=SPP, help="paths a pixel of the truth")
    given = parser.parse_args()
    tables = {
        "against": lambda: against_table(given.data, given.spp),
        "tuned": lambda: tuned_table(given.data, min(given.spp, 64)),
        "speed": speed_table,
    }
    for name, table in tables.items():
        if given.only in (None, name):
            lines = table()
            note("\n".join(lines))
            replace_table(name, lines)


if __name__ == "__main__":
    main()
