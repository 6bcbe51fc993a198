"""The figures of assignment 03, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.build.kit_module import kit_module
from photograd_course.metrics import psnr
from photograd_course.viz.handout import Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, FRAME, GRAY, INK, ORANGE, signed_color_map
from photograd_course.viz.style import RED as CRIMSON

FIGURE_1 = kit_module("03_texture_recovery", "figure_1")


def fig1_photograph(module: ModuleType) -> tuple[Figure, Facts]:
    """An image recovered from random samples, with a patch that was not measured."""
    figure, found = FIGURE_1.draw(module)
    facts: Facts = {
        "over 95 % of the measured values are right to 0.02": Fact(
            found["over 95 % of the measured values are right to 0.02"], 0.95, 1
        ),
        "the worst lies at the border of the patch": Fact(
            found["the worst lies at the border of the patch"], 0, 1.5
        ),
        "some 112,000 samples": Fact(found["some 112,000 samples"], 111_500, 113_500),
        "unseen texels do not change": Fact(found["unseen texels do not change"]),
        "unseen texels lie in the patch": Fact(found["unseen texels lie in the patch"], 0.04, 0.07),
        "the loss falls with every step": Fact(found["the loss falls with every step"]),
        "after 3 steps noise is still visible": Fact(
            found["after 3 steps noise is still visible"], 12, 32
        ),
        "over half of the error is gone by then": Fact(
            found["over half of the error is gone by then"], 0.2, 0.5
        ),
        "over a third of the values of the dark half are negative then": Fact(
            found["over a third of the values of the dark half are negative then"], 1 / 3, 0.6
        ),
    }
    return figure, facts


def fig2_surface(module: ModuleType) -> tuple[Figure, Facts]:
    """Six texels, and their bilinear interpolation."""
    T = np.array([[0.2, 0.9, 0.5], [0.7, 0.1, 1.0]])[:, :, None]
    fine = (240, 360)
    surface = module.bilinear_sample(T, _centers(fine)).reshape(fine)
    u, v = _centers((1, 361))[:, 0], 0.36
    line = module.bilinear_sample(T, np.stack([u, np.full(361, v)], axis=1))[:, 0]
    at_centers = module.bilinear_sample(T, _centers((2, 3))).reshape(2, 3)
    bend = np.abs(np.diff(line, 2))
    bent = u[1:-1][bend > 1e-6]
    to_center = np.abs(bent[:, None] - np.array([1 / 6, 1 / 2, 5 / 6])).min(axis=1)
    facts: Facts = {
        "at a center the surface is the texel": Fact(np.allclose(at_centers, T[:, :, 0])),
        "flat beyond the outermost centers": Fact(np.ptp(surface[:, :60], axis=1).max() < 1e-12),
        "never outside the texels' range": Fact(surface.min(), 0.1 - 1e-12, 1.0),
        "bends only at columns of centers": Fact(len(bent) >= 3 and to_center.max() < 1 / 361),
    }
    figure, (left, middle, right) = subplots(7.0, 2.1, 1, 3)
    extent = (0.0, 1.0, 1.0, 0.0)
    shown = ((left, T[:, :, 0], "texels T[i, j]"), (middle, surface, "sample at (u, v)"))
    for axes, values, title in shown:
        axes.imshow(values, cmap="gray", vmin=0, vmax=1, extent=extent, aspect=2 / 3)
        axes.plot(*_centers((2, 3)).T, "o", color=ORANGE, markersize=5, markeredgecolor="white")
        axes.set_title(title)
        axes.set_xlabel("u")
        axes.set_xticks([0, 0.5, 1])
        axes.set_yticks([0, 0.5, 1])
    left.set_ylabel("v")
    middle.axhline(v, color=BLUE, linewidth=1.5, linestyle="--")
    for i in range(2):
        for j in range(3):
            x, y = (j + 0.5) / 3, (i + 0.5) / 2
            left.annotate(
                f"[{i}, {j}]\n\n{T[i, j, 0]:.1f}",
                (x, y),
                ha="center",
                va="center",
                fontsize=8,
                color="white" if T[i, j, 0] < 0.6 else INK,
            )
    right.plot(u, line, color=BLUE)
    for c in (1 / 6, 0.5, 5 / 6):
        right.axvline(c, color=ORANGE, linewidth=0.8, linestyle=":")
    right.set(title=f"along v = {v}", xlabel="u", xlim=(0, 1), ylim=(0, 1), box_aspect=2 / 3)
    right.set(xticks=[0, 0.5, 1], yticks=[0, 0.5, 1])
    right.grid(visible=True)
    return figure, facts


def fig3_adjoint(module: ModuleType) -> tuple[Figure, Facts]:
    """Three samples of a texture; their derivatives are scattered to the texels."""
    shape = (4, 6)
    uv = np.array([[0.30, 0.30], [0.71, 0.58], [0.985, 0.93], [0.71, 0.58]])
    g = np.array([[1.0], [-0.7], [0.8], [-0.3]])
    back = module.bilinear_sample_adjoint(shape, uv, g)[:, :, 0]
    alone = np.zeros(shape)
    for k in range(4):
        one = slice(k, k + 1)
        alone += module.bilinear_sample_adjoint(shape, uv[one], g[one])[:, :, 0]
    x = np.random.default_rng(3).uniform(-1, 1, (*shape, 1))
    left, right = np.vdot(module.bilinear_sample(x, uv), g), np.vdot(x[:, :, 0], back)
    facts: Facts = {
        "nine texels have a derivative": Fact(np.count_nonzero(back), 9, 9),
        "the derivatives sum to the sum of g": Fact(back.sum() - g.sum(), -1e-12, 1e-12),
        "two samples at one point are summed": Fact(np.allclose(back, alone, atol=1e-12)),
        "the corner texel gets all of its sample": Fact(back[3, 5], 0.8 - 1e-12, 0.8 + 1e-12),
        "<S x, g> = <x, S* g>": Fact(left - right, -1e-12, 1e-12),
    }
    figure, panels = subplots(7.0, 2.75, 1, 2)
    titles = ("samples with their g", "adjoint: derivatives of texels")
    for axes, title in zip(panels, titles, strict=True):
        _grid(axes, shape)
        axes.set_title(title)
    panels[0].plot(*_centers(shape).T, ".", color=GRAY, markersize=4)
    colors = {"cmap": signed_color_map(), "vmin": -1, "vmax": 1}
    panels[0].scatter(
        *uv[:3].T, c=[1.0, -1.0, 0.8], s=70, edgecolors=INK, zorder=3, clip_on=False, **colors
    )
    for k, value in enumerate(("+1.0", "−0.7 and −0.3", "+0.8 ")):
        note(
            panels[0],
            value,
            uv[k],
            (0, 9),
            ha="right" if k == 2 else "center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
        )
    panels[0].set(xlim=(0, 1), ylim=(1, 0))
    image = panels[1].imshow(back, extent=(0, 1, 1, 0), aspect=4 / 6, **colors)
    for i, j in np.argwhere(back != 0):
        panels[1].text(
            (j + 0.5) / 6,
            (i + 0.5) / 4,
            f"{back[i, j]:+.2f}".replace("-", "−"),
            ha="center",
            va="center",
            color="white" if abs(back[i, j]) > 0.55 else INK,
        )
    figure.colorbar(image, ax=panels[1], ticks=[-1, 0, 1], shrink=0.8)
    return figure, facts


def fig4_step(module: ModuleType) -> tuple[Figure, Facts]:
    """PSNR of the texture against steps, for learning rates around the largest stable one."""
    rng = np.random.default_rng(0)
    truth, uv = rng.random((32, 32, 1)), rng.random((20_000, 2))
    target = module.bilinear_sample(truth, uv)
    bound = 2 / module.largest_curvature((32, 32), uv, 200)
    steps = 60
    errors = {}
    for share in (0.3, 0.6, 0.95, 1.05):
        T = np.full(truth.shape, 0.5)
        errors[share] = [psnr(T, truth)]
        for _ in range(steps):
            T = T - share * bound * module.loss_and_grad(T, uv, target)[1]
            errors[share].append(psnr(T, truth))
    peak = int(np.argmax(errors[1.05]))
    facts: Facts = {
        "0.95 of the bound: over 55 dB after 25 steps": Fact(errors[0.95][25], 55, 80),
        "0.95 never gets worse": Fact((np.diff(errors[0.95]) > 0).all()),
        "0.3 is slower": Fact(errors[0.3][25] - errors[0.95][25], -60, -10),
        "1.05 first looks well": Fact(max(errors[1.05]), 20, 40),
        "1.05 then loses more than 10 dB": Fact(max(errors[1.05]) - errors[1.05][-1], 10, 100),
        "and it turns after 5 steps or more": Fact(peak, 5, 55),
    }
    figure, axes = subplots(7.0, 2.9)
    looks = {0.3: (GRAY, ":"), 0.6: (ORANGE, "-."), 0.95: (BLUE, "-"), 1.05: (CRIMSON, "--")}
    for share, values in errors.items():
        color, dashes = looks[share]
        axes.plot(values, color=color, linestyle=dashes, label=f"{share:g}")
        place = {0.3: -3, 0.6: -3, 0.95: 3, 1.05: -3}[share]
        note(
            axes,
            f"{share:g} · 2/λ",
            (steps, values[-1]),
            (4, place),
            color=color if share != 0.3 else INK,
            va="center",
        )
    axes.set(xlabel="step", ylabel="PSNR of the texture [dB]", xlim=(0, 74))
    axes.grid(visible=True)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, facts


def fig5_mips(module: ModuleType) -> tuple[Figure, Facts]:
    """A fine pattern minified: every fourth texel, and the mip level of that size."""
    i, j = np.mgrid[0:128, 0:128] / 128
    rings = (0.5 + 0.5 * np.cos(150 * (i**2 + j**2)))[:, :, None]
    levels = module.build_mips(rings)
    coarse, picked = levels[2], rings[2::4, 2::4]
    fine_half = (i[::4, ::4] ** 2 + j[::4, ::4] ** 2) > 0.9
    facts: Facts = {
        "eight levels": Fact(len(levels), 8, 8),
        "each level has the same mean": Fact(
            max(abs(float(level.mean() - rings.mean())) for level in levels), 0, 1e-12
        ),
        "picked texels alias where the rings are fine": Fact(picked[fine_half].std(), 0.3, 0.4),
        "about half of the false contrast remains where rings are of medium width": Fact(
            coarse[6:14, 6:14].std() / picked[6:14, 6:14].std(), 0.4, 0.65
        ),
        "the mip level is uniform there": Fact(coarse[fine_half].std(), 0, 0.05),
    }
    figure = Figure(figsize=(7.0, 2.6), layout="constrained")
    shown = ((rings, "texture, 128 × 128"), (picked, "every 4th texel"), (coarse, "mip level 2"))
    for k, (values, title) in enumerate(shown):
        axes = figure.add_subplot(1, 3, k + 1)
        axes.imshow(values[:, :, 0], cmap="gray", vmin=0, vmax=1, interpolation="nearest")
        axes.set(xticks=[], yticks=[], title=title)
    return figure, facts


def _centers(shape: tuple[int, int]) -> np.ndarray:
    v, u = np.meshgrid(*((np.arange(n) + 0.5) / n for n in shape), indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1)


def _grid(axes: Axes, shape: tuple[int, int]) -> None:
    for k in range(shape[0] + 1):
        axes.axhline(k / shape[0], color=FRAME, linewidth=0.7)
    for k in range(shape[1] + 1):
        axes.axvline(k / shape[1], color=FRAME, linewidth=0.7)
    axes.set(xlim=(0, 1), ylim=(1, 0), aspect=4 / 6, xticks=[], yticks=[])


FIGURES = figures_of(fig1_photograph, fig2_surface, fig3_adjoint, fig4_step, fig5_mips)
RED = {
    "fig2_surface": "half_texel",
    "fig3_adjoint": "adjoint_last_wins",
    "fig4_step": "curvature_missing_two",
    "fig1_photograph": "unseen_filled",
    "fig5_mips": "mips_picked",
}
