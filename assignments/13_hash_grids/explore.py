# %% [markdown]
# # A picture, a network and a hash grid
# Trains your hash grid and a plain network on a picture, as in Figure 1: the network makes four
# times as many steps, which take about as long. Tabulates the network in leaves and fine-tunes
# them. Where the C++ core is installed, its hash encoding stands beside yours. Never graded.
# `python explore.py` takes `--steps` of the hash grid, `--size` (pixels along a side), `--log2`
# (rows of a level, as a power of two), `--finest` (cells of the finest level), `--cells` (of the
# leaves, a power of two) and `--image FILE`, a photograph of your own.

# %%
from photograd_course import explore

given = explore.options(
    steps=160,
    size=explore.at_least(144, 8),
    log2=explore.between(14, 1, 24),
    finest=explore.at_least(144, 9),
    cells=64,
    image=explore.existing(),
)

import importlib

import hash_grids as mine
import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread

training = importlib.import_module("data.training")
size, cells, octaves = given.size, given.cells, training.OCTAVES

# %% [markdown]
# ## The picture


# %%
def photograph(path):
    """Colors (size^2, 3) of a square cut from the middle, averaged over blocks."""
    pixels = imread(path)
    pixels = pixels / 255 if pixels.dtype == np.uint8 else pixels
    pixels = np.repeat(pixels[..., None], 3, 2) if pixels.ndim == 2 else pixels[..., :3]
    side = min(pixels.shape[:2])
    top, left = (pixels.shape[0] - side) // 2, (pixels.shape[1] - side) // 2
    square = np.asarray(pixels[top : top + side, left : left + side], np.float64)
    block = max(side // size, 1)
    square = square[: side // block * block, : side // block * block]
    blocks = square.reshape(side // block, block, side // block, block, 3).mean(axis=(1, 3))
    index = np.arange(size) * len(blocks) // size
    return blocks[index][:, index].reshape(-1, 3)


points = mine.pixels(size)
target = photograph(given.image) if given.image else mine.julia(points)


def decibels(colors):
    return training.decibels(colors, target)


# %% [markdown]
# ## Both trainings
# The network gets four times as many steps: each takes about a quarter of the time.

# %%
resolutions, rows = training.resolutions(given.finest), 2**given.log2
levels, watch = mine.make_levels(resolutions, 2, rows), explore.Stopwatch()
with explore.count_calls("hash grid", given.steps, mine, "encode_backward"):
    table, decoder = training.hash_grid(mine, target, levels, given.steps)
ours, taken = mine.network(decoder, mine.encode(points, table, levels)), [watch.stop()]
others, watch = training.SLOWER * given.steps, explore.Stopwatch()
with explore.count_calls("network", others, mine, "network_loss_and_grad"):
    weights = training.plain_network(mine, target, others)
plain, taken = mine.network(weights, mine.frequencies(points, octaves)), [*taken, watch.stop()]
print(f"levels {resolutions}, {table.size} numbers in the table")
for name, colors, steps, watch, parameters, used in (
    (
        "hash grid",
        ours,
        given.steps,
        taken[0],
        table.size + mine.numbers_per_point(decoder),
        mine.numbers_per_point(decoder, levels, 2),
    ),
    ("network", plain, others, taken[1], *2 * [mine.numbers_per_point(weights)]),
):
    print(
        f"{name}: {steps} steps in {watch}, {parameters} parameters, {used} for a point, "
        f"{decibels(colors):.1f} dB"
    )

# %% [markdown]
# ## The network in leaves

# %%
offsets = (np.stack(np.indices((2, 2)), axis=-1).reshape(-1, 2) + 0.5) / 2
leaf, values = mine.tabulate(
    lambda p: mine.network(weights, mine.frequencies(p, octaves)), cells, offsets, 0.1
)
leaves = mine.read_leaves(leaf, values, points)
tuned = mine.finetune(leaf, values, points, target, 60, 0.02)
again = mine.read_leaves(leaf, tuned, points)
print(
    f"leaves: {len(values)} of {cells**2} cells, {decibels(leaves):.1f} dB, "
    f"fine-tuned {decibels(again):.1f} dB"
)

# %% [markdown]
# ## The C++ core
# The same levels, the same table: features and both derivatives.

# %%
network = explore.by_the_core(lambda: importlib.import_module("photograd.network"))
if network is not None:
    encoding = network.HashEncoding(resolutions, dimensions=2, log2_rows=given.log2, features=2)
    rng, batch = np.random.default_rng(0), training.BATCH
    back, some = rng.normal(size=(batch, encoding.outputs)), rng.uniform(0, 1, (batch, 2))
    core_watch = explore.Stopwatch()
    its = encoding.encode(table, some), *encoding.encode_backward(table, some, back, d_points=True)
    core_watch.stop()
    watch = explore.Stopwatch()
    yours = mine.encode(some, table, levels), *mine.encode_backward(some, table, levels, back)
    watch.stop()
    off = [np.linalg.norm(a - b) / np.linalg.norm(a) for a, b in zip(its, yours, strict=True)]
    print(
        f"core: features are {off[0]:.1e} from yours, d_table {off[1]:.1e}, d_points {off[2]:.1e}; "
        f"{core_watch}, yours {watch}"
    )

# %% [markdown]
# ## Figures

# %%
figure = Figure(figsize=(15, 10.4), layout="constrained")
panels = figure.subplots(2, 3).ravel()
shown = (
    ("picture", target),
    (f"network, {others} steps, {decibels(plain):.1f} dB", plain),
    (f"your hash grid, {given.steps} steps, {decibels(ours):.1f} dB", ours),
    (f"{len(values)} leaves of the network, {decibels(leaves):.1f} dB", leaves),
    (f"fine-tuned, {decibels(again):.1f} dB", again),
    ("the error of your hash grid, 5 times", 5 * np.abs(ours - target)),
)
for axes, (title, colors) in zip(panels, shown, strict=True):
    axes.imshow(np.clip(colors, 0, 1).reshape(size, size, 3))
    axes.set(title=title, xticks=[], yticks=[])
explore.keep_picture(figure, "hash_grid.png", 90)
print("hash_grid.png: look at it")
