"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure
from photograd_course.metrics import psnr


def landscape(rows, columns):
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


def _ridge(rng, u, frequency):
    """A rough line in about [-1, 1]: sines of decreasing period."""
    line = np.zeros(u.shape)
    for octave in range(5):
        line += 0.45**octave * np.sin(2 * np.pi * (frequency * 1.9**octave * u + rng.random()))
    return line / 1.4


def _clouds(rng, rows, columns):
    """Noise (rows, columns, 1) of mean 0 and variance 1, strong in its large features."""
    wave = np.hypot(*np.meshgrid(np.fft.fftfreq(rows) * rows, np.fft.fftfreq(columns) * columns))
    spectrum = np.fft.fft2(rng.normal(size=(rows, columns))) / (2 + wave.T) ** 1.3
    noise = np.fft.ifft2(spectrum).real
    return ((noise - noise.mean()) / noise.std())[:, :, None]


def _mean_of_samples(uv, values, shape):
    """Samples as dots on white, for display only."""
    picture = np.ones(shape)
    cell = np.clip((uv[:, ::-1] * shape[:2]).astype(int), 0, np.array(shape[:2]) - 1)
    picture[cell[:, 0], cell[:, 1]] = values
    return picture


def _screen(linear):
    """Linear radiance, gamma-encoded for display."""
    return np.clip(linear, 0, 1) ** (1 / 2.2)


def draw(module):
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
    claims = {
        "over 95 % of the measured values are right to 0.02": (error < 0.02).mean(),
        "the worst lies at the border of the patch": worst_to_rim,
        "some 112,000 samples": len(uv),
        "unseen texels do not change": np.array_equal(T[unseen], start[unseen]),
        "unseen texels lie in the patch": unseen.mean(),
        "the loss falls with every step": (np.diff(losses) < 0).all(),
        "after 3 steps noise is still visible": psnr(early[seen], truth[seen]),
        "over half of the error is gone by then": np.linalg.norm((early - truth)[seen])
        / np.linalg.norm((start - truth)[seen]),
        "over a third of the values of the dark half are negative then": (
            early[36:][seen[36:]] < 0
        ).mean(),
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
    return figure, claims
