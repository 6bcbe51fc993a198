"""A lens whose caustic is a picture: `python docs/figures_caustic_design.py`.

Writes docs/images/caustic_design.png: the picture, the light of the lens of optimal transport, the
light after descent from there and from a plane, the heights and the error. It prints what
docs/caustics.md says. Two minutes on two cores.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.caustics import (
    CausticOptions,
    CausticResult,
    Lens,
    design_caustic,
    measure,
    transport_lens,
)
from photograd.caustics.measure import correlation
from photograd.lights import DirectionalLight
from photograd.transport import IrradianceSensor, Material, PathTracer, Scene, trace_light
from photograd.transport.builtin import camera_at
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
CELLS, VERTICES, STEPS, PARTICLES = 64, 129, 200, 1 << 21
SIDE, AWAY, THICKNESS = 0.1, 0.3, 0.02  # m
SUN = DirectionalLight([0, 1.0, 0], [1000.0] * 3)


def picture(cells: int) -> Array:
    """A crescent, a disc and a star with soft rims on a dim ground, (cells, cells)."""
    y, x = (np.mgrid[0:cells, 0:cells] + 0.5) / cells

    def disc(cx: float, cy: float, radius: float) -> Array:
        return np.clip((radius - np.hypot(x - cx, y - cy)) * 32 + 0.5, 0, 1)

    def star(cx: float, cy: float, radius: float) -> Array:
        angle = np.arctan2(x - cx, cy - y)
        rim = radius * (0.66 + 0.34 * np.cos(5 * angle))
        return np.clip((rim - np.hypot(x - cx, y - cy)) * 32 + 0.5, 0, 1)

    crescent = np.clip(disc(0.36, 0.42, 0.25) - disc(0.46, 0.36, 0.2), 0, 1)
    return 0.12 + crescent + 0.8 * star(0.72, 0.3, 0.15) + 0.6 * disc(0.68, 0.74, 0.13)


def plate(vertices: int) -> Lens:
    """A slab that lies level; light falls through it, downwards."""
    heights = np.zeros((vertices, vertices))
    corner = [-SIDE / 2, AWAY + THICKNESS, -SIDE / 2]
    return Lens(corner, [SIDE, 0, 0], [0, 0, SIDE], THICKNESS, heights)


def table(cells: int) -> IrradianceSensor:
    """The square below it, seen from above."""
    return IrradianceSensor([-SIDE / 2, 0, SIDE / 2], [SIDE, 0, 0], [0, 0, -SIDE], cells, cells)


def designs(cells: int, vertices: int, steps: int) -> tuple[Array, CausticResult, CausticResult]:
    """The light of the start, and the designs from there and from a plane."""
    target = picture(cells)
    lens = transport_lens(plate(vertices), SUN, table(cells), target)
    start = measure([lens], SUN, table(cells), seed=1).irradiance
    found = []
    for name in ("transport", "plane"):
        options = CausticOptions(start=name, steps=steps)  # type: ignore[arg-type]
        found.append(design_caustic(plate(vertices), SUN, table(cells), target, options))
    return start, found[0], found[1]


def traced(lens: Lens, cells: int, particles: int) -> Array:
    """The light behind a lens by particles of the path tracer, reflections included, (H, W)."""
    glass = Material("glass", {"eta": lens.eta, "tint": [1, 1, 1]})
    camera = camera_at([0.0, 0.1, 1.0], [0, 0.1, 0], 30, 4, 4)
    scene = Scene("lens", (lens.shape("lens", "glass"),), {"glass": glass}, camera, lights=(SUN,))
    return trace_light(PathTracer(scene), table(cells), particles, seed=1).mean[..., 0]


def design_figure(start: Array, best: CausticResult, plane: CausticResult) -> Figure:
    """Six panels and what they show."""
    side, gap, left = 2.0, 0.15, 0.15
    target, light = best.target, best.caustic.irradiance
    white = float(np.quantile(target, 0.99))
    heights = 1000 * best.lenses[0].heights
    error = (light - target) / target.mean()
    signed = {"norm": style.symmetric_scale(0.3), "cmap": style.signed_color_map()}
    likeness = correlation(start, target)
    panels: list[tuple[str, Array, dict[str, Any]]] = [
        ("target", target, {"cmap": "gray", "vmin": 0, "vmax": white}),
        (f"transport: {likeness:.4f}", start, {"cmap": "gray", "vmin": 0, "vmax": white}),
        (f"after descent: {best.correlation:.4f}", light, {}),
        (f"from a plane: {plane.correlation:.4f}", plane.caustic.irradiance, {}),
        (f"heights, {np.ptp(heights):.1f} mm", heights, {"cmap": "viridis"}),
        ("error after descent, ±0.3", error, signed),
    ]
    with style.house_style():
        figure = style.new_figure(3 * side + 2 * gap + 2 * left, 2 * side + 1.5)
        for k, (title, image, options) in enumerate(panels):
            row, column = divmod(k, 3)
            top = 0.35 + row * (side + 0.35)
            axes = style.place_axes(figure, left + column * (side + gap), top, side, side)
            axes.imshow(image, **(options or panels[0][2]))
            axes.set_title(title)
            axes.axis("off")
        style.write_caption(
            figure,
            "Parallel light through a slab of glass 10 cm wide, and what it leaves on a table "
            "30 cm below; the numbers are correlations with the target. Optimal transport, Snell's "
            "law and a Poisson solve give the start, descent through the refraction sharpens it. "
            "From a plane, descent alone comes nearly as far. The error is in units of the mean.",
            left=left,
            right=left,
        )
    return figure


def report(start: Array, best: CausticResult, plane: CausticResult) -> list[str]:
    """What docs/caustics.md says of the figure, line by line."""
    lines = [f"transport {correlation(start, best.target):.4f}"]
    for name, found in (("descent", best), ("plane", plane)):
        light = found.caustic
        lines.append(
            f"{name} {found.correlation:.4f} in {found.seconds:.0f} s: emitted {light.emitted:.4f} "
            f"W, transmitted {light.transmitted / light.emitted:.5f} and received "
            f"{light.received / light.emitted:.5f} of it"
        )
    particles = traced(best.lenses[0], CELLS, PARTICLES)[2:-2, 2:-2]
    inner = best.target[2:-2, 2:-2]
    ratio = particles.mean() / inner.mean()
    lines.append(f"light tracer {correlation(particles, inner):.4f}, power {ratio:.4f}")
    return lines


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    found = designs(CELLS, VERTICES, STEPS)
    print(*report(*found), sep="\n")  # noqa: T201
    save_figure(design_figure(*found), IMAGES / "caustic_design.png")


if __name__ == "__main__":
    main()
