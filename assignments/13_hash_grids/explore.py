# %% [markdown]
# # A picture, a network and a hash grid
# Trains your hash grid and a plain network on a picture for the same time by the clock, tabulates
# the network in leaves and fine-tunes them. Where the C++ core is installed, its hash encoding
# stands beside yours. Never graded. `python explore.py` takes `--seconds` for each of the two or
# `--steps` of the hash grid (the network makes four times as many), `--size` (pixels along a
# side), `--log2` (rows of a level, as a power of two), `--finest` (cells of the finest level),
# `--cells` (of the leaves) and `--image FILE`, a photograph of your own.

# %%
import importlib
import time

import hash_grids as mine
import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread
from photograd_course.explore import by_the_core, option

seconds, steps = option("seconds", 8.0), option("steps", 0)
size, log2 = option("size", 256), option("log2", 14)
finest, cells, image = option("finest", 256), option("cells", 64), option("image", "")
BATCH = 4096  # points of a step

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
target = photograph(image) if image else mine.julia(points)


def decibels(colors):
    return -10 * np.log10(max(float(np.mean((colors - target) ** 2)), 1e-30))


# %% [markdown]
# ## Both for the same time
# Ten steps tell how many the time allows, unless `--steps` says it.

# %%
rng = np.random.default_rng(0)
count = max(round(np.log2(finest / 8)) + 1, 2)
resolutions = [int(8 * (finest / 8) ** (k / (count - 1)) + 1e-9) for k in range(count)]
levels = mine.make_levels(resolutions, 2, 2**log2)
table = rng.uniform(-1e-4, 1e-4, (levels[-1, 1] + levels[-1, 2], 2))
decoder = mine.start_weights((2 * len(levels), 16, 3), rng)
octaves = 6
weights = mine.start_weights((2 + 4 * octaves, 64, 64, 3), rng)
print(f"levels {resolutions}, {table.size} numbers in the table")


def trained(train, state, steps):
    """(state, steps) after some steps; for 0 as many as take the given seconds, by ten of them."""
    if not steps:
        before = time.perf_counter()
        train(state, rng.integers(0, len(points), (10, BATCH)))
        steps = max(round(10 * seconds / (time.perf_counter() - before)), 10)
    return train(state, rng.integers(0, len(points), (steps, BATCH))), steps


(table, decoder), count = trained(
    lambda s, b: mine.train_hash_grid(points, target, b, levels, *s, 0.02)[:2],
    (table, decoder),
    steps,
)
ours = mine.network(decoder, mine.encode(points, table, levels))
weights, others = trained(
    lambda w, b: mine.train_network(points, target, b, octaves, w, 0.005)[0], weights, 4 * steps
)
plain = mine.network(weights, mine.frequencies(points, octaves))
for name, colors, number, parameters, used in (
    (
        "hash grid",
        ours,
        count,
        table.size + mine.numbers_per_point(decoder),
        mine.numbers_per_point(decoder, levels, 2),
    ),
    ("network", plain, others, mine.numbers_per_point(weights), mine.numbers_per_point(weights)),
):
    print(
        f"{name}: {number} steps, {parameters} parameters, {used} for a point, "
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
network = by_the_core(lambda: importlib.import_module("photograd.network"))
if network is not None:
    encoding = network.HashEncoding(resolutions, dimensions=2, log2_rows=log2, features=2)
    back = rng.normal(size=(BATCH, encoding.outputs))
    some = rng.uniform(0, 1, (BATCH, 2))
    before = time.perf_counter()
    its = encoding.encode(table, some), *encoding.encode_backward(table, some, back, d_points=True)
    middle = time.perf_counter()
    yours = mine.encode(some, table, levels), *mine.encode_backward(some, table, levels, back)
    after = time.perf_counter()
    off = [np.linalg.norm(a - b) / np.linalg.norm(a) for a, b in zip(its, yours, strict=True)]
    print(
        f"core: features are {off[0]:.1e} from yours, d_table {off[1]:.1e}, d_points {off[2]:.1e}; "
        f"{1000 * (middle - before):.1f} ms, yours {1000 * (after - middle):.1f} ms"
    )

# %% [markdown]
# ## Figures

# %%
figure = Figure(figsize=(15, 10.4), layout="constrained")
panels = figure.subplots(2, 3).ravel()
shown = (
    ("picture", target),
    (f"network, {others} steps, {decibels(plain):.1f} dB", plain),
    (f"your hash grid, {count} steps, {decibels(ours):.1f} dB", ours),
    (f"{len(values)} leaves of the network, {decibels(leaves):.1f} dB", leaves),
    (f"fine-tuned, {decibels(again):.1f} dB", again),
    ("the error of your hash grid, 5 times", 5 * np.abs(ours - target)),
)
for axes, (title, colors) in zip(panels, shown, strict=True):
    axes.imshow(np.clip(colors, 0, 1).reshape(size, size, 3))
    axes.set(title=title, xticks=[], yticks=[])
figure.savefig("hash_grid.png", dpi=90)
print("hash_grid.png: look at it")
