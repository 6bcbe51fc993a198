"""Reflectance that was measured, fitted by models of the registry.

The measurements are those of MERL [Matusik2003] in the form of small networks fitted to them
[Sztrajman2021]: DATA/materials/merl_nbrdf.npz, six numbers in (half and difference vector), 21, 21,
three out, exp(x) - 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.bsdf import registry
from photograd.bsdf.gallery import sphere_directions
from photograd.transport.inverse.parameters import Activation
from photograd_course.optim import Adam
from photograd_course.random import uniform
from photograd_course.schedules import exponential
from photograd_course.viz import style

Array = NDArray[Any]
Reflectance = Callable[[Array, Array], Array]
"""(wo, wi), (N, 3) each, to (N, 3), without the cosine."""
MODELS = registry()
FITTED = {
    "blinn_phong": "Blinn-Phong",
    "cook_torrance": "Cook-Torrance",
    "ggx_metal": "GGX metal",
    "disney": "principled (2012)",
}
MATERIALS = ("nickel", "gold-metallic-paint", "red-plastic", "blue-rubber")
FIXED = {"disney": {"anisotropic": 0.0, "sheen_tint": 0.5}}
PAIRS, STEPS, RATE = 4096, 500, 0.1
STARTS = (0.25, 0.5, 0.75)  # of the ranges; the best of three fits counts
HALF_END, DIFFERENCE_END = 66.0, 80.0  # degrees, of the picture
LEVEL = 0.05  # of the logarithm: below it errors count linearly
IMAGE, PULL_OF = "recover_measured.png", "gold-metallic-paint"


def measured(data: Path, name: str) -> Reflectance:
    """The network of a material."""
    with np.load(data / "materials" / "merl_nbrdf.npz") as file:
        number = list(file["names"]).index(name)
        layers = [
            (
                file[f"kernel__dense_{k}"][number].astype(np.float64),
                file[f"bias__dense_{k}"][number].astype(np.float64),
            )
            for k in (1, 2, 3)
        ]

    def value(wo: Array, wi: Array) -> Array:
        x = half_difference(wo, wi)
        for kernel, bias in layers[:2]:
            x = np.maximum(x @ kernel + bias, 0.0)
        return np.maximum(np.expm1(x @ layers[2][0] + layers[2][1]), 0.0)

    return value


def half_difference(wo: Array, wi: Array) -> Array:
    """Half vector at azimuth 0 and difference vector, (N, 6) [Rusinkiewicz1998]."""
    half = (wo + wi) / np.linalg.norm(wo + wi, axis=1, keepdims=True)
    side = np.hypot(half[:, 0], half[:, 1])
    safe = np.maximum(side, 1e-12)
    c, s = np.where(side > 1e-12, [half[:, 0] / safe, half[:, 1] / safe], [[1.0], [0.0]])
    x, y, z = c * wi[:, 0] + s * wi[:, 1], -s * wi[:, 0] + c * wi[:, 1], wi[:, 2]
    turned = [half[:, 2] * x - side * z, y, side * x + half[:, 2] * z]
    return np.stack([side, np.zeros_like(side), half[:, 2], *turned], axis=1)


def directions(theta_h: Array, theta_d: Array, phi_d: Array) -> tuple[Array, Array]:
    """(wo, wi) of half and difference angles in radians, (N, 3) each; half vectors at azimuth 0."""
    d = np.stack(
        [np.sin(theta_d) * np.cos(phi_d), np.sin(theta_d) * np.sin(phi_d), np.cos(theta_d)], axis=-1
    )
    c, s = np.cos(theta_h), np.sin(theta_h)
    wi = np.stack([c * d[:, 0] + s * d[:, 2], d[:, 1], -s * d[:, 0] + c * d[:, 2]], axis=-1)
    half = np.stack([s, np.zeros_like(s), c], axis=-1)
    return 2 * (wi * half).sum(axis=1, keepdims=True) * half - wi, wi


def pairs(seed: int, count: int = PAIRS) -> tuple[Array, Array]:
    """Directions (M, 3) above the surface by 5 degrees; highlights are looked at closely."""
    u = uniform(seed, pixel=np.arange(3 * count)[:, None], dimension=np.arange(3)[None, :])
    wo, wi = directions(0.5 * np.pi * u[:, 0] ** 2, 0.45 * np.pi * u[:, 1], np.pi * u[:, 2])
    above = np.minimum(wo[:, 2], wi[:, 2]) > np.sin(np.radians(5.0))
    return wo[above][:count], wi[above][:count]


def loss(f: Array, target: Array, cosine: Array) -> float:
    """The mean of (log(LEVEL + f cos) - log(LEVEL + target cos))^2."""
    return float(np.square(_logs(f, cosine) - _logs(target, cosine)).mean())


def loss_backward(f: Array, target: Array, cosine: Array) -> Array:
    """dL/df = 2 (log - log) cos / (LEVEL + f cos) / N, (N, 3)."""
    difference = _logs(f, cosine) - _logs(target, cosine)
    return np.asarray(2 * difference * cosine / (LEVEL + f * cosine) / f.size)


def _logs(f: Array, cosine: Array) -> Array:
    return np.asarray(np.log(LEVEL + f * cosine))


@dataclass(frozen=True)
class Fit:
    """What a model came to: its parameters, their loss, and dL/dparameters there."""

    model: str
    values: dict[str, Array]
    loss: float
    slope: dict[str, Array]


def fitted(
    model: str, target: Reflectance, steps: int = STEPS, starts: tuple[float, ...] = STARTS
) -> Fit:
    """The best of fits from several starts, by Adam on pairs of directions."""
    return min(
        (_fitted_from(model, target, start, steps) for start in starts), key=lambda fit: fit.loss
    )


def _fitted_from(model: str, target: Reflectance, start: float, steps: int) -> Fit:
    functions, fixed = MODELS[model], FIXED.get(model, {})
    wo, wi = pairs(1)
    truth, cosine = target(wo, wi), wi[:, 2:]
    activations, x = {}, {}
    for parameter in functions.parameters:
        if parameter.name not in fixed:
            activations[parameter.name] = _activation(parameter.lo, parameter.hi)
            first = np.full((parameter.size,) if parameter.size > 1 else (), start)
            low, high = _ends(parameter.lo, parameter.hi)
            x[parameter.name] = activations[parameter.name].inverse(low * (high / low) ** first)
    adam, factor = Adam(beta_2=0.98), exponential(0.02, steps)

    def state() -> tuple[dict[str, Any], float, dict[str, Array]]:
        values = {name: activations[name].value(each) for name, each in x.items()} | fixed
        f = functions.f(values, wo, wi)
        found = functions.f_backward(values, wo, wi, loss_backward(f, truth, cosine))
        slope = {name: found[name].reshape(x[name].shape) for name in x}
        d_x = {name: activations[name].value_backward(x[name], slope[name]) for name in x}
        return values, loss(f, truth, cosine), d_x

    for step in range(steps):
        _, _, d_x = state()
        adam.step(x, d_x, RATE * factor(step))
    values, final, d_x = state()
    return Fit(model, values, final, d_x)


def _ends(lo: float, hi: float) -> tuple[float, float]:
    """Between which starts are taken."""
    return max(lo, 0.02 * hi), 0.98 * hi


def _activation(lo: float, hi: float) -> Activation:
    """Exponents go over decades."""
    return Activation("log", lo, np.inf) if hi > 10 else Activation("logit", lo, hi)


def picture_error(fit: Fit, target: Reflectance, size: int = 96) -> float:
    """Root mean square of the difference of two balls under one light, by that of the true one."""
    _, wo, wi = sphere_directions(size)
    lit = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    wo, wi = np.ascontiguousarray(wo[lit]), np.ascontiguousarray(wi[lit])
    true = target(wo, wi) * wi[:, 2:]
    found = MODELS[fit.model].f(fit.values, wo, wi) * wi[:, 2:]
    return float(np.sqrt(np.square(found - true).mean() / np.square(true).mean()))


def pull(fit: Fit, target: Reflectance, angles: int = 30) -> Array:
    """What the loss asks of f, dL/df f summed over channels, (theta_h, theta_d) in degrees.

    By f, so that it is a relative change: negative asks for more. Phi_d is a right angle. NaN where
    a direction is below the surface.
    """
    theta_h, theta_d = np.meshgrid(
        np.radians((np.arange(angles) + 0.5) * HALF_END / angles),
        np.radians((np.arange(angles) + 0.5) * DIFFERENCE_END / angles),
        indexing="ij",
    )
    flat = theta_h.reshape(-1)
    wo, wi = directions(flat, theta_d.reshape(-1), np.full_like(flat, 0.5 * np.pi))
    above = np.minimum(wo[:, 2], wi[:, 2]) > np.sin(np.radians(5.0))
    found = np.full(len(flat), np.nan)
    f = MODELS[fit.model].f(fit.values, wo[above], wi[above])
    d_f = loss_backward(f, target(wo[above], wi[above]), wi[above][:, 2:])
    found[above] = (d_f * f).sum(axis=1) * len(flat)
    return found.reshape(theta_h.shape)


def measure(data: Path) -> tuple[list[str], Figure]:
    """Lines of the page, and the figure."""
    fits = {
        name: {model: fitted(model, measured(data, name)) for model in FITTED} for name in MATERIALS
    }
    lines = [
        f"{PAIRS} pairs of directions, {STEPS} steps, the best of {len(STARTS)} starts. First the "
        f"error that was made small, the root mean square of log({LEVEL} + f cos) over channels "
        "and pairs; behind it how far a ball under one light is off, by root mean squares. The "
        "least of each row is bold. Cook-Torrance and GGX are metals here, without a diffuse "
        "ground.",
        "",
        "| material | " + " | ".join(FITTED.values()) + " |",
        "|---|" + "---|" * len(FITTED),
    ]
    for name, row in fits.items():
        best = min(fit.loss for fit in row.values())
        cells = []
        for fit in row.values():
            text = f"{np.sqrt(fit.loss):.3f}"
            text = f"**{text}**" if fit.loss == best else text
            cells.append(f"{text}, {100 * picture_error(fit, measured(data, name)):.0f} %")
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    lines += ["", *_found(fits)]
    return lines, measured_figure(data, fits)


def _found(fits: dict[str, dict[str, Fit]]) -> list[str]:
    """What the principled model and the metals say, in numbers."""
    lines = [
        "| material | GGX roughness | Beckmann slope | Blinn exponent | principled |",
        "|---|---|---|---|---|",
    ]
    for name, row in fits.items():
        sliders = row["disney"].values
        told = ", ".join(
            f"{key} {float(sliders[key]):.2f}" for key in ("roughness", "metalness", "clearcoat")
        )
        numbers = (row["ggx_metal"].values["roughness"], row["cook_torrance"].values["slope"])
        exponent = float(row["blinn_phong"].values["exponent"])
        cells = [*(f"{float(x):.2f}" for x in numbers), f"{exponent:.0f}", told]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def measured_figure(data: Path, fits: dict[str, dict[str, Fit]]) -> Figure:
    """Lobes of all materials above; what the loss still asks below."""
    wide, gap, left = 1.75, 0.42, 0.5
    with style.house_style():
        figure = style.new_figure(left + 4 * wide + 3 * gap + 0.15, 5.5)
        for k, name in enumerate(MATERIALS):
            axes = style.place_axes(figure, left + k * (wide + gap), 0.35, wide, 1.7)
            _draw_lobes(axes, measured(data, name), fits[name])
            axes.set_title(name)
            if k == 0:
                axes.set_ylabel("f cos, mean of channels")
                axes.legend(fontsize=5.5, loc="upper left")
        maps = {m: pull(fits[PULL_OF][m], measured(data, PULL_OF)) for m in FITTED}
        limit = float(np.nanquantile(np.abs(np.stack(list(maps.values()))), 0.97))
        for k, (model, image) in enumerate(maps.items()):
            axes = style.place_axes(figure, left + k * (wide + gap), 2.85, wide, 1.5)
            axes.imshow(
                image.T,
                origin="lower",
                aspect="auto",
                extent=(0, HALF_END, 0, DIFFERENCE_END),
                interpolation="nearest",
                norm=style.symmetric_scale(limit),
                cmap=style.signed_color_map(),
            )
            axes.set_facecolor("#dfe3e6")
            axes.set_title(FITTED[model])
            axes.set_xlabel("half angle, degrees")
        figure.axes[len(MATERIALS)].set_ylabel("difference angle, degrees")
        style.write_caption(
            figure,
            "Above: reflectance in the plane of incidence, light from 45 degrees; black: measured. "
            f"Below: what the loss still asks of each fit of {PULL_OF}, by half and difference "
            "angle: more (blue) or less (red). At the end of a fit these wishes cancel in every "
            "parameter, and are still there: no slider serves them without hurting others. Towards "
            "grazing light (above) Blinn and Phong's model has no Fresnel term and lacks light; "
            "Schlick's ramp to white, which all others have, brings too much.",
            left=0.15,
            right=0.15,
        )
    return figure


def _draw_lobes(axes: Any, target: Reflectance, row: dict[str, Fit]) -> None:
    angle = np.linspace(-85, 85, 341)
    wo = np.stack(
        [np.sin(np.radians(angle)), np.zeros_like(angle), np.cos(np.radians(angle))], axis=1
    )
    wi = np.broadcast_to([-np.sqrt(0.5), 0.0, np.sqrt(0.5)], wo.shape).copy()
    axes.semilogy(
        angle,
        np.maximum(target(wo, wi).mean(axis=1), 1e-5) * wi[0, 2],
        color="black",
        lw=2.0,
        label="measured",
    )
    colors = (style.BLUE, style.ORANGE, style.RED, "#2e8b57")
    for color, (model, fit) in zip(colors, row.items(), strict=True):
        f = MODELS[model].f(fit.values, wo, wi).mean(axis=1)
        axes.semilogy(
            angle, np.maximum(f, 1e-5) * wi[0, 2], color=color, lw=1.0, label=FITTED[model]
        )
    axes.set_xlabel("view, degrees")
    axes.set_ylim(3e-3, None)
    axes.grid(visible=True)
