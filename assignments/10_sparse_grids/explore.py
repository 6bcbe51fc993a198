# %% [markdown]
# # A table with toys, in a sparse grid
# Recovers a sparse grid from photographs with your functions, coarse to fine: with dilation and
# without. Where the C++ core is installed, it renders the photographs, and its own recovery with
# twice the voxels per side stands beside yours. Never graded. `python explore.py` takes `--voxels`
# (per side at the end, a power of two), `--rounds` and `--steps` at each resolution, `--threshold`,
# `--rate` (the learning rate of sigma: 2 here, not 0.4, since toys are opaque), with the core
# `--views` and `--size` (a power of two), and `--capture DIR`: a folder with `transforms.json` and
# its images, of a scene that extends `--box` from the origin. Two to ten minutes; `--voxels 16`
# takes one. `--figure 0` leaves out Figure 1 of the handout, which takes about a minute.

# %%
from photograd_course import explore

given = explore.options(
    voxels=explore.at_least(32, 4),
    rounds=4,
    steps=6,
    threshold=explore.between(0.05, 0, 1),
    rate=explore.at_least(2.0, 0),
    views=40,
    size=64,
    capture=explore.existing(),
    box=explore.at_least(1.0, 1e-6),
    figure=explore.between(1, 0, 1),
)

import importlib
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np
import sparse_grids as mine
from matplotlib.figure import Figure
from photograd_course.captures import read_capture

photographs = importlib.import_module("data.photographs")
finest, rounds, steps = given.voxels, given.rounds, given.steps
threshold, capture = given.threshold, given.capture
explore.set_constants(mine, RATES=np.append(mine.RATES[:3], given.rate))

# %% [markdown]
# ## Photographs


# %%
def rays_of(photos):
    """Rays (2, R, 3) through all pixels of photographs, and their colors."""
    ends = [photo.rays() for photo in photos]
    origin, direction = (np.concatenate(each) for each in zip(*ends, strict=True))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return np.stack([origin, direction]), np.concatenate([p.colors.reshape(-1, 3) for p in photos])


def decibels(a, b):
    return -10 * np.log10(max(float(np.mean((a - b) ** 2)), 1e-30))


def seen(grid, rays):
    """Colors of rays through a grid (n, voxels, values)."""
    n, voxels, values = grid
    return mine.render(values, mine.march(n, voxels, rays))


def score(grid):
    """PSNR of a grid on all held-out photographs together."""
    pairs = [rays_of([photo]) for photo in unseen]
    again = np.concatenate([seen(grid, rays) for rays, _ in pairs])
    return decibels(again, np.concatenate([colors for _, colors in pairs]))


photos, unseen = (photographs.read(each) for each in (photographs.TRAINING, photographs.HELD_OUT))
try:
    fields = importlib.import_module("photograd.fields.sparse_sh")
    photos = photographs.render(given.views, given.size)
except (ImportError, AttributeError):
    fields = None
print(f"photographs: {len(photos)} of {photos[0].colors.shape[1]} x {photos[0].colors.shape[0]}")

# %% [markdown]
# ## Recovery, coarse to fine
# At each resolution the photographs are made as small as the grid.


# %%
def smaller(n):
    """(rays, colors) of the photographs with at most n x n pixels."""
    return rays_of(photographs.smaller(photos, min(n, len(photos[0].colors))))


def march_and_print(n, voxels, rays):
    """`march`, which `fit_sparse` calls once a round, with a line for the round."""
    print(f"  a round at {n} voxels per side, {len(voxels)} active", flush=True)
    return march(n, voxels, rays)


def recover(fit, rays_at, finest, grow):
    """(n, voxels, values) after all resolutions; `rays_at` gives (rays, colors) for each."""
    n = min(16, finest)
    voxels = np.argwhere(np.ones((n, n, n), bool))
    values = np.tile(mine.START, (len(voxels), 1))
    while True:
        rays, target = rays_at(n)
        mine.march = march_and_print
        voxels, values = fit(n, voxels, values, rays, target, rounds, steps, threshold, grow)[:2]
        mine.march = march
        if n >= finest:
            return n, voxels, values
        n, voxels, values = mine.refine(n, voxels, values, rays, threshold)


