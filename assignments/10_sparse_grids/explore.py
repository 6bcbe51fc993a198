# %% [markdown]
# # A sparse scene, recovered
# Photographs a scene defined by formulas and recovers it with your functions in three ways: with
# all voxels, pruned early, and pruned and dilated. Where the C++ core is installed, its derivative
# and its own recovery stand beside yours, and your voxels are written to an OpenVDB file and read
# back. Never graded. `python explore.py` takes `--voxels` (per side, a power of two), `--steps` and
# `--rounds`, `--threshold`, `--views`, `--size` (pixels per side), and `--capture DIR`: a folder
# with `transforms.json` and its images, of a scene that extends `--box` from the origin.

# %%
import importlib
import tempfile
import time
from pathlib import Path

import numpy as np
import sparse_grids as mine
from matplotlib.figure import Figure
from photograd_course.captures import all_around, rays_to_origin, read_capture
from photograd_course.explore import option

n, rounds, steps = option("voxels", 16), option("rounds", 8), option("steps", 5)
threshold, views, size = option("threshold", 0.05), option("views", 16), option("size", 10)
capture = option("capture", "")

# %% [markdown]
# ## A scene
# A ball, a ring around it, and a pole.


# %%
def scene(n):
    """(voxels, values) of the voxels that are not empty."""
    every = np.argwhere(np.ones((n, n, n), bool))
    x = (every + 0.5) / n * 2 - 1
    around = np.hypot(x[:, 0] + 0.2, x[:, 1] + 0.1)
    distance = {
        (0.9, 0.6, 0.2): 0.42 - np.linalg.norm(x - np.array([-0.2, -0.1, 0.0]), axis=1),
        (0.2, 0.5, 0.9): 0.12 - np.hypot(around - 0.65, x[:, 2]),
        (0.3, 0.8, 0.3): np.where(abs(x[:, 2]) < 0.8, 0.12 - np.hypot(*(x[:, :2] - 0.65).T), -1),
    }
    values = np.zeros((len(x), 4))
    for paint, depth in distance.items():
        solid = 8 * np.clip(depth * n / 3 + 0.5, 0, 1)
        values[solid > values[:, 3], :3] = paint
        values[:, 3] = np.maximum(values[:, 3], solid)
    return every[values[:, 3] > 0], values[values[:, 3] > 0]


def cameras(count, size, turned=0.0):
    """Rays (2, count size^2, 3) of cameras all around the scene."""
    return rays_to_origin(3.2 * all_around(count, turned), size, 0.38)


def table_of(voxels):
    """A table in which voxel v has row v."""
    empty = mine.new_table(len(voxels))
    return mine.voxel_hash_insert(empty, voxels, np.arange(len(voxels)))


def seen(n, voxels, values, rays):
    """Colors of rays through a sparse grid."""
    return mine.render(values, mine.march(n, voxels, table_of(voxels), rays))


def decibels(a, b):
    return -10 * np.log10(max(float(np.mean((a - b) ** 2)), 1e-30))


truth = scene(2 * n)
rays, unseen = cameras(views, size), cameras(6, 16, 1.0)
target, hidden = seen(2 * n, *truth, rays), seen(2 * n, *truth, unseen)
print(f"scene: {views} photographs of {size} x {size}, all voxels {n**3}")

# %% [markdown]
# ## Memory
# Bytes of the scene itself, in four forms. The dense form needs no other structure; the sparse one
# needs the octree, the table and the values together.

# %%
voxels, values = scene(n)
full = np.zeros((n, n, n), bool)
full[tuple(voxels.T)] = True
tree = mine.octree_from_dense(full)
dense, *sparse = mine.active_stats(n, tree, table_of(voxels), values)
leaves = int((tree <= 0).sum())
print(f"bytes:  dense {dense}; octree {sparse[0]}, table {sparse[1]}, values {sparse[2]}")
wanted, *_ = mine.march(n, voxels, table_of(voxels), unseen)
print(f"evaluated samples: {wanted.mean():.0%} of all; octree: {len(tree)} nodes, {leaves} leaves")

