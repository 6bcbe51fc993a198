"""Draws docs/images/frame_breakdown.jpg and frame_graph.png: `python docs/figures_frame.py DATA`.

One frame of a glTF scene at 1280 x 720, pass by pass. DATA is a folder with gltf/house.glb.
"""

from __future__ import annotations

import argparse
import io
import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.commands.trace import load_scene
from photograd.frame import (
    FrameOptions,
    FrameResult,
    FrameScene,
    HorizonSettings,
    ScreenRaySettings,
    ShadowSettings,
    bloom,
    frame_graph,
    vignette,
)
from photograd.frame.against import displayed
from photograd.frame.graph_picture import draw_graph
from photograd.frame.panels import panels
from photograd.lights import DirectionalLight
from photograd.transport import PathOptions, PathTracer, Scene
from photograd.transport.lens import Lens
from photograd.transport.scene import Environment
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style
from PIL import Image

Array = NDArray[Any]
IMAGES = Path(__file__).resolve().parent / "images"
WIDTH, HEIGHT, FOCAL = 1280, 720, 1500.0  # pixels
COLUMNS, PANEL, GAP, TITLE, DPI = 3, 3.1, 0.08, 0.27, 130  # inches, pixels per inch
SPP = 128


def rich_scene(data: Path) -> Scene:
    """The house under a low sun and a sky, from nearer than its default camera."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        scene = load_scene(str(data / "gltf" / "house.glb"), WIDTH, None)[0]
    eye, target = np.array([0.47, 0.36, 0.62]), np.array([0.0, 0.1, 0.02])
    camera = Camera(WIDTH, HEIGHT, FOCAL, FOCAL, WIDTH / 2, HEIGHT / 2, look_at(eye, target))
    house = tuple(shape for shape in scene.shapes if not shape.emission.any())
    materials = dict(scene.materials)
    white = materials["White"]
    warm = {**white.values, "base_color": np.array([0.72, 0.60, 0.46])}
    materials["White"] = replace(white, values=warm)
    sky = Environment([0.16, 0.27, 0.55], [0.75, 0.62, 0.5], [0.1, 0.09, 0.08])
    sun = DirectionalLight([0.9, 0.62, -0.2], [4.2, 3.1, 2.0])
    lens = Lens(0.004, float(np.linalg.norm(eye - target)))
    return replace(
        scene,
        shapes=house,
        materials=materials,
        camera=camera,
        environment=sky,
        lights=(sun,),
        lens=lens,
    )


def options(scene: FrameScene) -> FrameOptions:
    """Of the frame: all passes but fog and motion."""
    radius = scene.radius
    return FrameOptions(
        culling="frustum",
        sky_directions=32,
        sky_visibility="horizon",
        horizon=HorizonSettings(radius=0.25 * radius),
        gather_samples=8,
        screen_rays=ScreenRaySettings(length=0.5 * radius, thickness=0.1 * radius, steps=32),
        shadows=ShadowSettings(size=2048),
        fxaa=True,
        depth_of_field=32,
        bloom_weights=(0.02,) * 6,
        vignette=0.6,
        tone_curve="agx",
        exposure=-0.3,
    )


def pictures(frame: FrameResult, chosen: FrameOptions) -> list[tuple[str, Array]]:
    """(title, picture) of each panel but the truth."""
    surfaces = panels(frame, "gbuffer")
    sums = {"direct light of the sun": frame["direct"]}
    sums["sky light, behind the occlusion"] = frame["sky_light"]
    sums["light gathered in screen space"] = frame["gathered"]
    with_light = {name: displayed(light, chosen) for name, light in sums.items()}
    shadow = panels(frame, "shadows")
    return [
        ("visibility buffer: triangles", panels(frame, "visibility")["face"]),
        ("depth", surfaces["depth"]),
        ("normals", surfaces["shading normal"]),
        ("shadow map of the sun", _cut(next(iter(shadow.values())))),
        ("ambient occlusion, from horizons", panels(frame, "occlusion")["occlusion"]),
        *with_light.items(),
        ("all light, tone mapped", displayed(frame["opaque"], chosen)),
        ("depth of field", displayed(frame["focused"], chosen)),
        ("bloom, vignette: the frame", np.clip(srgb_encode(frame["display"]), 0, 1)),
    ]


def _cut(picture: Array) -> Array:
    """The middle of a square, of the frame's shape."""
    size = len(picture)
    height = size * HEIGHT // WIDTH
    top = (size - height) // 2
    return picture[top : top + height]


def breakdown(named: list[tuple[str, Array]]) -> Figure:
    """Panels in rows."""
    rows = -(-len(named) // COLUMNS)
    height = PANEL * HEIGHT / WIDTH
    with style.house_style():
        figure = style.new_figure(COLUMNS * (PANEL + GAP) + GAP, rows * (height + TITLE) + GAP)
        for k, (title, picture) in enumerate(named):
            left, top = GAP + k % COLUMNS * (PANEL + GAP), k // COLUMNS * (height + TITLE) + TITLE
            axes = style.place_axes(figure, left, top, PANEL, height)
            axes.imshow(_small(picture))
            axes.set(xticks=[], yticks=[])
            axes.set_title(title, fontsize=style.LABEL_SIZE)
    return figure


def _small(picture: Array) -> Array:
    """As many pixels as the panel shows."""
    size = (round(PANEL * DPI), round(PANEL * DPI * HEIGHT / WIDTH))
    eight = (255 * np.clip(picture, 0, 1) + 0.5).astype(np.uint8)
    return np.asarray(Image.fromarray(eight).resize(size, Image.Resampling.LANCZOS))


def traced(scene: Scene, chosen: FrameOptions) -> Array:
    """The same picture by paths, through the same lens, bloom and display; of a panel's size."""
    width, height = round(PANEL * DPI), round(PANEL * DPI * HEIGHT / WIDTH)
    by = width / WIDTH
    camera = Camera(
        width, height, by * FOCAL, by * FOCAL, width / 2, height / 2, scene.camera.world_from_camera
    )
    tracer = PathTracer(replace(scene, camera=camera), allow_incomplete=True)
    sums = tracer.render(spp=SPP, seed=0, options=PathOptions(max_depth=16))
    spread = bloom(np.maximum(sums.mean, 0), np.array(chosen.bloom_weights))
    return displayed(vignette(spread, camera, chosen.vignette), chosen)


def main() -> None:
    """Draw both."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    given = parser.parse_args()
    scene = rich_scene(given.data)
    ready = FrameScene(scene)
    chosen = options(ready)
    graph = frame_graph(ready, chosen)
    frame = graph.run({"camera": scene.camera}, clock=time.process_time)
    named = pictures(frame, chosen)
    named.append((f"the traced truth, {SPP} paths a pixel", traced(scene, chosen)))
    figure = breakdown(named)
    with io.BytesIO() as file:
        figure.savefig(file, format="png", dpi=DPI)
        Image.open(file).convert("RGB").save(IMAGES / "frame_breakdown.jpg", quality=88)
    save_figure(draw_graph(graph, frame.milliseconds), IMAGES / "frame_graph.png", dpi=110)


if __name__ == "__main__":
    main()
