"""Textures, roughness and metalness of three things, from a few views of each.

A tile and a globe are built here; the cow comes from DATA/meshes/spot. Light and shape are known.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.images.read import read_image
from photograd.lights import EnvironmentMap
from photograd.transport import (
    InverseRendering,
    Material,
    MeshShape,
    Parameter,
    PathOptions,
    PathTracer,
    RecoveryOptions,
    RecoveryResult,
    Scene,
    Target,
    Texture,
    TextureUse,
    read_model,
)
from photograd.transport.builtin import camera_at, evening_map
from photograd.transport.inverse.pictures import display
from photograd.transport.shapes import rectangle
from photograd.transport.texture import decode
from photograd_course.viz import style

Array = NDArray[Any]
SIZE, TARGET_SPP = 64, 128
PATH = PathOptions(max_depth=4)
OPTIONS = RecoveryOptions(steps=300, spp=4, views=1, path=PATH)
TEXTURE_RATE = 0.5
SMOOTH, ROUGH = 0.25, 0.6  # where roughness begins; from the rough side searches get lost
SEEN = 0.1  # of the mean sensitivity of texels: those above count as seen
IMAGE = "recover_materials.png"
LOST = (
    "The last line is the first again from a rougher start. Where it ends is another valley of the "
    "loss, if its values are far from the truth: rough metal looks much like what is matt."
)


@dataclass(frozen=True)
class Case:
    """A thing, its true material, and from where it is seen."""

    name: str
    scene: Scene
    cameras: tuple[Camera, ...]

    @property
    def truth(self) -> dict[str, Array]:
        """{parameter of the tracer: true value} of what is looked for."""
        values = self.scene.materials["paint"].values
        return {
            "textures.paint": self.scene.textures["paint"].values.astype(np.float64),
            "materials.paint.roughness": np.asarray(values["roughness"], np.float64),
            "materials.paint.metalness": np.asarray(values["metalness"], np.float64),
        }


def reduced(image: Array, size: int) -> Array:
    """A square of size x size texels from the middle of a linear image, by averaging."""
    side = min(image.shape[:2]) // size * size
    top, left = ((n - side) // 2 for n in image.shape[:2])
    block = image[top : top + side, left : left + side, :3]
    split = block.reshape(size, side // size, size, side // size, 3)
    return np.ascontiguousarray(split.mean(axis=(1, 3)), np.float32)


def photograph(path: Path, size: int) -> Array:
    """An image file as linear texels, at least 0.03 dark."""
    return np.clip(reduced(decode(read_image(path)[..., :3]), size), 0.03, 0.95)


def globe_mesh(rows: int = 24) -> MeshShape:
    """A ball of radius 0.5 with longitude as u and latitude as v."""
    v, u = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, 2 * rows + 1), indexing="ij")
    theta, phi = np.pi * v, 2 * np.pi * u
    normal = np.stack(
        [np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], axis=-1
    ).reshape(-1, 3)
    corner = np.arange((rows + 1) * (2 * rows + 1)).reshape(rows + 1, -1)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    # Of the two triangles of a cell, one has no area where the cell touches a pole.
    faces = np.concatenate(
        [np.stack([a, b, c], -1)[:-1].reshape(-1, 3), np.stack([a, c, d], -1)[1:].reshape(-1, 3)]
    )
    uv = np.stack([u, v], axis=-1).reshape(-1, 2)
    return MeshShape("globe", 0.5 * normal, faces, "paint", normals=normal, uv=uv)


def painted(shape: MeshShape, model: str, texels: Array, cameras: Any, **values: float) -> Case:
    """A shape under the evening sky."""
    extra = {"reflectance": 0.5} if model == "standard" else {}
    material = Material(
        model, {"base_color": [1.0] * 3, **values, **extra}, {"base_color": TextureUse("paint")}
    )
    light = EnvironmentMap(evening_map(32), uniform_share=0.1)
    scene = Scene(
        shape.name,
        (replace(shape, material="paint"),),
        {"paint": material},
        cameras[0],
        lights=(light,),
        textures={"paint": Texture(texels, ("clamp", "clamp"))},
    )
    return Case(shape.name, scene, tuple(cameras))


def tile(data: Path, size: int = SIZE) -> Case:
    """A varnished tile, seen from all sides."""
    shape = rectangle("tile", [-0.5, 0, 0.5], [1, 0, 0], [0, 0, -1], "paint")
    # Three of them across from the sun, where the coating shows it.
    eyes = (
        [0.9, 0.7, 0.9],
        [-1.1, 0.5, 0.4],
        [-0.3, 0.9, -1.0],
        [-1.0, 0.55, -0.7],
        [-0.8, 0.45, -1.0],
        [-1.15, 0.65, -0.35],
    )
    cameras = [camera_at(eye, [0, 0, 0], 42.0, size, size) for eye in eyes]
    texels = photograph(data / "textures" / "coffee.png", 32)
    return painted(shape, "standard", texels, cameras, metalness=0.0, roughness=0.35)


def globe(data: Path, size: int = SIZE) -> Case:
    """A painted metal globe."""
    shape = globe_mesh()
    cameras = [
        camera
        for elevation in (15.0, 50.0)
        for camera in orbit_cameras(shape.box, 5, size=size, elevation=elevation)
    ]
    texels = photograph(data / "textures" / "chelsea.png", 32)
    return painted(shape, "gltf", texels, cameras, metalness=1.0, roughness=0.45)


def cow(data: Path, size: int = SIZE) -> Case:
    """Spot, in a glazed skin."""
    folder = data / "meshes" / "spot"
    (shape,) = read_model(folder / "spot.obj").shapes
    assert isinstance(shape, MeshShape)
    cameras = orbit_cameras(shape.box, 6, size=size, elevation=15.0)
    texels = photograph(folder / "spot_texture.png", 64)
    named = replace(shape, name="cow", emission=np.zeros(3))
    return painted(named, "gltf", texels, cameras, metalness=0.0, roughness=0.5)


CASES: tuple[Callable[[Path], Case], ...] = (tile, globe, cow)


def targets_of(case: Case, spp: int) -> list[Target]:
    """What the cameras see."""
    tracer = PathTracer(case.scene)
    return [
        Target(tracer.render(spp=spp, seed=100 + k, options=PATH, camera=camera).mean, camera)
        for k, camera in enumerate(case.cameras)
    ]


def search(
    case: Case, options: RecoveryOptions, targets: list[Target], roughness: float = SMOOTH
) -> InverseRendering:
    """From gray, half metal."""
    starts = {"textures.paint": 0.4, "materials.paint.roughness": roughness}
    rates = {"textures.paint": TEXTURE_RATE}  # or highlights would be painted on
    parameters = [
        Parameter(name, start=starts.get(name, 0.5), rate=rates.get(name, 1.0))
        for name in case.truth
    ]
    return InverseRendering(case.scene, targets, parameters, options)


def seen_texels(case: Case, spp: int = 16) -> NDArray[np.bool_]:
    """Texels (H, W) that the pictures depend on: above `SEEN` of the mean sensitivity."""
    tracer = PathTracer(case.scene)
    ones = np.ones((case.cameras[0].height, case.cameras[0].width, 3))
    total = sum(
        tracer.render_backward(ones, spp=spp, seed=7, options=PATH, camera=camera)["textures.paint"]
        for camera in case.cameras
    )
    sensitivity = np.abs(np.asarray(total)).sum(axis=2)
    return np.asarray(sensitivity > SEEN * sensitivity.mean())


def first_gradient(case: Case, targets: list[Target], spp: int = 16) -> Array:
    """dL/dtexel (H, W) of all views, summed over channels, before the first step."""
    options = RecoveryOptions(steps=1, spp=spp, path=PATH)
    _, gradients = search(case, options, targets).loss_and_gradients(0)
    return np.asarray(gradients["textures.paint"].sum(axis=2))


def row(case: Case, result: RecoveryResult, begin: float) -> str:
    """A line of the table; `begin` is the roughness at the start."""
    seen = seen_texels(case)
    truth = case.truth
    difference = (result.params["textures.paint"] - truth["textures.paint"])[seen]
    begun = (0.4 - truth["textures.paint"])[seen]
    rms, before = (float(np.sqrt(np.square(x).mean())) for x in (difference, begun))
    cells = [case.name, case.scene.materials["paint"].model, len(case.cameras)]
    cells += [f"{truth['textures.paint'].shape[0]}²", f"{100 * seen.mean():.0f} %"]
    cells += [begin, f"{rms:.3f} ({before:.3f})"]
    for name in ("roughness", "metalness"):
        key = f"materials.paint.{name}"
        cells.append(f"{float(result.params[key]):.3f} ({float(truth[key]):g})")
    return "| " + " | ".join(map(str, [*cells, f"{result.seconds:.0f}"])) + " |"


def measure(data: Path) -> tuple[list[str], Figure]:
    """Lines of the page, and the figure."""
    lines = [
        f"Views of {SIZE} x {SIZE} pixels, {OPTIONS.steps} steps, each of one view and twice "
        f"{OPTIONS.spp} samples a pixel, from texels of 0.4 and "
        "metalness 0.5. The texture's error is the "
        f"root mean square over texels that the pictures depend on (by more than {SEEN:g} of the "
        "mean); in brackets that of the start, or the truth.",
        "",
        "| thing | model | views | texels | seen | first roughness | texture, error | roughness "
        "| metalness | s |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    drawn = []
    for make in CASES:
        case = make(data)
        targets = targets_of(case, TARGET_SPP)
        gradient = first_gradient(case, targets)
        result = search(case, OPTIONS, targets).run()
        lines.append(row(case, result, SMOOTH))
        drawn.append((case, targets[0].image, gradient, result))
    case, _, _, _ = drawn[0]
    lost = search(case, OPTIONS, targets_of(case, TARGET_SPP), ROUGH).run()
    lines += [row(case, lost, ROUGH), "", LOST]
    return lines, materials_figure(drawn)


def materials_figure(drawn: list[tuple[Case, Array, Array, RecoveryResult]]) -> Figure:
    """A row for each thing: target, found, true texture, first gradient, found texture."""
    side, gap, left, head = 1.6, 0.12, 0.15, 0.35
    with style.house_style():
        figure = style.new_figure(5 * side + 4 * gap + 2 * left, head + 3 * (side + gap) + 0.75)
        for k, (case, target, gradient, result) in enumerate(drawn):
            picture = PathTracer(result.scene).render(spp=64, seed=3, options=PATH).mean
            limit = float(np.quantile(np.abs(gradient), 0.97))
            signed = {"norm": style.symmetric_scale(limit), "cmap": style.signed_color_map()}
            panels: tuple[tuple[str, Array, dict[str, Any]], ...] = (
                ("a target", display(target), {}),
                ("found", display(picture), {}),
                ("true texture", display(case.truth["textures.paint"]), {}),
                ("first dL/dtexel", gradient, signed),
                ("found texture", display(result.params["textures.paint"]), {}),
            )
            for column, (title, image, options) in enumerate(panels):
                place = left + column * (side + gap), head + k * (side + gap)
                axes = style.place_axes(figure, *place, side, side)
                axes.imshow(image, **options)
                axes.set_title(title if k == 0 else "")
                axes.axis("off")
        style.write_caption(
            figure,
            "A varnished tile, a globe of painted metal and a glazed cow, each from several views "
            "under a known sky. The derivative of the loss by each texel before the first step "
            "already draws the texture: blue asks for more, red for less. Texels that no "
            "camera sees are white, and stay as they were (gray in the found textures).",
            left=left,
            right=left,
        )
    return figure