# %% [markdown]
# ## Three recoveries

# %%
every = np.argwhere(np.ones((n, n, n), bool))
start = np.tile(mine.START, (len(every), 1))
plans = {
    "all voxels": (1, rounds * steps, 0.0, 0),
    "pruned": (rounds, steps, threshold, 0),
    "pruned and dilated": (rounds, steps, threshold, 1),
}
found = {}
for name, plan in plans.items():
    before = time.perf_counter()
    found[name] = mine.fit_sparse(n, every, start, rays, target, *plan)
    seconds = time.perf_counter() - before
    print(
        f"{name}: {len(found[name][0])} voxels, {seconds:.1f} s, "
        f"{decibels(seen(n, *found[name][:2], unseen), hidden):.1f} dB on held-out views"
    )

# %% [markdown]
# ## Your derivative
# A guess that lacks the ring and the pole, and the derivative of its loss with respect to
# extinction: of the voxels that exist, and of all voxels, new ones with the color of START.

# %%
across = (np.arange(32) + 0.5) / 16 - 1
v, u = np.meshgrid(-across, across, indexing="ij")
ahead = np.stack([u.ravel(), v.ravel(), np.full(1024, 3.0)], axis=1)
parallel = np.stack([ahead, np.tile([0.0, 0.0, -1.0], (1024, 1))])
photograph = seen(2 * n, *truth, parallel)
ball = values[:, 0] > 0.5
guess = voxels[ball], values[ball]
samples = mine.march(n, guess[0], table_of(guess[0]), parallel)
_, slope = mine.loss_and_grad(guess[1], samples, photograph)
filled = start * [1, 1, 1, 0]
filled[mine.voxel_hash_find(table_of(every), guess[0])] = guess[1]
_, told = mine.loss_and_grad(filled, mine.march(n, every, table_of(every), parallel), photograph)

# %% [markdown]
# ## The C++ core
# The same sparse grid as a field of the core: spherical harmonics of degree 0, no activations.


# %%
def core_field(n, voxels, values):
    """A field of the core with these voxels, and their rows there."""
    fields = importlib.import_module("photograd.fields.sparse_sh")
    marches = importlib.import_module("photograd.fields.march")
    active = importlib.import_module("photograd.fields.active_voxels")
    sh = importlib.import_module("photograd.sh")
    mask = np.zeros((n, n, n), bool)
    mask[tuple(voxels.T)] = True
    kept = active.ActiveVoxels(mask)
    rows = kept.rows[tuple(voxels.T)]
    density, color = np.zeros(len(rows)), np.zeros((len(rows), 1, 3))
    density[rows], color[rows, 0] = values[:, 3], values[:, :3] / sh.Y_0
    policy = marches.MarchPolicy(
        box=((-1.0,) * 3, (1.0,) * 3),
        dt=1 / n * (1 - 1e-12),
        lattice="entry",
        border="zero",
        density_activation="identity",
        color_activation="identity",
    )
    return fields.SparseSh(kept, density, color, policy), rows, sh.Y_0


def core_loss_and_grad(n, voxels, values, rays, target):
    """(loss, derivative (V, 4), largest share of each voxel (V,)) by the core."""
    base = importlib.import_module("photograd.representation")
    field, rows, unit = core_field(n, voxels, values)
    batch = base.RayBatch(*rays, np.arange(rays.shape[1], dtype=np.uint32))
    out, context = field.render(batch, options=base.RenderOptions(), seed=0, step=0)
    residual = out.color - target
    back = base.Outputs(2 * residual / residual.size, None, None)
    gradient = field.render_backward(context, back)
    d_values = np.column_stack([gradient["sh"][rows, 0] / unit, gradient["density"][rows]])
    return np.mean(residual**2), d_values, field.greatest_weights([batch])[rows]


