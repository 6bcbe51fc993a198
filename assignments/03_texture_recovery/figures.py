"""The figures of assignment 03, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.metrics import psnr
from photograd_course.viz.handout import Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, FRAME, GRAY, INK, ORANGE, signed_color_map
from photograd_course.viz.style import RED as CRIMSON


def fig1_photograph(module: ModuleType) -> tuple[Figure, Facts]:
    """An image recovered from random samples, with a patch that was not measured."""
    truth = landscape(72, 108)
    rng = np.random.default_rng(2)
    uv = rng.random((120_000, 2))
    hole = np.hypot((uv[:, 0] - 0.72) * 1.5, uv[:, 1] - 0.7) < 0.17
    uv = uv[~hole]
    target = module.bilinear_sample(truth, uv)
    start = np.broadcast_to(rng.random((72, 108, 1)), truth.shape).copy()
    early = module.recover_texture(start, uv, target, 3)[0]
    T, losses, unseen = module.recover_texture(start, uv, target, 40)
    seen = ~unseen
    error = np.abs(T - truth)[seen]
    worst = np.argwhere(seen)[np.argmax(error.max(axis=1))]
    worst_to_rim = float(np.hypot(*(np.argwhere(unseen) - worst).T).min())
    samples = _mean_of_samples(uv[:3000], target[:3000], truth.shape)
    facts: Facts = {
        "over 95 % of the measured values are right to 0.02": Fact((error < 0.02).mean(), 0.95, 1),
        "the worst lies at the border of the patch": Fact(worst_to_rim, 0, 1.5),
        "some 112,000 samples": Fact(len(uv), 111_500, 113_500),
        "unseen texels do not change": Fact(np.array_equal(T[unseen], start[unseen])),
        "unseen texels lie in the patch": Fact(unseen.mean(), 0.04, 0.07),
        "the loss falls with every step": Fact((np.diff(losses) < 0).all()),
        "after 3 steps noise is still visible": Fact(psnr(early[seen], truth[seen]), 12, 32),
        "over half of the error is gone by then": Fact(
            np.linalg.norm((early - truth)[seen]) / np.linalg.norm((start - truth)[seen]), 0.2, 0.5
        ),
        "over a third of the values of the dark half are negative then": Fact(
            (early[36:][seen[36:]] < 0).mean(), 1 / 3, 0.6
        ),
    }
    figure = Figure(figsize=(7.0, 4.9), layout="constrained")
    shown = (
        (samples, "3,000 of the samples"),
        (start, "start: noise"),
        (early, "3 steps"),
        (T, "40 steps"),
    )
    for k, (values, title) in enumerate(shown):
        axes = figure.add_subplot(2, 2, k + 1)
        axes.imshow(_screen(values), interpolation="nearest")
        axes.set(xticks=[], yticks=[], title=title)
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


def landscape(rows: int, columns: int) -> np.ndarray:
    """Hills in haze over a lake, by formulas: linear values (rows, columns, 3) in [0, 1]."""
    rng = np.random.default_rng(11)
    u, v = ((np.arange(n) + 0.5) / n for n in (columns, rows))
    down = np.broadcast_to(v[:, None, None], (rows, columns, 1))
    from_sun = np.hypot((u[None, :] - 0.34) * 1.5, v[:, None] - 0.30)[:, :, None]
    picture = np.array([0.10, 0.22, 0.48]) * (1 - down) + np.array([0.62, 0.42, 0.30]) * down
    picture = picture + np.exp(-12 * from_sun**2) * np.array([0.50, 0.30, 0.10])
    sun = np.clip((0.05 - from_sun) * rows, 0, 1)
    picture = picture * (1 - sun) + sun * np.array([1.0, 0.93, 0.75])
    for layer in range(4):
        ridge = 0.42 + 0.065 * layer + (0.09 - 0.012 * layer) * _ridge(rng, u, 1.5 + 0.8 * layer)
        below = down - ridge[None, :, None]
        cover = np.clip(below * rows + 0.5, 0, 1)
        haze = np.clip(0.72 - 0.24 * layer + 1.4 * np.clip(below, 0, 1), 0, 0.85)
        wood = np.array([0.020, 0.050, 0.035]) * (1 + 0.6 * _clouds(rng, rows, columns))
        hill = haze * np.array([0.42, 0.37, 0.40]) + (1 - haze) * wood
        picture = picture * (1 - cover) + cover * hill
    shore = 0.74
    source = np.clip(((2 * shore - v) * rows).astype(int), 0, rows - 1)
    ripples = 0.82 + 0.10 * np.sin(0.9 / (down - shore + 0.02) + 2 * _clouds(rng, rows, columns))
    return np.clip(np.where(down > shore, picture[source] * ripples, picture), 0, 1)


def _ridge(rng: np.random.Generator, u: np.ndarray, frequency: float) -> np.ndarray:
    """A rough line in about [-1, 1]: sines of decreasing period."""
    line = np.zeros(u.shape)
    for octave in range(5):
        line += 0.45**octave * np.sin(2 * np.pi * (frequency * 1.9**octave * u + rng.random()))
    return line / 1.4


def _clouds(rng: np.random.Generator, rows: int, columns: int) -> np.ndarray:
    """Noise (rows, columns, 1) of mean 0 and variance 1, strong in its large features."""
    wave = np.hypot(*np.meshgrid(np.fft.fftfreq(rows) * rows, np.fft.fftfreq(columns) * columns))
    spectrum = np.fft.fft2(rng.normal(size=(rows, columns))) / (2 + wave.T) ** 1.3
    noise = np.fft.ifft2(spectrum).real
    return ((noise - noise.mean()) / noise.std())[:, :, None]


def _mean_of_samples(uv: np.ndarray, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Samples as dots on white, for display only."""
    picture = np.ones(shape)
    cell = np.clip((uv[:, ::-1] * shape[:2]).astype(int), 0, np.array(shape[:2]) - 1)
    picture[cell[:, 0], cell[:, 1]] = values
    return picture


def _centers(shape: tuple[int, int]) -> np.ndarray:
    v, u = np.meshgrid(*((np.arange(n) + 0.5) / n for n in shape), indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1)


def _screen(linear: np.ndarray) -> np.ndarray:
    """Linear radiance, gamma-encoded for display."""
    return np.clip(linear, 0, 1) ** (1 / 2.2)


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
