"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from photograd_course.viz.handout import subplots
from photograd_course.viz.style import BLUE, INK, ORANGE, plain_axes

BOWL = np.array([1.0, 20.0])  # curvatures: condition number 20


START = np.array([-2.0, 0.55])


def _panels(height, *widths):
    """A figure, and its panels of relative widths side by side."""
    figure, panels = subplots(7.0, height, 1, len(widths), width_ratios=widths, squeeze=False)
    for each in panels[0]:
        plain_axes(each)
    return figure, panels[0]


def _bowl(axes, title):
    """Contours of the quadratic of Figures 1 and 5, and its minimum."""
    x, y = np.meshgrid(np.linspace(-2.25, 1.0, 160), np.linspace(-1.1, 1.1, 120))
    level = 0.5 * (BOWL[0] * x**2 + BOWL[1] * y**2)
    axes.contour(x, y, level, levels=np.geomspace(0.05, 12.0, 8), colors="#c9ced3", linewidths=0.8)
    axes.plot(0.0, 0.0, "+", color=INK, ms=9, mew=1.4)
    axes.set(xlim=(-2.25, 1.0), ylim=(-1.1, 1.1), xlabel="flat coordinate", title=title)
    axes.grid(visible=False)


def draw(module):
    """An ill-conditioned quadratic: zig-zag, best learning rate, momentum."""

    def f(x):
        return float(0.5 * x @ (BOWL * x))

    def grad(x):
        return BOWL * x

    n, best = 40, 2.0 / 21.0
    zigzag = module.gd_nd(f, grad, START, 1.9 / 20.0, n)[0]
    fixed = module.gd_nd(f, grad, START, best, n)[0]
    wrong = module.gd_nd(f, grad, START, 2.02 / 20.0, n)
    root = np.sqrt(BOWL)
    tau, beta = 4.0 / root.sum() ** 2, ((root[1] - root[0]) / root.sum()) ** 2
    ball = module.momentum(grad, START, float(tau), float(beta), n)
    size = {name: np.linalg.norm(x, axis=1) for name, x in (("fixed", fixed), ("ball", ball))}
    rate = float((size["fixed"][-1] / size["fixed"][-21]) ** (1 / 20))
    claims = {
        "the steep coordinate changes sign in each step": (
            zigzag[1:, 1] * zigzag[:-1, 1] < 0.0
        ).all(),
        "the flat one converges from one side": (zigzag[:, 0] < 0.0).all(),
        "the factor per step is 19/21 within 2 %": rate * 21.0 / 19.0,
        "just above the bound it diverges": wrong[2],
        "after 40 steps momentum is sixty thousand times nearer": size["fixed"][-1]
        / size["ball"][-1],
        "tau is 0.134": tau,
        "beta is 0.403": beta,
        "the roots of Eq. (15) coincide for both curvatures": np.abs(
            (1.0 + beta - tau * BOWL) ** 2 - 4.0 * beta
        ).max(),
    }
    figure, (a, b, c) = _panels(2.9, 2.0, 2.0, 1.1)
    for axes, walk, color, mark, title in (
        (a, fixed, ORANGE, "s", "constant 2 / (1 + 20)"),
        (b, ball, BLUE, "o", "momentum, β = 0.403"),
    ):
        _bowl(axes, title)
        axes.plot(*walk[:26].T, f"{mark}-", color=color, ms=3.2, lw=1.0)
    a.set_ylabel("steep coordinate")
    b.tick_params(labelleft=False)
    steps = np.arange(n + 1)
    c.semilogy(steps, size["fixed"], color=ORANGE)
    c.semilogy(steps, size["ball"], color=BLUE)
    c.set_title("distance")
    c.set_xlabel("step k")
    return figure, claims
