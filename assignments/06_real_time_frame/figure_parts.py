"""What the figures of assignment 06 draw: the traced scene, and small frames of it."""

import functools

import numpy as np
from photograd_course.build.kit_module import kit_module

large = kit_module("06_real_time_frame", "frame").large
H, W = 72, 116  # pixels of the small frames
START, TUNED = np.array([0.5, 1.0, 1.0]), np.array([1.6, 0.3, 2.8])
TONES = np.array([0.2, 2.5])
_TRUTH: dict[str, tuple] = {}


def truth(module):
    """(gbuffer, bubbles, lit, open_sky), traced once: nothing of it is a task."""
    if not _TRUTH:
        focal = module.ZOOM * W
        gbuffer = module.traced_surfaces(focal, module.POSE, H, W)
        bubbles = module.traced_surfaces(focal, module.POSE, H, W, module.BUBBLES, ())
        lit = module.traced_sunlight(gbuffer, focal, module.POSE)
        open_sky = module.traced_sky(gbuffer, focal, module.POSE)
        _TRUTH["scene"] = gbuffer, bubbles, lit, open_sky
    return _TRUTH["scene"]


def lit_by_formula(module, gbuffer, lit, open_sky):
    """A layer (H, W, 4) as handout section 3 says, in the world, without the task's function."""
    height, width = lit.shape
    covers = np.isfinite(gbuffer["depth"]).ravel()
    turn, count = module.POSE[:, :3], int(covers.sum())
    rays = module.unproject(np.ones((height, width)), module.ZOOM * width).reshape(-1, 3)[covers]
    eye = -(rays / np.linalg.norm(rays, axis=1, keepdims=True)) @ turn.T
    rows = {name: v.reshape(covers.size, *v.shape[2:])[covers] for name, v in gbuffer.items()}
    normal, sun = rows["normal"] @ turn.T, np.tile(module.LIGHTS["to_sun"], (count, 1))
    ways = module.local(normal, eye), module.local(normal, sun)
    f = module.gltf(*ways, rows["base_color"], rows["metalness"], rows["roughness"])
    arrives = np.clip(normal @ module.LIGHTS["to_sun"], 0, None) * lit.ravel()[covers]
    color = rows["emission"] + f * arrives[:, None] * module.LIGHTS["sun"]
    sky = open_sky.ravel()[covers, None] * module.LIGHTS["sky"]
    color = (color + rows["base_color"] * sky) * rows["alpha"][:, None]
    layer = np.zeros((covers.size, 4))
    layer[covers] = np.column_stack([color, rows["alpha"]])
    return layer.reshape(height, width, 4)


def traced_radiance(module):
    """(H, W, 3) of the traced scene, without any of the tasks."""
    if "radiance" not in _TRUTH:
        gbuffer, bubbles, lit, open_sky = truth(module)
        base = lit_by_formula(module, gbuffer, lit, open_sky)
        depth = np.where(bubbles["depth"] < gbuffer["depth"], bubbles["depth"], np.inf)
        ones = np.ones((H, W))
        front = lit_by_formula(module, {**bubbles, "depth": depth}, ones, ones)
        sky = module.sky_color(module.ZOOM * W, module.POSE, H, W)
        _TRUTH["radiance"] = (module.over(front, module.over(base, sky)),)
    return _TRUTH["radiance"][0]


def full_bloom(radiance, threshold=2.0, sigma=W / 50, strength=0.6):
    """Bloom by the whole kernel in two dimensions."""
    most = int(np.ceil(3 * sigma))
    k = np.exp(-0.5 * (np.arange(-most, most + 1) / sigma) ** 2)
    full = np.outer(k, k) / k.sum() ** 2
    bright = np.clip(radiance - threshold, 0, None)
    wide = np.pad(bright, ((most, most), (most, most), (0, 0)))
    spread = sum(
        full[v, u] * wide[v : v + len(bright), u : u + bright.shape[1]]
        for v, u in np.ndindex(full.shape)
    )
    return radiance + strength * (spread - bright)