march, found = mine.march, {}
for name, grow in (("pruned and dilated", 1), ("pruned alone", 0)):
    watch = explore.Stopwatch()
    found[name] = recover(mine.fit_sparse, smaller, finest, grow)
    print(
        f"{name}: {len(found[name][1])} of {finest**3} voxels, {watch}, "
        f"{score(found[name]):.1f} dB on the held-out photographs"
    )

# %% [markdown]
# ## Memory
# Bytes of your grid in both forms: dense, or an octree of the active voxels (`march` builds a
# larger one, of all cells that they affect), rows and values together.

# %%
n, voxels, values = found["pruned and dilated"]
full = np.zeros((n, n, n), bool)
full[tuple(voxels.T)] = True
tree = mine.octree_from_dense(full)
dense, *sparse = mine.active_stats(n, tree, values)
leaves = int((tree <= 0).sum())
print(f"bytes: dense {dense}; octree {sparse[0]}, rows {sparse[1]}, values {sparse[2]}")

# %% [markdown]
# ## The C++ core
# The same sparse grid as a field of the core: spherical harmonics of degree 0, no activations.


# %%
def core_field(n, voxels, values):
    """A field of the core with these voxels, their rows there, and its unit of color."""
    marches = importlib.import_module("photograd.fields.march")
    active = importlib.import_module("photograd.fields.active_voxels")
    unit = importlib.import_module("photograd.sh").Y_0
    mask = np.zeros((n, n, n), bool)
    mask[tuple(voxels.T)] = True
    kept = active.ActiveVoxels(mask)
    rows = kept.rows[tuple(voxels.T)]
    density, color = np.zeros(len(rows)), np.zeros((len(rows), 1, 3))
    density[rows], color[rows, 0] = values[:, 3], values[:, :3] / unit
    policy = marches.MarchPolicy(
        box=((-1.0,) * 3, (1.0,) * 3),
        dt=1 / n * (1 - 1e-12),
        lattice="entry",
        border="zero",
        density_activation="identity",
        color_activation="identity",
    )
    return fields.SparseSh(kept, density, color, policy), rows, unit


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


def core_fit(n, voxels, values, rays, target, rounds, steps, threshold, _):
    """The recovery with the derivatives, shares, pruning and dilation of the core."""
    dilated = importlib.import_module("photograd.fields.active_voxels").dilated
    for left in reversed(range(rounds)):
        optimizer = mine.Adam()
        for _ in range(steps):
            slope = core_loss_and_grad(n, voxels, values, rays, target)[1]
            values = optimizer.step(values, slope)
            values[:, 3] = np.clip(values[:, 3], 0, None)
        if left:
            most = core_loss_and_grad(n, voxels, values, rays, target)[2]
            mask, dense = np.zeros((n, n, n), bool), np.tile(mine.START, (n, n, n, 1))
            mask[tuple(voxels[most > threshold].T)] = True
            dense[tuple(voxels.T)] = values
            voxels = np.argwhere(dilated(mask))
            values = dense[tuple(voxels.T)]
    return voxels, values


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


