"""The picture of reflectance models: `python docs/figures_bsdf.py` writes it.

Balls of some materials, how much of the light each model returns, and what roughness does to a
picture: the derivative that a fit follows.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.bsdf import BsdfModel, registry
from photograd.bsdf.gallery import sphere_directions, sphere_picture
from photograd.bsdf.models import METALS
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
MODELS = registry()
SIZE = 200
PLASTIC = {"base_color": [0.75, 0.12, 0.08], "metalness": 0.0}
GOLD = [1.0, 0.78, 0.34]


def draining_film() -> Array:
    """Thickness (N,) in nm for the pixels of a ball: a film that has run down."""
    down = np.nonzero(sphere_directions(SIZE)[0])[0]
    return np.asarray(200.0 + 500.0 * down / SIZE)


BALLS: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("plaster", "oren_nayar_qualitative", {"albedo": [0.7, 0.66, 0.6], "sigma": 0.6}),
    ("plastic", "gltf", {**PLASTIC, "roughness": 0.35}),
    ("coated", "clearcoat", {**PLASTIC, "roughness": 0.8, "coat": 1.0, "coat_roughness": 0.15}),
    ("gold", "ggx_conductor", {**METALS["gold"], "roughness": 0.45}),
    (
        "brushed",
        "ggx_anisotropic",
        {"f0": [0.8, 0.8, 0.85], "roughness": 0.35, "anisotropy": 0.8, "rotation": 0.0},
    ),
    ("velvet", "sheen", {"color": [0.3, 0.4, 0.9], "roughness": 0.5}),
    ("plaster, all terms", "oren_nayar_full", {"albedo": [0.7, 0.66, 0.6], "sigma": 0.6}),
    (
        "draining film",
        "gltf_iridescence",
        {
            "base_color": [0.3] * 3,
            "metalness": 1.0,
            "roughness": 0.7,
            "iridescence_factor": 1.0,
            "iridescence_ior": 1.8,
            "iridescence_thickness": draining_film(),
        },
    ),
    ("rough gold, lossy", "ggx_metal", {"f0": GOLD, "roughness": 1.0}),
    ("given back", "ggx_metal_compensated", {"f0": GOLD, "roughness": 1.0}),
    (
        "cloth",
        "gltf_sheen",
        {
            "base_color": [0.25, 0.03, 0.04],
            "metalness": 0.0,
            "roughness": 0.8,
            "sheen_color_factor": [0.9, 0.6, 0.6],
            "sheen_roughness_factor": 0.4,
        },
    ),
    (
        "principled",
        "disney",
        {
            "base_color": [0.05, 0.2, 0.35],
            "subsurface": 0.0,
            "metalness": 0.3,
            "specular": 0.5,
            "specular_tint": 0.5,
            "roughness": 0.5,
            "anisotropic": 0.6,
            "sheen": 0.5,
            "sheen_tint": 0.5,
            "clearcoat": 1.0,
            "clearcoat_gloss": 0.8,
        },
    ),
)
WHITE: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("Lambert", "lambert", {"albedo": [1.0] * 3}),
    ("Burley, roughness 1", "burley_diffuse", {"albedo": [1.0] * 3, "roughness": 1.0}),
    (
        "glTF, white plastic, 0.5",
        "gltf",
        {"base_color": [1.0] * 3, "metalness": 0.0, "roughness": 0.5},
    ),
    ("GGX mirror, roughness 0.5", "ggx_metal", {"f0": [1.0] * 3, "roughness": 0.5}),
    ("GGX mirror, roughness 1", "ggx_metal", {"f0": [1.0] * 3, "roughness": 1.0}),
    ("the same, given back", "ggx_metal_compensated", {"f0": [1.0] * 3, "roughness": 1.0}),
    ("sheen, roughness 0.5", "sheen", {"color": [1.0] * 3, "roughness": 0.5}),
)


def hemisphere(heights: int = 64, turns: int = 512) -> tuple[Array, Array]:
    """Directions (M, 3), and solid angles times cosines (M,)."""
    nodes, weights = np.polynomial.legendre.leggauss(heights)  # in the root of the height
    root = 0.5 * (nodes + 1.0)
    z, phi = np.meshgrid(root**2, 2.0 * np.pi * (np.arange(turns) + 0.5) / turns, indexing="ij")
    r = np.sqrt(1.0 - z * z)
    wi = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).reshape(-1, 3)
    return wi, np.repeat(root**3 * weights * 2.0 * np.pi / turns, turns)


def furnace(model: BsdfModel, parameters: dict[str, Any], cosines: Array) -> Array:
    """Directional albedo for each cosine of the viewer: what a ball shows in a white room."""
    wi, weight = hemisphere()
    found = []
    for cosine in cosines:
        wo = np.tile([np.sqrt(1.0 - cosine**2), 0.0, cosine], (len(wi), 1))
        found.append(weight @ model.f(parameters, wo, wi)[:, 0])
    return np.array(found)


def by_roughness(parameters: dict[str, Any]) -> Array:
    """d(radiance, mean of the channels)/droughness of the plastic ball, by `f_backward`."""
    inside, wo, wi = sphere_directions(SIZE)
    rows = {name: np.broadcast_to(v, (len(wo), *np.shape(v))) for name, v in parameters.items()}
    d_f = np.repeat(np.pi / 3.0 * np.clip(wi[:, 2:], 0.0, None), 3, axis=1)
    image = np.zeros((SIZE, SIZE))
    image[inside] = MODELS["gltf"].f_backward(rows, wo, wi, d_f)["roughness"]
    return image


def draw_ball(axes: Axes, image: Array, title: str, **options: Any) -> None:
    """A picture without ticks."""
    axes.imshow(image, **options)
    axes.set_title(title)
    axes.axis("off")


def bsdf_figure() -> Figure:
    """Twelve balls above; albedos, a plastic ball and its derivative below."""
    cosines = np.linspace(0.02, 1.0, 50)
    side, gap, left = 1.35, 0.12, 0.15
    width = 6 * side + 5 * gap + 2 * left
    row = side + 0.3
    with style.house_style():
        figure = style.new_figure(width, 5.45 + row)
        for number, (title, name, parameters) in enumerate(BALLS):
            down, across = divmod(number, 6)
            place = left + across * (side + gap), 0.35 + down * row
            axes = style.place_axes(figure, *place, side, side)
            picture = sphere_picture(MODELS[name], parameters, SIZE)
            draw_ball(axes, srgb_encode(np.clip(picture, 0.0, 1.0)), title)
        axes = style.place_axes(figure, 0.6, 2.1 + row, 3.6, 2.2)
        for label, name, parameters in WHITE:
            axes.plot(cosines, furnace(MODELS[name], parameters, cosines), label=label)
        axes.axhline(1.0, color=style.GUIDE, lw=0.8)
        axes.set(xlim=(0.0, 1.0), ylim=(0.0, 2.0), xlabel="cosine of the viewer")
        axes.set_title("light returned by white materials")
        axes.legend(loc="upper right", fontsize=6.0, ncols=2)
        plastic = {**PLASTIC, "roughness": 0.35}
        image, slope = sphere_picture(MODELS["gltf"], plastic, SIZE), by_roughness(plastic)
        limit = float(np.quantile(np.abs(slope), 0.995))
        axes = style.place_axes(figure, 4.6, 2.3 + row, 1.7, 1.7)
        draw_ball(axes, srgb_encode(np.clip(image, 0.0, 1.0)), "plastic, roughness 0.35")
        axes = style.place_axes(figure, 6.45, 2.3 + row, 1.7, 1.7)
        scale, colors = style.symmetric_scale(limit), style.signed_color_map()
        draw_ball(axes, slope, "its derivative with respect to roughness", norm=scale, cmap=colors)
        mappable = ScalarMappable(scale, colors)
        style.color_bar(figure, (8.2, 2.3 + row, 0.1, 1.7), mappable, "", extend="both")
        style.write_caption(
            figure,
            "Above: balls under one distant light. Left: the part of the light that comes back, "
            "by the cosine of the view. Mirrors of rough facets lose what meets a second facet, "
            "if it is not given back; the fits of Burley and of glTF return more than came at "
            "grazing angles. Right: more roughness would dim the middle of the highlight (blue) "
            "and light a ring around it (red); an error in the picture pulls roughness one way "
            "or the other by where it lies.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(bsdf_figure(), IMAGES / "bsdf.png")


if __name__ == "__main__":
    main()
