# %% [markdown]
# # Gradient descent, experiments
#
# Nothing here is graded. Each cell uses your own `descent.py`; a cell whose function is not written
# yet stops with the name of the task. Change numbers, run again. The whole script takes seconds.
# `--figure 0` leaves out Figure 1 of the handout, at the end.

# %%
from photograd_course import explore

given = explore.options(figure=explore.between(1, 0, 1))

import importlib

import descent
import numpy as np
from matplotlib.figure import Figure


def plot():
    """Axes of a new figure."""
    return Figure(layout="constrained").subplots()


def keep(axes, name, xlabel="", ylabel="", legend=False):
    """Label and save a figure, and show it in a notebook."""
    axes.set(xlabel=xlabel, ylabel=ylabel)
    if legend:
        axes.legend()
    explore.keep_picture(axes.figure, f"explore/{name}.png", 110)


# %% [markdown]
# ## 1. How small should eps be?
# Which eps is best, and why is smaller not better? Try another function.

# %%
eps = 10.0 ** np.arange(-13.0, 0.0, 0.5)
point = np.array([0.7])
found = [descent.numeric_derivative(lambda y: float(np.sin(y[0])), point, e)[0] for e in eps]
axes = plot()
axes.loglog(eps, np.abs(np.array(found) - np.cos(0.7)), "o-")
keep(axes, "differences", "eps", "error")

# %% [markdown]
# ## 2. Two local minima
# Every start on the axis, one row for each tau, colored by the minimum in which it ends (its *basin
# of attraction*). With tau = 0.05 there is one border, at the local maximum. How many are there
# with 0.15 and with 0.2? Where a color is missing, the iterates diverge.


# %%
def f(x):
    across = x * x - 1.0
    return across * across + 0.2 * x  # a power would raise OverflowError on divergence


def df(x):
    return 4.0 * x * (x * x - 1.0) + 0.2


starts = np.linspace(-1.9, 1.9, 381)
taus, axes = (0.05, 0.15, 0.2), plot()
for row, tau in enumerate(taus):
    with np.errstate(all="ignore"):
        ends = np.array([descent.gd_1d(f, df, float(x0), tau, 80)[0][-1] for x0 in starts])
    for side, color in ((ends < 0.0, "C0"), (ends > 0.0, "C1")):
        axes.plot(starts[side], np.full(side.sum(), row), "|", ms=25, color=color)
    borders = np.count_nonzero(np.diff(ends[np.isfinite(ends)] > 0.0))
    print(f"tau = {tau}: {borders} borders, {np.count_nonzero(~np.isfinite(ends))} starts diverge")
axes.set(ylim=(-0.6, len(taus) - 0.4), yticks=range(len(taus)))
axes.set_yticklabels([f"tau = {tau}" for tau in taus])
keep(axes, "basins", "start; blue: ends on the left, orange: on the right")

# %% [markdown]
# ## 3. Zig-zag, and momentum
# A quadratic with condition number `kappa`. With the best learning rate the steep coordinate
# changes sign in each step: how many steps until 1 % of the distance is left, and how many when
# kappa doubles? Momentum: try beta = 0.5, 0.7, 0.9, 0.97. Where does it begin to overshoot along
# the valley?

# %%
kappa, start, n = 30.0, np.array([-2.0, 0.4]), 60


def quadratic(steep):
    """f and its gradient, with curvatures 1 and `steep`."""
    bends = np.array([1.0, steep])
    return lambda x: float(0.5 * x @ (bends * x)), lambda x: bends * x


def contours(walks, name):
    """Contours of the quadratic, with some runs."""
    x, y = np.meshgrid(np.linspace(-2.3, 1.0, 150), np.linspace(-1.0, 1.0, 100))
    axes = plot()
    axes.contour(x, y, 0.5 * (x**2 + kappa * y**2), levels=np.geomspace(0.02, 15, 10), colors="0.8")
    for label, walk in walks.items():
        axes.plot(*walk.T, "o-", ms=3, lw=1, label=label)
    axes.axis((-2.3, 1.0, -1.0, 1.0))
    keep(axes, name, legend=True)


bowl, slope = quadratic(kappa)
best = descent.gd_nd(bowl, slope, start, 2.0 / (1.0 + kappa), n)[0]
edge = descent.gd_nd(bowl, slope, start, 1.98 / kappa, n)[0]
contours({"best learning rate": best, "near the bound": edge}, "zigzag")
for steep in (kappa, 2.0 * kappa, 4.0 * kappa):
    walk = descent.gd_nd(*quadratic(steep), start, 2.0 / (1.0 + steep), int(5.0 * steep))[0]
    left = np.linalg.norm(walk, axis=1) / np.linalg.norm(start)
    print(f"kappa = {steep:g}: {np.argmax(left < 0.01)} steps until 1 % is left")
contours(
    {f"beta = {beta}": descent.momentum(slope, start, 1.0 / kappa, beta, n) for beta in (0.5, 0.9)},
    "momentum",
)

# %% [markdown]
# ## 4. Adam
# Gradient descent with the best learning rate is ahead on this quadratic nearly all the way: the
# advantage of Adam is that 2 / (1 + kappa) need not be known. Rotate the quadratic by 45 degrees:
# gradient descent behaves the same, and Adam is far slower at first. Why? Try other values of tau
# for Adam.

# %%
turn = np.array([[1.0, -1.0], [1.0, 1.0]]) / np.sqrt(2.0)
plain = descent.gd_nd(bowl, slope, start, 2.0 / (1.0 + kappa), 300)[0]
axes = plot()
for label, walk in (
    ("Adam", descent.adam(slope, start, 0.05, 300)),
    ("Adam, rotated", descent.adam(lambda x: turn @ slope(turn.T @ x), turn @ start, 0.05, 300)),
    ("gradient descent, best learning rate", plain),
):
    axes.semilogy(np.linalg.norm(walk, axis=1), label=label)
keep(axes, "adam", "step", "distance", legend=True)

# %% [markdown]
# ## 5. Backtracking line search
# Rosenbrock's function: no constant learning rate is right everywhere. Which step sizes does the
# line search choose?


# %%
def valley(x):
    return float((1.0 - x[0]) ** 2 + 20.0 * (x[1] - x[0] ** 2) ** 2)


def valley_slope(x):
    across = x[1] - x[0] ** 2
    return np.array([-2.0 * (1.0 - x[0]) - 80.0 * x[0] * across, 40.0 * across])


x, tau, chosen = np.array([-1.2, 1.0]), 1.0, []
for _ in range(300):
    d = -valley_slope(x)
    if d @ d < 1e-20:
        break
    tau = descent.backtracking(valley, valley_slope, x, d, 2.0 * tau)
    x = x + d * tau
    chosen.append(tau)
axes = plot()
axes.semilogy(chosen, ".")
axes.set_title(f"ends at ({x[0]:.4f}, {x[1]:.4f})")
keep(axes, "line_search", "step", "tau")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, descent)