def shown_by_formula(module, radiance):
    """Extended Reinhard of the luminance."""
    c = 2 ** TONES[0] * radiance
    Y = c @ module.LUMINANCE
    return c * ((1 + Y / TONES[1] ** 2) / (1 + Y))[..., None]


@functools.lru_cache(maxsize=2)
def small(module):
    """The buffers of a small frame, without ambient occlusion."""
    return module.render(H, W, rings=10, size=320)


def occlusion(module, settings, samples=16):
    """(H, W), 0 to 1, of the small frame."""
    frame = small(module)
    what = frame["depth"], frame["normal"], module.ZOOM * W, module.spiral(H, W, samples)
    found = module.ambient_occlusion(*what, np.asarray(settings), np.zeros((H, W)))[0]
    return np.clip(found, 0, 1)


def alike(module):
    """(H, W) of bool: the same surface in the frame and in the truth, by depth."""
    mine, theirs = (np.minimum(each["depth"], 1e6) for each in (small(module), truth(module)[0]))
    return (np.abs(mine / theirs - 1) < 0.01) & (theirs < 1e6)


def inside_shadows(module):
    """(H, W) of bool: one surface, in sun, and all neighbors agree on whether it is lit."""
    lit = truth(module)[2]
    around = [np.roll(lit, (v, u), axis=(0, 1)) for v in (-1, 0, 1) for u in (-1, 0, 1)]
    to_sun = module.LIGHTS["to_sun"] @ module.POSE[:, :3]
    even = np.min(around, axis=0) == np.max(around, axis=0)
    return even & alike(module) & (truth(module)[0]["normal"] @ to_sun > 0.1)


def square_of_tiles(module, affine):
    """(colors (H, W, 3), where): a square of tiles on the ground, made of two triangles.

    Their weights mix positions; with `affine` they are those that are linear in the picture.
    """
    ends = np.array([[-3.6, 0, -3.6], [3.6, 0, -3.6], [3.6, 0, 3.6], [-3.6, 0, 3.6]])
    corners = ends[[[0, 1, 2], [0, 2, 3]]]
    flat = module.project(corners.reshape(-1, 3), module.ZOOM * W, module.POSE, H, W)
    flat[:, :2] = np.round(256 * flat[:, :2]) / 256
    face, weights, _ = module.rasterize(flat.reshape(-1, 3, 3), H, W)
    if affine:
        weights = weights * flat.reshape(-1, 3, 3)[face][..., 2]
    weights = weights / np.maximum(weights.sum(axis=2, keepdims=True), 1e-300)
    x, _, z = np.moveaxis(np.einsum("hwk,hwkc->hwc", weights, corners[face]), 2, 0)
    even = (np.floor(x / 0.6) + np.floor(z / 0.6)) % 2 == 0
    kind = np.where(even, len(module.MATERIALS) - 1, 0)
    return np.where(face[..., None] >= 0, module.MATERIALS[kind, :3], 1.0), face >= 0


def rms(a, b, where=None):
    """Root of the mean squared difference."""
    square = (a - b) ** 2
    return float(np.sqrt(np.mean(square if where is None else square[where])))


def developed(module, radiance):
    """(H, W, 3) as files store it."""
    return module.develop(radiance, TONES)


def show(axes, picture, title, **options):
    axes.imshow(picture, interpolation="nearest", **options)
    axes.set(xticks=[], yticks=[])
    axes.set_title(title, fontsize=8)


def place(figure, box):
    """Axes of a box (left, top, width, height) in pixels of the written picture."""
    wide, high = figure.get_size_inches() * 110
    left, top, width, height = box
    return figure.add_axes((left / wide, 1 - (top + height) / high, width / wide, height / high))


def gray(axes, values, title):
    show(axes, values, title, cmap="gray", vmin=0, vmax=1)


def difference(axes, a, b, title, scale):
    """Signed difference of two pictures, around gray."""
    show(axes, np.clip(0.5 + (a - b) / (2 * scale), 0, 1), title)