def core_fit(n, voxels, numbers, rays, target, rounds, steps, threshold):
    """The recovery with the derivatives, shares, pruning and dilation of the core."""
    existing = importlib.import_module("photograd.fields.active_voxels")
    for left in reversed(range(rounds)):
        optimizer = mine.Adam()
        for _ in range(steps):
            slope = core_loss_and_grad(n, voxels, numbers, rays, target)[1]
            numbers = optimizer.step(numbers, slope)
            numbers[:, 3] = np.clip(numbers[:, 3], 0, None)
        if left:
            most = core_loss_and_grad(n, voxels, numbers, rays, target)[2]
            mask, dense = np.zeros((n, n, n), bool), np.tile(mine.START, (n, n, n, 1))
            mask[tuple(voxels[most > threshold].T)] = True
            dense[tuple(voxels.T)] = numbers
            voxels = np.argwhere(existing.dilated(mask))
            numbers = dense[tuple(voxels.T)]
    return voxels, numbers


def through_openvdb(n, voxels, values):
    """The values (V, 4), written to .vdb files and read again, as float32."""
    sparse = importlib.import_module("photograd.grids.sparse")
    vdb = importlib.import_module("photograd.grids.vdb")
    world = np.diag([2 / n, 2 / n, 2 / n, 1.0])
    world[:3, 3] = 1 / n - 1
    grids = []
    for name, part in (("color", values[:, :3]), ("density", values[:, 3:])):
        shape = (1, 1, 1, part.shape[1]) if part.shape[1] > 1 else (1, 1, 1)
        grid = sparse.SparseGrid.from_dense(
            np.zeros(shape, np.float32), world_from_index=world, name=name
        )
        grid.activate(voxels, part.astype(np.float32))
        grids.append(grid)
    with tempfile.TemporaryDirectory() as folder:
        vdb.write_vdb(Path(folder) / "scene.vdb", grids)
        file = vdb.read_vdb(Path(folder) / "scene.vdb")
        print(f"OpenVDB: {(Path(folder) / 'scene.vdb').stat().st_size} bytes", end="; ")
    parts = [file.grid(name).values_at(voxels) for name in ("color", "density")]
    print("all voxels active" if all(on.all() for _, on in parts) else "voxels were lost", end="; ")
    return np.concatenate([part for part, _ in parts], axis=1)


core_slope = core_found = None
try:
    octrees = importlib.import_module("photograd.grids.octree")
    _, core_slope, core_worth = core_loss_and_grad(n, *guess, parallel, photograph)
except (ImportError, AttributeError, TypeError):  # none, or another than this was written for
    print("core not installed")
else:
    off = np.linalg.norm(core_slope - slope) / max(np.linalg.norm(core_slope), 1e-300)
    row, share = mine.shares(guess[1], samples)
    largest, order = np.zeros(len(guess[0]) + 1), np.argsort(share, axis=None)
    largest[row.ravel()[order]] = share.ravel()[order]  # the largest is written last
    print(
        f"core: its derivative is {off:.1e} from yours, "
        f"its largest shares {np.abs(core_worth - largest[:-1]).max():.1e}"
    )
    its = octrees.Octree.from_dense(full[..., None]).statistics().leaves
    print(f"core: its octree has {its} leaves, yours {leaves}")
    again = through_openvdb(n, *found["pruned and dilated"][:2])
    same = np.array_equal(again, found["pruned and dilated"][1].astype(np.float32))
    print("values are the same" if same else "values differ")
    before = time.perf_counter()
    core_found = core_fit(n, every, start, rays, target, rounds, steps, threshold)
    print(
        f"core, pruned and dilated: {len(core_found[0])} voxels, "
        f"{time.perf_counter() - before:.1f} s, "
        f"{decibels(seen(n, *core_found, unseen), hidden):.1f} dB on held-out views"
    )

# %% [markdown]
# ## Figures


