"""A picture and a benchmark row for every registered reflectance model."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from photograd_course.color import srgb_encode
from photograd_course.random import uniform

from photograd.bsdf.models import BsdfModel
from photograd.types import Array

_EVEN = (0.7548776662466927, 0.5698402909980532)  # 1/x and 1/x^2 of x^3 = x + 1: multiples fill


def furnace_curve(
    model: BsdfModel, parameters: dict[str, Any], cosines: Array, *, samples: int = 1024
) -> Array:
    """The part of the light that leaves, for views of these cosines: a ball in a white room.

    Estimated with the model's own samples, as the mean of f cos / pdf; what is refracted counts by
    power, which is radiance over the squared index.

    Args:
        model: of the registry.
        parameters: one row of values.
        cosines: (C,), of the angles between view and normal, above 0.
        samples: for each cosine, spread evenly.

    Returns:
        (C, 3), one channel each.
    """
    u2 = np.mod(0.5 + np.arange(samples)[:, None] * np.array(_EVEN), 1.0)
    inside = model.index_inside(parameters)
    found = []
    for cosine in np.asarray(cosines, np.float64):
        wo = np.tile([np.sqrt(1.0 - cosine**2), 0.0, cosine], (samples, 1))
        wi = model.sample(parameters, wo, u2)
        pdf = model.pdf(parameters, wo, wi)[:, None]
        power = np.abs(wi[:, 2:]) * np.where(wi[:, 2:] < 0.0, inside**2, 1.0)
        weight = np.where(pdf > 0, power / np.where(pdf > 0, pdf, 1.0), 0.0)
        found.append((model.f(parameters, wo, wi) * weight).mean(axis=0))
    return np.array(found)


def derivatives(
    model: BsdfModel, parameters: dict[str, Any], wo: Array, wi: Array
) -> dict[str, Array]:
    """How the mean of the channels of f changes with each parameter, (N,) for N pairs.

    All three channels of a color change together.
    """
    rows = {
        name: np.broadcast_to(value, (len(wo), *np.shape(value)))
        for name, value in parameters.items()
    }
    slopes = model.f_backward(rows, wo, wi, np.full((len(wo), 3), 1.0 / 3.0))
    return {name: s.sum(axis=1) if s.ndim == 2 else s for name, s in slopes.items()}


# A picture and a benchmark row for every registered reflectance model.


MANY = 12
"""Parameters: more of them are labelled in narrower lines."""
_FRACTIONS = (0.1, 0.4, 0.7, 1.0)
_COSINES = np.linspace(0.04, 1.0, 9)
_LIGHT = np.array([-0.5, 0.6, 0.62]) / np.linalg.norm([-0.5, 0.6, 0.62])


def gallery_picture(model: BsdfModel, path: Path) -> None:
    """Write a PNG: what a model looks like, what it returns, and what its parameters do.

    Above, four lit spheres over the range of the parameters, and the lobe below each. The spheres
    are seen from +Z without perspective, under one distant light of irradiance pi; the lobes show
    f cos for light that arrives at 45 degrees. Below, the part of the light that leaves, by the
    cosine of the view, for the same parameters; and the derivative of the second sphere by each
    parameter, red where more of it brightens and blue where it darkens.
    """
    figure = Figure(figsize=(9.0, 6.6))
    FigureCanvasAgg(figure)
    # Room for a line of each parameter above the balls; a computed layout would double the time.
    balls = {"left": 0.04, "right": 0.96, "bottom": 0.31, "top": 0.87, "wspace": 0.35}
    grid = figure.add_gridspec(2, 4, hspace=0.15, **balls)
    curve = figure.add_axes((0.06, 0.07, 0.2, 0.17))
    for column, fraction in enumerate(_FRACTIONS):
        parameters = model.at(fraction)
        sphere = figure.add_subplot(grid[0, column])
        sphere.imshow(srgb_encode(np.clip(sphere_picture(model, parameters), 0.0, 1.0)))
        sphere.axis("off")
        size = 7 if len(parameters) < 6 else 3.6 if len(parameters) > MANY else 5
        sphere.set_title(_caption(parameters), fontsize=size)
        lobe = figure.add_subplot(grid[1, column], projection="polar")
        angle, value = _lobe(model, parameters)
        lobe.plot(np.pi / 2 - angle, value, lw=1.5, color=f"C{column}")
        if not model.transmits:
            lobe.set_xlim(0.0, np.pi)
        lobe.tick_params(labelsize=6)
        lobe.set_yticks(lobe.get_yticks()[2::3])
        curve.plot(_COSINES, furnace_curve(model, parameters, _COSINES).mean(axis=1), lw=1.2)
    _finish_curve(curve, model)
    _draw_derivatives(figure, model, model.at(_FRACTIONS[1]))
    figure.suptitle(model.name, y=0.995)
    figure.savefig(path, dpi=110, metadata={"Software": None})


def _finish_curve(axes: Axes, model: BsdfModel) -> None:
    kind, most = model.energy
    axes.axhline(1.0, color="0.6", lw=0.8)
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, None))
    axes.tick_params(labelsize=6)
    axes.set_title("light returned, by the cosine of the view", fontsize=7)
    claim = f"{kind}, at most {most:g}" if kind == "gains" else kind
    axes.set_xlabel(f"claim: {claim}", fontsize=7, labelpad=1)


def _draw_derivatives(figure: Figure, model: BsdfModel, parameters: dict[str, Any]) -> None:
    """A ball of d(radiance, mean of channels) for each parameter, each to a scale of its own."""
    inside, wo, wi = sphere_directions(64)
    slopes = derivatives(model, parameters, wo, wi)
    across = max(4, len(slopes) if len(slopes) < 7 else -(-len(slopes) // 2))
    size = min(0.66 / across, 0.14)
    long = max(map(len, slopes)) > 14  # names
    for number, (name, slope) in enumerate(slopes.items()):
        down, column = divmod(number, across)
        rows = -(-len(slopes) // across)
        corner = 0.3 + column * 0.68 / across, 0.03 + (rows - 1 - down) * 0.125
        many = len(slopes) > MANY
        axes = figure.add_axes((*corner, size, (0.15 if many else 0.18) / rows))
        picture = np.zeros(inside.shape)
        picture[inside] = slope * np.pi * np.clip(wi[:, 2], 0.0, None)
        limit = float(np.quantile(np.abs(picture[inside]), 0.97)) or 1.0
        axes.imshow(picture, cmap="RdBu_r", vmin=-limit, vmax=limit)
        label = "\n".join(name.rsplit("_", 1)) if many else f"d / d {name}"
        axes.set_title(f"{label}\n\u00b1{limit:.2g}", fontsize=5 if long or rows > 1 else 6, pad=2)
        axes.axis("off")


def _caption(parameters: dict[str, Array]) -> str:
    parts = [f"{name} {np.round(np.mean(value), 2):g}" for name, value in parameters.items()]
    # As many names to a line as keep the block below the title.
    across = 2 if len(parts) > MANY else 1 + (len(parts) - 1) // 5
    lines = [parts[k : k + across] for k in range(0, len(parts), across)]
    return "\n".join(", ".join(line) for line in lines)


def sphere_directions(size: int) -> tuple[Array, Array, Array]:
    """A ball that fills a square picture, seen from +Z, under one distant light up to the left.

    Returns:
        Where the ball is (size, size), and wo and wi (N, 3) in the shading frames of its N pixels.
    """
    x = (np.arange(size) + 0.5) / size * 2.2 - 1.1
    right, up = np.meshgrid(x, -x)
    inside = right**2 + up**2 < 1.0
    normal = np.stack([right, up, np.sqrt(np.clip(1 - right**2 - up**2, 0, 1))], -1)[inside]
    view = np.array([0.0, 0.0, 1.0])
    tangent = np.cross([0.0, 1.0, 0.0], normal)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True) + 1e-12
    frame = np.stack([tangent, np.cross(normal, tangent), normal], axis=1)
    return inside, frame @ view, frame @ _LIGHT


def sphere_picture(model: BsdfModel, parameters: dict[str, Any], size: int = 160) -> Array:
    """Radiance (size, size, 3) of that ball under irradiance pi, on a white ground."""
    inside, wo, wi = sphere_directions(size)
    image = np.ones((size, size, 3))
    image[inside] = model.f(parameters, wo, wi) * np.pi * np.clip(wi[:, 2:], 0.0, None)
    return image


def _lobe(model: BsdfModel, parameters: dict[str, Array]) -> tuple[Array, Array]:
    """Angles from the normal (A,) and f cos, mean over channels (A,), in the plane of incidence."""
    # In the horizon itself sheen grows without bound.
    reach, count = (np.pi, 360) if model.transmits else (0.499 * np.pi, 361)
    angle = np.linspace(-reach, reach, count)
    wo = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=1)
    wi = np.broadcast_to([-np.sqrt(0.5), 0.0, np.sqrt(0.5)], wo.shape).copy()
    return angle, model.f(parameters, wo, wi).mean(axis=1) * np.sqrt(0.5)


def benchmark_row(model: BsdfModel, *, count: int = 1_000_000, seed: int = 1) -> dict[str, Any]:
    """Evaluations a second of value and adjoint in float32, one row of parameters for each.

    Returns:
        {"workload", "model", "count", "forward_per_s", "backward_per_s", "mean"}.
    """
    rows = np.arange(count)
    u = uniform(seed, pixel=rows[:, None], dimension=np.arange(4)).astype(np.float32)
    wo, wi = (_cosine(u[:, 2 * k : 2 * k + 2]) for k in range(2))
    parameters = {
        name: np.broadcast_to(value, (count, *np.shape(value))).copy()
        for name, value in model.at(0.5).items()
    }
    packed = model.pack(parameters, np.float32)
    start = time.perf_counter()
    value = model.core.f(packed, wo, wi)
    middle = time.perf_counter()
    model.core.f_backward(packed, wo, wi, value, np.zeros_like(packed))
    end = time.perf_counter()
    return {
        "workload": "bsdf",
        "model": model.name,
        "count": count,
        "forward_per_s": count / (middle - start),
        "backward_per_s": count / (end - middle),
        "mean": float(value.mean()),
    }


def _cosine(u2: Array) -> Array:
    radius, angle = np.sqrt(0.9996 * u2[:, 0]), 2.0 * np.pi * u2[:, 1]
    up = np.sqrt(1.0 - radius**2)
    return np.ascontiguousarray(
        np.stack([radius * np.cos(angle), radius * np.sin(angle), up], axis=1), np.float32
    )