if fields is not None:
    # Along an axis, where the equal steps of both are as long.
    v, u = np.meshgrid(*[(np.arange(32) + 0.5) / 16 - 1] * 2, indexing="ij")
    ahead = np.stack([u.ravel(), np.full(1024, 3.0), v.ravel()], axis=1)
    parallel = np.stack([ahead, np.tile([0.0, -1.0, 0.0], (1024, 1))])
    samples, gray = mine.march(n, voxels, parallel), np.full((1024, 3), 0.5)
    row, share = mine.shares(values, samples)
    largest, order = np.zeros(len(voxels) + 1), np.argsort(share, axis=None)
    largest[row.ravel()[order]] = share.ravel()[order]  # the largest is written last
    _, yours = mine.loss_and_grad(values, samples, gray)
    _, its, worth = core_loss_and_grad(n, voxels, values, parallel, gray)
    off = np.linalg.norm(its - yours) / max(np.linalg.norm(its), 1e-300)
    print(
        f"core: its derivative is {off:.1e} from yours, "
        f"its largest shares {np.abs(worth - largest[:-1]).max():.1e}"
    )
    octrees = importlib.import_module("photograd.grids.octree")
    its = octrees.Octree.from_dense(full[..., None]).statistics().leaves
    print(f"core: its octree has {its} leaves, yours {leaves}")
    same = np.array_equal(through_openvdb(n, voxels, values), values.astype(np.float32))
    print("values are the same" if same else "values differ")
    watch = explore.Stopwatch()
    found["core"] = recover(core_fit, smaller, 2 * finest, 1)
    print(
        f"core, pruned and dilated: {len(found['core'][1])} of {8 * finest**3} voxels, {watch}, "
        f"{score(found['core']):.1f} dB on the held-out photographs"
    )

# %% [markdown]
# ## Figures


# %%
def shown(axes, colors, shape, title):
    """An image of linear radiance."""
    axes.imshow(np.clip(colors, 0, 1).reshape(*shape, 3) ** (1 / 2.2))
    axes.set(title=title, xticks=[], yticks=[])


size, (view, colors) = unseen[-1].colors.shape[:2], rays_of(unseen[-1:])
figure = Figure(figsize=(3.7 * (len(found) + 1), 4), layout="constrained")
panels = figure.subplots(1, len(found) + 1)
shown(panels[0], colors, size, "held-out photograph")
for axes, (name, grid) in zip(panels[1:], found.items(), strict=True):
    again = seen(grid, view)
    shown(axes, again, size, f"{name}: {decibels(again, colors):.1f} dB")
explore.keep_picture(figure, "sparse.png", 90)
print("sparse.png: look at it")

# %% [markdown]
# ## Photographs of your own
# `transforms.json` has the cameras (x to the right, y up, looking along -z: columns of a matrix)
# and a field of view or a focal length in pixels. Transparent pixels count as black.

# %%
if capture:
    photos = list(read_capture(Path(capture), finest, given.views))

    def own_rays(n):
        """(rays, colors) of the photographs, n pixels wide, scaled so that they fill the cube."""
        rays, target = rays_of(list(read_capture(Path(capture), n, given.views)))
        return np.stack([rays[0] / given.box, rays[1]]), target

    own = recover(mine.fit_sparse, own_rays, finest, 1)
    rays, target = own_rays(finest)
    ends = np.cumsum([0] + [photo.colors[..., 0].size for photo in photos])
    again = np.concatenate([seen(own, rays[:, a:b]) for a, b in pairwise(ends)])
    print(
        f"capture: {len(photos)} photographs, {len(own[1])} of {own[0] ** 3} voxels, "
        f"{decibels(0 * target, target):.1f} dB for black, "
        f"{decibels(again, target):.1f} dB recovered"
    )
    figure = Figure(figsize=(9, 6), layout="constrained")
    panels = figure.subplots(2, 3)
    for column, k in enumerate(np.linspace(0, len(photos) - 1, 3).astype(int)):
        part, shape = slice(ends[k], ends[k + 1]), photos[k].colors.shape[:2]
        shown(panels[0, column], target[part], shape, "photograph")
        shown(panels[1, column], again[part], shape, "recovered")
    explore.keep_picture(figure, "capture.png", 90)
    print("capture.png: photographs, and the same views of the recovered grid")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    drawn = importlib.import_module("data.figure_1").draw
    explore.figure_1(lambda module: drawn(module, photographs), mine)
