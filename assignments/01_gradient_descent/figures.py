"""The handout's figures. Each function returns (figure, facts); the captions say only facts.

`module` is the solution or a mutant of it. A fact is a bool, or (value, low, high).
"""

import numpy as np
from matplotlib.ticker import MaxNLocator
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Fact, figures_of
from photograd_course.viz.style import BLUE, GRAY, GUIDE, INK, ORANGE
from photograd_course.viz.style import RED as CRIMSON

FIGURE_1 = kit_module("01_gradient_descent", "figure_1")
BOWL = FIGURE_1.BOWL
START = FIGURE_1.START
_panels = FIGURE_1._panels
_bowl = FIGURE_1._bowl

PURPLE = "#542788"


def _slope(x, y):
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def fig1_zigzag(module):
    """An ill-conditioned quadratic: zig-zag, best learning rate, momentum."""
    figure, found = FIGURE_1.draw(module)
    facts = {
        "the steep coordinate changes sign in each step": Fact(
            found["the steep coordinate changes sign in each step"], red="unit_steps"
        ),
        "the flat one converges from one side": Fact(
            found["the flat one converges from one side"], red="unit_steps"
        ),
        "the factor per step is 19/21 within 2 %": Fact(
            found["the factor per step is 19/21 within 2 %"], 0.98, 1.02, red="aliased_trail"
        ),
        "just above the bound it diverges": Fact(
            found["just above the bound it diverges"], red="unit_steps"
        ),
        "after 40 steps momentum is sixty thousand times nearer": Fact(
            found["after 40 steps momentum is sixty thousand times nearer"],
            5.5e4,
            6.5e4,
            red="forgets_velocity",
        ),
        "tau is 0.134": Fact(found["tau is 0.134"], 0.1335, 0.1345, held="chosen by the figure"),
        "beta is 0.403": Fact(found["beta is 0.403"], 0.4025, 0.4035, held="chosen by the figure"),
        "the roots of Eq. (15) coincide for both curvatures": Fact(
            found["the roots of Eq. (15) coincide for both curvatures"],
            0.0,
            1e-12,
            held="follows from tau and beta",
        ),
    }
    return figure, facts


def fig2_two_errors(module):
    """Error of finite differences against eps."""
    points = np.linspace(0.3, 1.1, 9)  # the mean over these averages rounding errors
    eps = 10.0 ** np.arange(-13.0, -0.4, 0.25)

    def values(y):
        return float(np.exp(y[0]))

    def error(quotient):
        off = [[quotient(x, float(e)) / np.exp(x) - 1.0 for e in eps] for x in points]
        return np.sqrt(np.mean(np.square(off), axis=0))

    central = error(lambda x, e: module.numeric_derivative(values, np.array([x]), e)[0])
    forward = error(lambda x, e: (np.exp(x + e) - np.exp(x)) / e)
    wide, narrow = eps >= 1e-3, eps <= 1e-8
    best = float(eps[np.argmin(central)])
    facts = {
        "central differences have slope 2": Fact(
            _slope(eps[wide], central[wide]), 1.9, 2.1, red="forward_difference"
        ),
        "forward differences have slope 1": Fact(
            _slope(eps[wide], forward[wide]), 0.9, 1.1, held="computed here"
        ),
        "below 1e-8 the error grows as 1/eps": Fact(
            _slope(eps[narrow], central[narrow]), -1.3, -0.7, red="missing_half"
        ),
        "central ones are best near 1e-5": Fact(np.log10(best), -6.5, -4.0, red="five_point"),
        "there they are a hundred times better": Fact(
            forward.min() / central.min(), 100.0, 1e6, red="forward_difference"
        ),
    }
    figure, (axes,) = _panels(3.4, 1)
    axes.loglog(eps, forward, "s-", color=ORANGE, ms=3.5, lw=1.0, label="forward, Eq. (1)")
    axes.loglog(eps, central, "o-", color=BLUE, ms=3.5, lw=1.0, label="central, Eq. (3)")
    guide = np.array([3e-4, 3e-1])
    axes.loglog(guide, guide**2 / 6, "--", color=GRAY, lw=1.0)
    axes.loglog(guide, guide / 2, "--", color=GRAY, lw=1.0)
    axes.annotate("slope 2", (1.4e-2, 2.0e-6), color=GUIDE)
    axes.annotate("slope 1", (1.2e-4, 8e-3), color=GUIDE)
    axes.annotate("rounding error: slope −1", (3e-11, 2e-4), color=GUIDE)
    axes.set(xlabel="step ε", ylabel="relative error", ylim=(1e-13, 1.0))
    axes.set_title("derivative of exp by finite differences, nine points between 0.3 and 1.1")
    axes.legend(loc="lower left")
    return figure, facts