# %%
def shown(axes, colors, title):
    """A square image of linear radiance."""
    side = round(len(colors) ** 0.5)
    axes.imshow(np.clip(colors, 0, 1).reshape(side, side, 3) ** (1 / 2.2))
    axes.set(title=title, xticks=[], yticks=[])


def signed(axes, voxels, values, end, title):
    """Values summed along the line of sight: blue negative, red positive."""
    flat = np.zeros((n, n))
    np.add.at(flat, tuple(voxels[:, :2].T), values)
    axes.imshow(flat.T, origin="lower", cmap="RdBu_r", vmin=-end, vmax=end)
    axes.set(title=title, xticks=[], yticks=[])


figure = Figure(figsize=(15, 6.4), layout="constrained")
panels = figure.subplots(2, 5)
view = cameras(3, 48, 0.5)[:, 2304:4608]
shown(panels[0, 0], seen(2 * n, *truth, view), "truth, a new view")
for axes, (name, given) in zip(panels[0, 1:], found.items(), strict=False):
    shown(axes, seen(n, *given[:2], view), f"yours: {name}")
if core_found is None:
    panels[0, 4].text(0.5, 0.5, "core not installed", ha="center")
    panels[0, 4].set_axis_off()
else:
    shown(panels[0, 4], seen(n, *core_found, view), "the core's: pruned and grown")
shown(panels[1, 0], photograph, "photograph")
shown(panels[1, 1], seen(n, *guess, parallel), "a guess")
end = max(np.abs(slope[:, 3]).max() * 4, 1e-300)
signed(panels[1, 2], guess[0], slope[:, 3], end, "your derivative by extinction")
if core_slope is None:
    panels[1, 3].text(0.5, 0.5, "core not installed", ha="center")
    panels[1, 3].set_axis_off()
else:
    signed(panels[1, 3], guess[0], core_slope[:, 3], end, "the core's, on the same scale")
end = max(np.abs(told[:, 3]).max() * 4, 1e-300)
signed(panels[1, 4], every, told[:, 3], end, "if all existed, in gray")
figure.savefig("sparse.png", dpi=90)
print("sparse.png: look at it")

# %% [markdown]
# ## Photographs of your own
# `transforms.json` has the cameras (x to the right, y up, looking along -z: columns of a matrix)
# and a field of view or a focal length in pixels. Transparent pixels count as black.


# %%
def photographs(folder, reach):
    """Rays (2, R, 3), scaled so that the scene fills the cube, colors (R, 3), picture sizes."""
    photos = list(read_capture(folder, 2 * size, views))
    origins, directions = (
        np.concatenate(each) for each in zip(*(p.rays() for p in photos), strict=True)
    )
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    colors = np.concatenate([photo.colors.reshape(-1, 3) for photo in photos])
    return np.stack([origins / reach, directions]), colors, [p.colors.shape[:2] for p in photos]


if capture:
    rays, target, sizes = photographs(Path(capture), option("box", 1.0))
    plan = (rounds, steps, threshold, 1)
    own = mine.fit_sparse(n, every, start, rays, target, *plan)
    again = seen(n, *own[:2], rays)
    print(
        f"capture: {len(sizes)} photographs, {len(own[0])} of {n**3} voxels, "
        f"{decibels(0 * target, target):.1f} dB for black, "
        f"{decibels(again, target):.1f} dB recovered"
    )
    figure = Figure(figsize=(9, 6), layout="constrained")
    panels = figure.subplots(2, 3)
    ends = np.cumsum([0] + [a * b for a, b in sizes])
    for column, k in enumerate(np.linspace(0, len(sizes) - 1, 3).astype(int)):
        for axes, colors, title in zip(
            panels[:, column], (target, again), ("photograph", "recovered"), strict=True
        ):
            picture = colors[ends[k] : ends[k + 1]].reshape(*sizes[k], 3)
            axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2))
            axes.set(xticks=[], yticks=[], title=title)
    figure.savefig("capture.png", dpi=90)
    print("capture.png: photographs, and the same views of the recovered grid")
