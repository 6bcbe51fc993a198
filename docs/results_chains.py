"""What attached derivatives are worth: `python docs/results_chains.py` prints a table.

Derivatives of a weighted mean of a picture, by chains that move, by paths held fixed, and by free
finite differences. Each is a mean over seeds with its standard error. Two minutes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from photograd.caustics import Lens, discontinuities, specular_picture, specular_picture_backward
from photograd.transport import Environment, Material, PathTracer, Scene, SphereShape
from photograd.transport.builtin import camera_at

SIZE, SPP, SEEDS = 16, 256, 12
SKY = Environment([1.0, 0.9, 0.8], [0.5, 0.6, 0.7], [0.1, 0.1, 0.1])
ROWS = np.linspace(0, 2, SIZE)[:, None, None]
WEIGHTS = np.broadcast_to(ROWS, (SIZE, SIZE, 3)) / (3 * SIZE * SIZE)


def glass(eta: float) -> dict[str, Material]:
    """Clear glass."""
    return {"glass": Material("glass", {"eta": eta, "tint": [1, 1, 1]})}


def ball(field_of_view: float) -> Callable[[str, float], Scene]:
    """A glass ball; with 18 degrees it fills the view."""

    def changed(name: str, by: float) -> Scene:
        radius = 1.0 + (by if name == "shapes.ball.radius" else 0.0)
        eta = 1.5 + (by if name == "materials.glass.eta" else 0.0)
        shape = SphereShape("ball", np.zeros(3), radius, "glass")
        camera = camera_at([0, 0.2, 4], [0, 0, 0], field_of_view, SIZE, SIZE)
        return Scene("ball", (shape,), glass(eta), camera, SKY)

    return changed


def slab(name: str, by: float) -> Scene:
    """A wavy slab with its sides in view."""
    eta = 1.5 + (by if name == "materials.glass.eta" else 0.0)
    y, x = np.meshgrid(np.linspace(0, 6, 17), np.linspace(0, 9, 25), indexing="ij")
    lens = Lens(
        [-0.06, 0.1, 0.04], [0.12, 0, 0], [0, 0, -0.08], 0.02, 0.002 * np.sin(x + 0.4 * y), eta
    )
    camera = camera_at([0.02, 0.25, 0.1], [0, 0.1, 0], 40, SIZE, SIZE)
    return Scene("slab", (lens.shape("lens", "glass"),), glass(eta), camera, SKY)


CASES: tuple[tuple[str, Callable[[str, float], Scene], str, float], ...] = (
    ("ball that fills the view", ball(18.0), "materials.glass.eta", 0.02),
    ("ball that fills the view", ball(18.0), "shapes.ball.radius", 0.02),
    ("ball and its rim", ball(40.0), "materials.glass.eta", 0.02),
    ("ball and its rim", ball(40.0), "shapes.ball.radius", 0.02),
    ("slab and its edges", slab, "materials.glass.eta", 0.02),
)


def measured(make: Callable[[str, float], Scene], name: str, h: float) -> dict[str, Any]:
    """Mean and standard error of each way."""
    found: dict[str, list[float]] = {"moved": [], "held": [], "differences": []}
    for seed in range(SEEDS):
        moved = specular_picture_backward(
            make(name, 0.0), WEIGHTS, spp=SPP, seed=seed, allow_incomplete=True
        )
        found["moved"].append(float(moved[name]))
        ends = [specular_picture(make(name, s * h), spp=SPP, seed=seed) for s in (1, -1)]
        found["differences"].append(float(((ends[0] - ends[1]) * WEIGHTS).sum()) / (2 * h))
        if name.startswith("materials"):
            tracer = PathTracer(make(name, 0.0), dtype=np.float64, allow_incomplete=True)
            held = tracer.render_backward(WEIGHTS, spp=SPP, seed=seed)
            found["held"].append(float(held[name]))
    return {
        way: (np.mean(values), np.std(values, ddof=1) / np.sqrt(len(values)))
        for way, values in found.items()
        if values
    }


def table() -> list[str]:
    """Rows of Markdown."""
    lines = ["| scene | with respect to | moved | held | differences | seen |"]
    lines.append("| --- | --- | --- | --- | --- | --- |")
    for title, make, name, h in CASES:
        found = measured(make, name, h)
        cells = [
            f"{found[way][0]:.4f} ± {found[way][1]:.4f}" if way in found else "none"
            for way in ("moved", "held", "differences")
        ]
        reasons = discontinuities(make(name, 0.0), spp=64, seed=0)
        seen = "edges: refused" if reasons else "whole"
        lines.append(f"| {title} | `{name}` | {' | '.join(cells)} | {seen} |")
    return lines


if __name__ == "__main__":
    print(*table(), sep="\n")  # noqa: T201