def fig3_step_lengths(module):
    """A parabola: distance to the minimum for five learning rates."""
    n = 24
    reaches = (0.2, 1.0, 1.8, 2.0, 2.1)
    walks = {r: module.gd_1d(lambda x: 0.5 * x * x, lambda x: x, 1.0, r, n) for r in reaches}
    x = {r: walk[0] for r, walk in walks.items()}
    facts = {
        "at 0.2 the points stay on one side": Fact((x[0.2] > 0.0).all(), red="no_tau"),
        "at 0.2 the distance falls": Fact((np.diff(np.abs(x[0.2])) < 0.0).all(), red="uphill"),
        "at 1 the first step reaches the minimum": Fact(x[1.0][1] == 0.0, red="uphill"),
        "at 1.8 the sides alternate": Fact(
            (x[1.8][1:] * x[1.8][:-1] < 0.0).all(), red="stale_gradient"
        ),
        "0.2 and 1.8 are equally fast": Fact(
            np.abs(x[1.8][-1] / x[0.2][-1]), 0.999, 1.001, red="clipped_step"
        ),
        "at 2 the distance stays 1": Fact((np.abs(x[2.0]) == 1.0).all(), red="clipped_step"),
        "at 2.1 it has grown tenfold": Fact(np.abs(x[2.1][-1]), 9.0, 11.0, red="clipped_step"),
        "only 2.1 is flagged as wrong": Fact(
            [w[2] for w in walks.values()] == [False] * 4 + [True], red="clipped_step"
        ),
    }
    figure, (left, right) = _panels(3.1, 2.6, 2.4)
    steps = np.arange(n + 1)
    looks = {0.2: (BLUE, "o"), 1.8: (ORANGE, "s"), 2.0: (PURPLE, "^"), 2.1: (CRIMSON, "D")}
    for r, (color, mark) in looks.items():
        size = 5.5 if r == 0.2 else 3.2  # visible behind 1.8
        left.plot(steps[:13], x[r][:13], f"{mark}-", color=color, ms=size, lw=1.0)
        right.semilogy(
            steps, np.abs(x[r]), f"{mark}-", color=color, ms=size, lw=1.0, label=f"{r:g}"
        )
    left.axhline(0.0, color=GRAY, lw=0.8)
    left.set(xlabel="step k", ylabel="x", ylim=(-3.4, 3.4))
    left.set_title("points")
    right.set(xlabel="step k", ylim=(2e-3, 60))
    right.set_title("distance to the minimum")
    right.legend(title="τ λ", ncols=4, loc="upper center", columnspacing=0.9, handlelength=1.2)
    for axes in (left, right):
        axes.xaxis.set_major_locator(MaxNLocator(nbins=5, integer=True))
    return figure, facts


