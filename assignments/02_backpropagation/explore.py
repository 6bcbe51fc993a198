# %% [markdown]
# # Play with your engine
#
# Nothing here is graded. Run the whole file, or cell by cell in an editor that knows `# %%`. It
# needs a finished `engine.py`, takes some ten seconds, and writes two pictures. `--hinges`,
# `--steps` and `--rate` are those of the network. `--figure 0` leaves out Figure 1 of the handout,
# at the end.

# %%
from photograd_course import explore

given = explore.options(hinges=8, steps=200, rate=0.35, figure=explore.between(1, 0, 1))

import importlib

import engine
import numpy as np
from matplotlib.figure import Figure

# %% [markdown]
# ## 1. Is your gradient right?
#
# Change the formula as you like. Then break a gate on purpose, and look at `grad_check`.


# %%
def formula(v):
    x, y, z = v
    return (x * y + z.exp()).log() * (x / z) ** 2 + x.maximum(y)


place = np.array([1.3, 0.7, 0.4])
print("value and gradient:", engine.value_and_gradient(formula, place))
print("grad_check:", engine.grad_check(lambda x: engine.value_and_gradient(formula, x), place))

# %% [markdown]
# ## 2. A gradient is an image
#
# The pixels of a small image are its texels, blurred. The derivative of the error with respect to
# each texel has the shape of the image: blue where a texel should be increased, red where it should
# be decreased. (NumPy adds and multiplies `Value`s in arrays, too.) After many steps dark and
# bright edges appear: the engine finds the texels that look right when blurred.

# %%
row, column = np.mgrid[0:12, 0:20]
heart = ((column - 9.5) / 6) ** 2 + (
    (6 - row) / 5 - np.abs((column - 9.5) / 6) ** 0.6 * 0.6
) ** 2 < 0.7
wanted = np.where(heart, 0.85, 0.15)


def picture_loss(texels):
    """The squared error, and its derivative with respect to each texel."""
    leaves = np.array([engine.Value(number) for number in texels.flat]).reshape(texels.shape)
    left, middle, right = (
        np.pad(leaves, ((0, 0), (1, 1)), "edge")[:, k : k + 20] for k in range(3)
    )
    total = np.sum((0.25 * left + 0.5 * middle + 0.25 * right - wanted) ** 2)
    engine.backward(total)
    return total.data, np.array([leaf.grad for leaf in leaves.flat]).reshape(texels.shape)


texels = np.full(wanted.shape, 0.5)
shown = []
for number in range(13):
    loss, slopes = picture_loss(texels)
    if number in {0, 3, 12}:
        shown.append((number, texels.copy(), slopes))
        print(f"step {number}: loss {loss:.4f}")
    texels = texels - 0.4 * slopes

figure = Figure(figsize=(9, 4), layout="constrained")
top = np.abs(shown[0][2]).max()
for k, (number, picture, slopes) in enumerate(shown):
    above, below = figure.add_subplot(2, 3, k + 1), figure.add_subplot(2, 3, k + 4)
    above.imshow(picture, cmap="gray", vmin=0, vmax=1)
    above.set_title(f"texels after {number} steps")
    below.imshow(slopes, cmap="RdBu_r", vmin=-top, vmax=top)
    below.set_title("derivative of the loss")
explore.keep_picture(figure, "explore_picture.png", 110)

# %% [markdown]
# ## 3. A neural network of 25 parameters, trained on a curve
#
# A weighted sum of eight ReLUs, max(0, w x + b). Try `--hinges 3`, or a larger `--rate`.

# %%
xs = np.linspace(-1, 1, 21)
ys = np.sin(3 * xs) * 0.5
rng = np.random.default_rng(2)
hinges = given.hinges
weights, offsets = rng.choice([-1.0, 1.0], hinges), rng.uniform(-0.8, 0.8, hinges)
parameters = np.concatenate([weights, offsets, rng.normal(0, 0.3, hinges), [0.0]])


def network(p, x):
    """The network at one number x; p are numbers or Values."""
    out = p[3 * hinges]
    for k in range(hinges):
        out = out + p[2 * hinges + k] * (p[k] * float(x) + p[hinges + k]).maximum(0.0)
    return out


def misfit(p):
    """The mean squared error over all samples."""
    total = engine.Value(0.0)
    for x, y in zip(xs, ys, strict=True):
        total = total + (network(p, x) - float(y)) ** 2
    return total * (1.0 / len(xs))


curves = [parameters.copy()]
losses = []
progress = explore.Progress("network", given.steps)
for number in range(given.steps):
    loss, slopes = engine.value_and_gradient(misfit, parameters)
    progress.step()
    losses.append(loss)
    parameters = parameters - given.rate * slopes
    if number in {9, given.steps - 1}:
        curves.append(parameters.copy())
print(f"loss {losses[0]:.4f} -> {losses[-1]:.5f}")

figure = Figure(figsize=(9, 3.2), layout="constrained")
left, right = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2)
left.plot(xs, ys, "k.", label="samples")
for p, name in zip(curves, ("start", "10 steps", f"{given.steps} steps"), strict=False):
    left.plot(xs, [network([engine.Value(each) for each in p], x).data for x in xs], label=name)
left.legend()
right.semilogy(losses)
right.set(xlabel="step", ylabel="loss")
explore.keep_picture(figure, "explore_network.png", 110)

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, engine)