def fig4_two_valleys(module):
    """A function with two minima: start and learning rate decide."""

    def f(x):
        return float((np.float64(x) * x - 1.0) ** 2 + 0.2 * x)

    def df(x):
        return float(4.0 * np.float64(x) * (x * x - 1.0) + 0.2)

    left_end, hump, right_end = np.sort(np.roots([4.0, 0.0, -4.0, 0.2]).real)
    short_left = module.gd_1d(f, df, 0.0, 0.05, 60)[0]
    short_right = module.gd_1d(f, df, 0.1, 0.05, 60)[0]
    long = module.gd_1d(f, df, 1.7, 0.15, 60)[0]
    near = module.gd_1d(f, df, 1.7, 0.05, 60)[0]
    facts = {
        "from 0 the run ends on the left": Fact(
            short_left[-1] - left_end, -1e-6, 1e-6, red="uphill"
        ),
        "from 0.1 it ends on the right": Fact(
            short_right[-1] - right_end, -1e-6, 1e-6, red="uphill"
        ),
        "the local maximum lies between 0 and 0.1": Fact(
            hump, 0.0, 0.1, held="a root of the derivative"
        ),
        "the run from 0 ends lower": Fact(f(short_left[-1]) < f(short_right[-1]), red="uphill"),
        "from 1.7 with 0.05 it ends on the right": Fact(
            near[-1] - right_end, -1e-6, 1e-6, red="no_tau"
        ),
        "from 1.7 with 0.15 the first step crosses the maximum": Fact(
            long[1] < hump, red="clipped_step"
        ),
        "and ends on the left": Fact(long[-1] - left_end, -1e-6, 1e-6, red="stale_gradient"),
    }
    grid = np.linspace(-1.65, 1.8, 300)
    figure, panels = _panels(3.1, 1, 1)
    shown = (
        (
            "small learning rate, τ = 0.05",
            (short_left, BLUE, "o", "from 0"),
            (short_right, ORANGE, "s", "from 0.1"),
        ),
        ("start at 1.7", (near, ORANGE, "s", "τ = 0.05"), (long, BLUE, "o", "τ = 0.15")),
    )
    for axes, (title, *walks) in zip(panels, shown, strict=True):
        axes.plot(grid, (grid**2 - 1.0) ** 2 + 0.2 * grid, color=GRAY, lw=1.6)
        for x, color, mark, label in walks:
            look = {"color": color, "ms": 4, "lw": 0.8, "mec": "white", "mew": 0.5}
            axes.plot(x, [f(each) for each in x], f"{mark}-", label=label, **look)
        axes.set(xlabel="x", xlim=(-1.7, 1.85), ylim=(-0.5, 4.4))
        axes.set_title(title)
        axes.legend(loc="upper center")
        panels[0].set_ylabel("f(x)")
    return figure, facts


def fig5_adam(module):
    """The first steps of Adam, and the effect of other units of the loss."""
    n, tau = 200, 0.05

    def grad_of(scale):
        return lambda x: scale * BOWL * x

    walks = {s: module.adam(grad_of(s), START, tau, n) for s in (1.0, 1000.0)}
    plain = module.gd_nd(lambda x: float(x @ x), grad_of(1.0), START, 2.0 / 21.0, n)[0]
    lengths = {s: np.abs(np.diff(walk, axis=0)) for s, walk in walks.items()}
    size = {"Adam": walks[1.0], "gradient descent": plain}
    size = {name: np.linalg.norm(walk, axis=1) for name, walk in size.items()}
    apart = float(np.abs(walks[1.0] - walks[1000.0]).max())
    first = lengths[1.0][0]
    facts = {
        "the first step is tau in each coordinate": Fact(
            np.abs(first / tau - 1).max(), 0, 1e-6, red="no_second_correction"
        ),
        "a thousandfold gradient moves no point by more than 1e-5": Fact(
            apart, 0.0, 1e-5, red="no_square_root"
        ),
        "in no coordinate is a step longer than 1.2 tau": Fact(
            lengths[1.0].max() / tau, 0.0, 1.2, red="no_second_correction"
        ),
        "gradient descent at its best rate is nearer all the way": Fact(
            (size["gradient descent"][1:] < size["Adam"][1:]).all(), red="unit_steps"
        ),
        "after 100 steps it is a hundred times nearer": Fact(
            size["Adam"][100] / size["gradient descent"][100], 100.0, 130.0, red="unit_steps"
        ),
        "after 200 steps it is within 0.001 of the minimum": Fact(
            np.linalg.norm(walks[1.0][-1]), 0.0, 1e-3, red="swapped_betas"
        ),
        "the flat and the steep coordinate have equal first steps": Fact(
            first[0] / first[1], 0.999, 1.001, red="shared_scale"
        ),
    }
    figure, (a, b, c) = _panels(2.8, 2.6, 1.5, 1.4)
    _bowl(a, "iterates")
    a.plot(*plain[:13].T, "s-", color=ORANGE, ms=3, lw=0.9, label="gradient descent")
    a.plot(*walks[1.0][:80:2].T, "o-", color=BLUE, ms=3, lw=0.9, label="Adam, every 2nd point")
    scaled = walks[1000.0][:80:6]
    a.plot(*scaled.T, "D", color=PURPLE, ms=5, mfc="none", label="Adam, gradient × 1000")
    a.set_ylabel("steep coordinate")
    a.legend(loc="lower right")
    b.plot(lengths[1.0][:60, 0] / tau, color=BLUE, label="flat")
    b.plot(lengths[1.0][:60, 1] / tau, color=ORANGE, label="steep")
    b.set(xlabel="step k", ylabel="step in one coordinate / τ", ylim=(0.0, 1.25))
    b.set_title("steps of Adam")
    b.legend(loc="upper right")
    c.semilogy(size["Adam"], color=BLUE)
    c.semilogy(size["gradient descent"], color=ORANGE)
    c.set_title("distance")
    c.set_xlabel("step k")
    return figure, facts


def fig6_armijo(module):
    """Step sizes tried by backtracking along one direction."""

    def f(x):
        return float(np.log(np.cosh(3.0 * x[0])) + 0.2 * x[0] ** 2)

    def grad(x):
        return np.array([3.0 * np.tanh(3.0 * x[0]) + 0.4 * x[0]])

    x, c, asked = np.array([1.2]), 0.3, []
    d = -grad(x)
    slope = float(grad(x) @ d)

    def along(tau):
        return f(x + tau * d)

    def listening(y):
        asked.append(float((y[0] - x[0]) / d[0]))
        return f(y)

    tau = module.backtracking(listening, grad, x, d, 1.6, c, 0.6)
    tried = sorted({round(each, 12) for each in asked if each > 0.0}, reverse=True)
    cheap = module.backtracking(f, grad, x, d, 1.6, 1e-4, 0.6)
    bound = [f(x) + c * each * slope for each in tried]
    refused = [along(t) > b for t, b in zip(tried, bound, strict=True)]
    facts = {
        "all tries but the last lie above the line": Fact(
            refused == [True] * (len(tried) - 1) + [False], red="no_promise"
        ),
        "it tries 1.6, 0.96, 0.576 and 0.3456": Fact(
            len(tried) == 4 and np.allclose(tried, 1.6 * 0.6 ** np.arange(4.0), rtol=1e-9),
            red="ignores_tau0",
        ),
        "the last try is the result": Fact(
            tau / tried[-1], 0.999999, 1.000001, red="one_too_short"
        ),
        "the loss falls": Fact(along(tau) < f(x), red="wrong_promise"),
        "with c = 1e-4 it would have taken 0.576": Fact(cheap, 0.5759, 0.5761, red="one_too_short"),
    }
    grid = np.linspace(0.0, 1.35, 300)
    figure, (axes,) = _panels(3.2, 1)
    axes.plot(grid, [along(t) for t in grid], color=GRAY, lw=1.8, label="f(x + τ d)")
    axes.plot(grid, f(x) + c * grid * slope, color=INK, lw=1.1, label="bound, c = 0.3")
    axes.plot(grid, f(x) + 1e-4 * grid * slope, ":", color=INK, lw=1.1, label="bound, c = 0.0001")
    shown = [t for t in tried if t < 1.35]
    axes.plot(
        shown[:-1],
        [along(t) for t in shown[:-1]],
        "X",
        color=CRIMSON,
        ms=8,
        mec="white",
        label="tried and rejected",
    )
    axes.plot(tau, along(tau), "o", color=BLUE, ms=8, mec="white", label="accepted")
    axes.set_title("tried: 1.6 (not drawn), 0.96, 0.576, 0.3456")
    axes.set(xlabel="step size τ", ylabel="f", xlim=(0.0, 1.35), ylim=(-1.2, 8.2))
    axes.legend(loc="upper center", ncols=2)
    return figure, facts


FIGURES = figures_of(
    fig1_zigzag, fig2_two_errors, fig3_step_lengths, fig4_two_valleys, fig5_adam, fig6_armijo
)
