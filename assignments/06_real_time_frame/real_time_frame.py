"""A frame as engines draw it, pass by pass, and the same frame traced with your assignment 05.

The world is right-handed with y up, in meters. A camera looks along its own +z, with x to the right
and y down; it is a focal length in pixels, with the principal point in the middle of the picture,
and `pose` (3, 4), a rotation and a translation that take points of its frame into the world. Pixel
(row v, column u) has its center at (u + 0.5, v + 0.5). *Depth* is z in the camera's frame, infinite
where nothing is seen. A *G-buffer* is a dict of what each pixel shows:

    "depth"                             (H, W)
    "normal"                            (H, W, 3), unit, in the frame of the CAMERA
    "base_color", "emission"            (H, W, 3)
    "metalness", "roughness", "alpha"   (H, W)

*Lights* are a dict of arrays (3,): "to_sun", a unit vector in the WORLD; "sun", the irradiance of a
surface that faces it; "sky", a radiance. Colors are linear. Your tasks are six functions;
`photograd course check 06` tells how far you are. `rays.py` and `reflectance.py`, beside this file,
must be yours of assignments 05 and 04.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np
from rays import hit_sphere, hit_triangle
from reflectance import gltf

# Arrays and their shapes; float64 where nothing else is said.
Corners = Annotated[np.ndarray, "F 3 3"]
Faces = Annotated[np.ndarray, "H W"]  # int64
Weights = Annotated[np.ndarray, "H W 3"]
Depths = Annotated[np.ndarray, "H W"]
Points = Annotated[np.ndarray, "N 3"]
PerPoint = Annotated[np.ndarray, "N"]
Pose = Annotated[np.ndarray, "3 4"]
Pixels = Annotated[np.ndarray, "H W"]
Vectors = Annotated[np.ndarray, "H W 3"]
Colors = Annotated[np.ndarray, "H W 3"]
Layer = Annotated[np.ndarray, "H W 4"]  # red, green and blue times alpha, and alpha
Offsets = Annotated[np.ndarray, "H W S 2"]
Settings = Annotated[np.ndarray, "K"]
Buffers = dict[str, np.ndarray]

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear red, green, blue
REACH = 0.8  # m: what is farther away hides nothing of the sky
BIAS = 0.08  # sine of the elevation from which samples hide anything
GOLDEN = np.pi * (3 - np.sqrt(5))  # angle between neighbors on a spiral


def project(points, focal, pose, height, width):
    """Given: (x, y, depth) of points (N, 3) in a picture: x and y in pixels; depth above 0."""
    local = (points - pose[:, 3]) @ pose[:, :3]
    middle = np.array([width, height]) / 2
    return np.concatenate([focal * local[:, :2] / local[:, 2:] + middle, local[:, 2:]], axis=1)


def unproject(depth, focal):
    """Given: the points (H, W, 3) at the centers of pixels, in the camera's frame, 0 for sky."""
    height, width = depth.shape
    v, u = np.mgrid[:height, :width] + 0.5
    z = np.where(np.isfinite(depth), depth, 0.0)
    return np.stack([(u - width / 2) / focal * z, (v - height / 2) / focal * z, z], axis=2)


def pixel_block(triangle, height, width):
    """Given: the pixels whose centers a triangle (3, 3) may cover, a rectangle of the picture.

    Returns:
        (block, px, py): slices of its rows and columns, empty off the picture; x of its pixel
        centers (columns, 1) and y (rows, 1, 1).
    """
    low = np.clip(np.floor(triangle[:, :2].min(axis=0)), 0, [width, height]).astype(int)
    high = np.clip(np.ceil(triangle[:, :2].max(axis=0)), 0, [width, height]).astype(int)
    px, py = np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5
    block = slice(low[1], max(low[1], high[1])), slice(low[0], max(low[0], high[0]))
    return block, px[:, None], py[:, None, None]


def rasterize(corners: Corners, height: int, width: int) -> tuple[Faces, Weights, Depths]:
    """The nearest triangle in each pixel.

    Args:
        corners: (F, 3, 3), of each triangle its corners, and of each its (x, y, depth) in the
            picture; x and y are multiples of 1/256 pixel, depths above 0. Either winding; F may
            be 0.
        height, width: of the picture, in pixels.

    Returns:
        (face, weights, depth): face (H, W), int64, the number of the triangle, -1 for none;
        weights (H, W, 3), how much each of its corners counts in perspective, 0 for none; depth
        (H, W), infinite for none. Of equally near ones the first counts. Handout equations (3) to
        (8).
    """
    # >>> solution 06.1
    face, depth = np.full((height, width), -1), np.full((height, width), np.inf)
    weights = np.zeros((height, width, 3))
    for number, triangle in enumerate(corners):
        block, px, py = pixel_block(triangle, height, width)
        x, y, z = triangle.T
        dx, dy = x[[2, 0, 1]] - x[[1, 2, 0]], y[[2, 0, 1]] - y[[1, 2, 0]]
        turn = np.sign(dx[0] * dy[1] - dy[0] * dx[1])
        dx, dy = turn * dx, turn * dy
        edge = dx * (py - y[[1, 2, 0]]) - dy * (px - x[[1, 2, 0]])
        owns = (dy < 0) | ((dy == 0) & (dx > 0))
        inside = ((edge > 0) | ((edge == 0) & owns)).all(axis=2)
        part = edge / z
        total = np.where(inside, part.sum(axis=2), 1.0)
        near = edge.sum(axis=2) / total
        wins = inside & (near < depth[block])
        face[block][wins], depth[block][wins] = number, near[wins]
        weights[block][wins] = (part / total[..., None])[wins]
    return face, weights, depth
    # <<< solution


def shadow_test(
    points: Points, normals: Points, depth: Depths, focal: float, pose: Pose, bias: float
) -> PerPoint:
    """The fraction of the light that reaches points, by what a camera at the light sees.

    Args:
        points, normals: (N, 3), in the world; unit normals.
        depth: (T, T), the shadow map: depths that the light's camera sees, infinite for none.
        focal, pose: of the light's camera; all points lie in front of it.
        bias: b in meters, by which points are moved along their normals before the comparison.

    Returns:
        (N,), 0 to 1: the mean of nine comparisons, with the texel and its neighbors; where the map
        has no such texel, lit. Handout equations (9) to (11).
    """
    # >>> solution 06.2
    size = len(depth)
    u, v, z = project(points + bias * normals, focal, pose, size, size).T
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    lit = np.zeros(len(points))
    for down in (-1, 0, 1):
        for aside in (-1, 0, 1):
            r, c = row + down, column + aside
            exists = (r >= 0) & (r < size) & (c >= 0) & (c < size)
            there = depth[np.where(exists, r, 0), np.where(exists, c, 0)]
            lit += ~exists | (z <= there)
    return lit / 9
    # <<< solution


def local(normal, v):
    """Given: vectors (N, 3) in frames whose +z is the unit normal (N, 3), whatever their x and y.

    Reflectance models of assignment 04 take their directions there. NaN where the normal is 0.
    """
    least = np.abs(normal).argmin(axis=1)
    x = np.cross(normal, np.eye(3)[least])
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    frame = np.stack([x, np.cross(normal, x), normal], axis=1)
    return np.einsum("nij,nj->ni", frame, v)


def light_surfaces(
    gbuffer: Buffers, focal: float, pose: Pose, lights: Buffers, lit: Pixels, open_sky: Pixels
) -> Layer:
    """Light the surfaces of a G-buffer.

    Args:
        gbuffer, lights: as the head of the module says.
        focal, pose: of the camera.
        lit: (H, W), the fraction of sunlight that reaches each pixel's surface.
        open_sky: (H, W), the fraction of the sky that does.

    Returns:
        (H, W, 4): radiance with premultiplied alpha, and alpha; 0 where nothing is seen (there the
        normal is 0: do not light it). Handout equations (12) to (15).
    """
    # >>> solution 06.3
    seen = np.isfinite(gbuffer["depth"])
    kept = {name: values[seen] for name, values in gbuffer.items()}
    n = kept["normal"]
    to_eye = -unproject(gbuffer["depth"], focal)[seen]
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    to_sun = np.tile(lights["to_sun"] @ pose[:, :3], (len(n), 1))
    material = kept["base_color"], kept["metalness"], kept["roughness"]
    f = gltf(local(n, to_eye), local(n, to_sun), *material)
    cosine = np.sum(n * to_sun, axis=1)
    L = kept["emission"] + f * (lit[seen] * cosine)[:, None] * lights["sun"]
    L += kept["base_color"] * open_sky[seen][:, None] * lights["sky"]
    layer, alpha = np.zeros((*seen.shape, 4)), kept["alpha"][:, None]
    layer[seen] = np.concatenate([alpha * L, alpha], axis=1)
    return layer
    # <<< solution


def over(front, back):
    """Given: a layer (H, W, 4) with premultiplied alpha over a picture (H, W, 3)."""
    return front[..., :3] + (1 - front[..., 3:]) * back


def bloom(radiance: Colors, threshold: float, sigma: float, strength: float) -> Colors:
    """Spread a fraction of what is bright, as a lens does.

    Args:
        radiance: (H, W, 3), linear.
        threshold: what a channel has above it is bright.
        sigma: of the Gaussian, in pixels, above 0.
        strength: the fraction of the bright light that is spread, 0 to 1.

    Returns:
        (H, W, 3); light spread beyond the border is lost. Handout equations (16) to (18).
    """
    # >>> solution 06.4
    most = int(np.ceil(3 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-most, most + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    bright = np.maximum(radiance - threshold, 0.0)
    spread = bright
    for _ in range(2):
        padded = np.pad(spread, ((most, most), (0, 0), (0, 0)))
        moved = [w * padded[k : k + len(spread)] for k, w in enumerate(kernel)]
        spread = np.swapaxes(sum(moved), 0, 1)
    return radiance + strength * (spread - bright)
    # <<< solution


def tone_map(
    radiance: Colors, settings: Settings, d_shown: Colors
) -> tuple[Colors, Colors, Settings]:
    """Extended Reinhard of the luminance, and its adjoint.

    Args:
        radiance: (H, W, 3), linear, 0 or more.
        settings: (2,): the exposure e in stops, and `white`, the luminance that is shown as 1.
        d_shown: (H, W, 3), g: the derivative of some loss with respect to what is shown; zeros
            where only that is wanted.

    Returns:
        (shown, d_radiance, d_settings): what a display shows (H, W, 3), still linear; derivatives
        of that loss with respect to radiance (H, W, 3) and settings (2,). Handout equations (19)
        to (23).
    """
    # >>> solution 06.5
    exposure, white = settings
    scale = 2.0**exposure
    c = scale * radiance
    Y = (c @ LUMINANCE)[..., None]
    s = (1 + Y / white**2) / (1 + Y)
    along = np.sum(c * d_shown, axis=2, keepdims=True)
    d_c = s * d_shown + along * (1 / white**2 - 1) / (1 + Y) ** 2 * LUMINANCE
    d_white = -2 / white**3 * np.sum(along * Y / (1 + Y))
    return c * s, scale * d_c, np.array([np.log(2.0) * np.sum(c * d_c), d_white])
    # <<< solution


def spiral(height, width, samples):
    """Given: offsets (H, W, S, 2) in a disk of radius 1, turned in 16 ways in blocks of pixels."""
    v, u = np.mgrid[:height, :width]
    turn = 2 * np.pi * ((v % 4 * 7 + u % 4 * 4) % 16) / 16
    r = (np.arange(samples) + 0.5) / samples
    phi = turn[..., None] + GOLDEN * np.arange(samples)
    return r[:, None] * np.stack([np.cos(phi), np.sin(phi)], axis=3)


def ambient_occlusion(
    depth: Depths,
    normals: Vectors,
    focal: float,
    offsets: Offsets,
    settings: Settings,
    d_open: Pixels,
) -> tuple[Pixels, Settings]:
    """How much of the sky each pixel sees, by the depths around it, and its adjoint.

    Args:
        depth: (H, W), infinite for sky.
        normals: (H, W, 3), unit, in the camera's frame.
        focal: of the camera, in pixels.
        offsets: (H, W, S, 2), of the samples of each pixel, in units of REACH: x, y.
        settings: (3,): radius r in meters, falloff k and strength m, all above 0.
        d_open: (H, W), g: the derivative of some loss with respect to the result; zeros where
            only that is wanted.

    Returns:
        (open_sky, d_settings): (H, W), 1 on planes and for sky, not limited from below; the
        derivative of that loss with respect to settings (3,). Handout equations (24) to (29).
    """
    # >>> solution 06.6
    radius, falloff, strength = settings
    place, seen = unproject(depth, focal), np.isfinite(depth)
    height, width, samples = offsets.shape[:3]
    rows, columns = np.mgrid[:height, :width] + 0.5
    pixels = REACH * focal / depth
    hidden, by_radius, by_falloff = np.zeros((3, height, width))
    for k in range(samples):
        c = np.floor(columns + pixels * offsets[..., k, 0]).astype(int)
        r = np.floor(rows + pixels * offsets[..., k, 1]).astype(int)
        valid = (c >= 0) & (c < width) & (r >= 0) & (r < height)
        r, c = np.where(valid, r, 0), np.where(valid, c, 0)
        v = place[r, c] - place
        square = np.sum(v * v, axis=2)
        t = 1 - square / radius**2
        valid &= seen[r, c] & (square > 0) & (t > 0)
        square, t = np.where(valid, square, 1.0), np.where(valid, t, 1.0)
        sine = np.sum(v * normals, axis=2) / np.sqrt(square)
        a = valid * np.maximum(sine - BIAS, 0.0) * t**falloff
        hidden += a
        by_radius += a * 2 * falloff / t * square / radius**3
        by_falloff += a * np.log(t)
    g = -d_open / samples
    d_radius, d_falloff = strength * np.sum(g * by_radius), strength * np.sum(g * by_falloff)
    d_settings = np.array([d_radius, d_falloff, np.sum(g * hidden)])
    return 1 - strength / samples * hidden, d_settings
    # <<< solution


# The scene, and its passes ------------------------------------------------------------------------

# Rows: base color, metalness, roughness, emission, alpha. The last one is of the ground's tiles.
MATERIALS = np.array(
    [
        [0.17, 0.14, 0.12, 0.0, 0.85, 0.0, 0.0, 0.0, 1.0],  # ground
        [0.60, 0.54, 0.45, 0.0, 0.75, 0.0, 0.0, 0.0, 1.0],  # stone
        [1.00, 0.64, 0.16, 1.0, 0.38, 0.0, 0.0, 0.0, 1.0],  # gold
        [0.70, 0.06, 0.05, 0.0, 0.22, 0.0, 0.0, 0.0, 1.0],  # red
        [0.08, 0.25, 0.62, 0.0, 0.30, 0.0, 0.0, 0.0, 1.0],  # blue
        [0.95, 0.42, 0.26, 1.0, 0.45, 0.0, 0.0, 0.0, 1.0],  # copper
        [0.30, 0.10, 0.05, 0.0, 0.60, 9.0, 3.2, 1.1, 1.0],  # ember
        [0.75, 0.85, 0.95, 0.0, 0.12, 0.0, 0.0, 0.0, 0.3],  # bubble
        [0.62, 0.60, 0.55, 0.0, 0.55, 0.0, 0.0, 0.0, 1.0],  # tile
    ]
)
# Balls: center, radius, material. Boxes: center, half of the sides, turn around y, material.
BALLS = (
    ((0.0, 0.72, -0.5), 0.72, 2),
    ((-1.8, 0.42, 0.9), 0.42, 3),
    ((1.98, 1.02, 0.35), 0.32, 5),
    ((0.85, 0.3, 1.25), 0.3, 4),
    ((-0.75, 0.2, 1.7), 0.2, 1),
    ((2.55, 0.52, 1.25), 0.17, 6),
)
BUBBLES = (((-1.15, 1.35, 1.0), 0.36, 7), ((1.35, 0.5, 1.9), 0.24, 7))
BOXES = (
    ((0.0, -0.5, -24.0), (40.0, 0.5, 28.0), 0.0, 0),
    ((-1.25, 0.95, -0.6), (0.27, 0.95, 0.3), 0.0, 1),
    ((1.25, 0.95, -0.6), (0.27, 0.95, 0.3), 0.0, 1),
    ((0.0, 2.08, -0.6), (1.75, 0.18, 0.36), 0.0, 1),
    ((1.98, 0.35, 0.35), (0.42, 0.35, 0.42), 0.35, 1),
    ((2.55, 0.175, 1.25), (0.3, 0.175, 0.3), -0.2, 1),
)
LIGHTS = {
    "to_sun": np.array([-0.72, 0.52, 0.46]) / np.linalg.norm([-0.72, 0.52, 0.46]),
    "sun": np.array([8.2, 6.2, 4.2]),
    "sky": np.array([0.36, 0.42, 0.56]),
}


def look_at(eye, target):
    """The pose (3, 4) of a camera at `eye` that looks at `target`, both (3,)."""
    z = np.subtract(target, eye) / np.linalg.norm(np.subtract(target, eye))
    x = np.cross(z, [0.0, 1.0, 0.0])
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z, np.asarray(eye, float)], axis=1)


POSE = look_at((0.3, 1.9, 6.4), (0.3, 0.92, 0.0))
HALF = 4.2  # m: half of the width of the shadow map
ZOOM = 1.0  # focal length over the width of the picture


def ball_mesh(center, radius, rings):
    """(corners (F, 3, 3), normals at them) of a ball in 4 rings (rings - 1) triangles."""
    polar, turn = np.pi * np.arange(rings + 1) / rings, np.pi * np.arange(2 * rings + 1) / rings
    n = np.stack(
        [np.outer(np.sin(polar), np.cos(turn)), np.outer(np.cos(polar), 1 + 0 * turn)], axis=2
    )
    n = np.concatenate([n, np.outer(np.sin(polar), np.sin(turn))[..., None]], axis=2)
    a, b, c, d = n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]
    upper, lower = np.stack([a, b, c], axis=2)[:-1], np.stack([a, c, d], axis=2)[1:]
    normals = np.concatenate([upper.reshape(-1, 3, 3), lower.reshape(-1, 3, 3)])
    return center + radius * normals, normals


def box_mesh(center, half, turn):
    """(corners (12, 3, 3), normals at them) of a box."""
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])[[[0, 1, 2], [0, 2, 3]]]
    faces, normals = [], []
    for axis in range(3):
        for side in (-1, 1):
            faces.append(np.insert(square, axis, side, axis=2))
            normals.append(np.tile(side * np.eye(3)[axis], (2, 3, 1)))
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    corners = np.concatenate(faces) * half @ rotation.T + center
    return corners, np.concatenate(normals) @ rotation.T


def meshes(rings, balls=None, boxes=None):
    """(corners, normals, material) of each part, a list; without other parts those of the scene."""
    boxes, balls = (BOXES if boxes is None else boxes), (BALLS if balls is None else balls)
    parts = [(*box_mesh(np.array(c), np.array(half), turn), m) for c, half, turn, m in boxes]
    return parts + [(*ball_mesh(np.array(center), r, rings), m) for center, r, m in balls]


def joined(parts):
    """(corners (F, 3, 3), normals (F, 3, 3), material (F,)) of some parts."""
    kinds = [np.full(len(corners), kind) for corners, _, kind in parts]
    corners, normals = (np.concatenate([part[k] for part in parts]) for k in range(2))
    return corners, normals, np.concatenate(kinds)


def surfaces(depth, normal, kind, focal, pose):
    """A G-buffer of depths (H, W), normals (H, W, 3) in the world, and materials, -1 for none."""
    x, _, z = np.moveaxis(in_world(depth, focal, pose), 2, 0)
    even = (np.floor(x / 0.6) + np.floor(z / 0.6)) % 2 == 0
    kind = np.where(even & (kind == 0) & (np.hypot(x, z) < 3.6), len(MATERIALS) - 1, kind)
    rows = MATERIALS[kind] * (kind >= 0)[..., None]
    names = {"base_color": slice(0, 3), "metalness": 3, "roughness": 4, "emission": slice(5, 8)}
    gbuffer = {name: rows[..., columns] for name, columns in names.items()}
    return {**gbuffer, "alpha": rows[..., 8], "depth": depth, "normal": normal @ pose[:, :3]}


def in_world(depth, focal, pose):
    """The points (H, W, 3) at the centers of pixels, in the world."""
    return unproject(depth, focal) @ pose[:, :3].T + pose[:, 3]


def draw(parts, focal, pose, height, width):
    """The G-buffer of some parts, by your `rasterize`."""
    corners, normals, kinds = joined(parts)
    flat = project(corners.reshape(-1, 3), focal, pose, height, width)
    flat[:, :2] = np.round(256 * flat[:, :2]) / 256
    face, weights, depth = rasterize(flat.reshape(-1, 3, 3), height, width)
    normal = np.einsum("hwk,hwkc->hwc", weights, normals[face])
    normal /= np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-300)
    return surfaces(depth, normal, np.where(face < 0, -1, kinds[face]), focal, pose)


def sun_camera(to_sun, size):
    """(focal, pose) of the sun's camera: so far away that its rays are parallel."""
    far, middle = 1e4, np.array([0.0, 0.6, 0.0])
    return 0.5 * size * far / HALF, look_at(middle + far * to_sun, middle)


def sunlight(gbuffer, focal, pose, parts, size=512, texels=2.2):
    """(H, W): the fraction of sunlight that reaches each pixel, by your shadow map; 1 for sky.

    The bias is given in texels, each 2 HALF / size meters wide. Less than 2.2 is too small for some
    slopes: from a corner of its texel, a point is 1.5 sqrt(2) from the farthest of nine centers.
    """
    light = sun_camera(LIGHTS["to_sun"], size)
    corners = joined(parts)[0]
    flat = project(corners.reshape(-1, 3), *light, size, size)
    flat[:, :2] = np.round(256 * flat[:, :2]) / 256
    depth = rasterize(flat.reshape(-1, 3, 3), size, size)[2]
    seen = np.isfinite(gbuffer["depth"])
    points, normals = in_world(gbuffer["depth"], focal, pose)[seen], gbuffer["normal"][seen]
    lit, bias = np.ones(seen.shape), texels * 2 * HALF / size
    lit[seen] = shadow_test(points, normals @ pose[:, :3].T, depth, *light, bias)
    return lit


def sky_color(focal, pose, height, width):
    """The picture (H, W, 3) of the sky alone."""
    rays = unproject(np.ones((height, width)), focal) @ pose[:, :3].T
    up = rays[..., 1:2] / np.linalg.norm(rays, axis=2, keepdims=True)
    low, high = np.array([1.25, 0.78, 0.52]), np.array([0.22, 0.38, 0.72])
    return low + (high - low) * np.clip(up * 3.2, 0, 1) ** 0.7


def encode(shown):
    """The picture (H, W, 3) as files store it: limited to 1, in sRGB."""
    c = np.clip(shown, 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


# The truth, traced --------------------------------------------------------------------------------


def first_triangle(moved, direction):
    """(t, number), both (N,): the nearest of K triangles, given relative to each of N origins.

    `hit_triangle` takes one ray and many triangles, and only corners relative to its origin count:
    with triangles moved instead, one call tests many rays of one direction. moved: (N, K, 3, 3).
    """
    t = hit_triangle(np.zeros(3), direction, moved.reshape(-1, 3, 3))[0].reshape(moved.shape[:2])
    return t.min(axis=1, initial=np.inf), t.argmin(axis=1)


def covered(points, direction, t_max):
    """(N,) of bool: whether a ray from each point hits the scene before t_max, in one direction."""
    found, ways = np.zeros(len(points), bool), np.tile(direction, (len(points), 1))
    for center, radius, _ in BALLS:
        found |= hit_sphere(points, ways, np.array(center), radius) < t_max
    ends = points + min(t_max, 1e3) * direction
    low, high = np.minimum(points, ends), np.maximum(points, ends)
    for corners, _, _ in meshes(0, balls=()):
        box = corners.reshape(-1, 3)
        meets = ((low <= box.max(axis=0)) & (high >= box.min(axis=0))).all(axis=1)
        todo = np.flatnonzero(meets & ~found)
        for some in np.array_split(todo, len(todo) // 4000 + 1):
            t, _ = first_triangle(corners - points[some, None, None], direction)
            found[some] = t < t_max
    return found


def traced_surfaces(focal, pose, height, width, balls=None, boxes=None):
    """The G-buffer of balls and boxes, by your rays: here balls are round."""
    local = unproject(np.ones((height, width)), focal).reshape(-1, 3)
    ways, eye = local @ pose[:, :3].T, np.tile(pose[:, 3], (len(local), 1))
    t, kind, normal = np.full(len(ways), np.inf), np.full(len(ways), -1), np.zeros((len(ways), 3))
    for center, radius, material in BALLS if balls is None else balls:
        found = hit_sphere(eye, ways, np.array(center), radius)
        near = found < t
        t[near], kind[near] = found[near], material
        normal[near] = (eye[near] + found[near, None] * ways[near] - center) / radius
    for corners, normals, material in meshes(0, balls=(), boxes=boxes):
        # Each ray runs along z when its pixel's slope is taken from all corners.
        seen = (corners - pose[:, 3]) @ pose[:, :3]
        for some in np.array_split(np.arange(len(ways)), len(ways) // 4000 + 1):
            moved = seen - seen[..., 2:] * local[some, None, None] * [1, 1, 0]
            found, which = first_triangle(moved, np.array([0.0, 0.0, 1.0]))
            near = found < t[some]
            t[some[near]], kind[some[near]] = found[near], material
            normal[some[near]] = normals[which[near], 0]
    shape = height, width
    return surfaces(t.reshape(shape), normal.reshape(*shape, 3), kind.reshape(shape), focal, pose)


def lifted(gbuffer, focal, pose):
    """Where something is seen (H, W); its points, a bit above the surface, and normals (N, 3)."""
    seen = np.isfinite(gbuffer["depth"])
    normals = gbuffer["normal"][seen] @ pose[:, :3].T
    return seen, in_world(gbuffer["depth"], focal, pose)[seen] + 1e-6 * normals, normals


def traced_sunlight(gbuffer, focal, pose):
    """(H, W) of 0 and 1: whether a ray to the sun gets there; 1 for sky."""
    seen, points, _ = lifted(gbuffer, focal, pose)
    lit = np.ones(seen.shape)
    lit[seen] = ~covered(points, LIGHTS["to_sun"], np.inf)
    return lit


def traced_sky(gbuffer, focal, pose, count=48):
    """(H, W): the fraction of the sky that nothing nearer than REACH hides, by rays; 1 for sky."""
    seen, points, normals = lifted(gbuffer, focal, pose)
    height = 1 - 2 * (np.arange(count) + 0.5) / count
    phi, ring = GOLDEN * np.arange(count), np.sqrt(1 - height**2)
    free, total = np.zeros((2, len(points)))
    for way in np.stack([ring * np.cos(phi), height, ring * np.sin(phi)], axis=1):
        cosine = np.maximum(normals @ way, 0.0)
        up = cosine > 0
        total += cosine
        free[up] += cosine[up] * ~covered(points[up], way, REACH)
    sky = np.ones(seen.shape)
    sky[seen] = free / total
    return sky


# The whole frame ----------------------------------------------------------------------------------


def lit_frame(gbuffer, bubbles, focal, pose, lit, open_sky):
    """Radiance (H, W, 3): surfaces in front of the sky, and nearer bubbles over both."""
    shape = gbuffer["depth"].shape
    base = light_surfaces(gbuffer, focal, pose, LIGHTS, lit, np.clip(open_sky, 0.0, 1.0))
    depth = np.where(bubbles["depth"] < gbuffer["depth"], bubbles["depth"], np.inf)
    ones = np.ones(shape)
    front = light_surfaces({**bubbles, "depth": depth}, focal, pose, LIGHTS, ones, ones)
    return over(front, over(base, sky_color(focal, pose, *shape)))


def develop(radiance, settings=(0.2, 2.5)):
    """The picture (H, W, 3) of radiance: bloom, tone mapping, and only then sRGB."""
    shown = bloom(radiance, 2.0, radiance.shape[1] / 50, 0.6)
    return encode(tone_map(shown, np.array(settings), np.zeros_like(shown))[0])


def render(height, width, occlusion=None, rings=16, size=512, samples=16, texels=2.2):
    """All buffers of a frame, by your passes.

    Args:
        height, width: in pixels.
        occlusion: settings (3,) of `ambient_occlusion`; None goes without.
        rings: of triangles in each ball.
        size: of the shadow map.
        samples: of the ambient occlusion.
        texels: of the bias.
    """
    focal, parts = ZOOM * width, meshes(rings)
    gbuffer = draw(parts, focal, POSE, height, width)
    bubbles = draw(meshes(rings, BUBBLES, ()), focal, POSE, height, width)
    lit = sunlight(gbuffer, focal, POSE, parts, size, texels)
    open_sky = np.ones((height, width))
    if occlusion is not None:
        what = gbuffer["depth"], gbuffer["normal"], focal, spiral(height, width, samples)
        open_sky = ambient_occlusion(*what, np.array(occlusion), 0 * open_sky)[0]
    radiance = lit_frame(gbuffer, bubbles, focal, POSE, lit, open_sky)
    return {**gbuffer, "lit": lit, "open_sky": open_sky, "radiance": radiance}


def trace(height, width, count=48):
    """The same buffers, by your rays."""
    focal = ZOOM * width
    gbuffer = traced_surfaces(focal, POSE, height, width)
    bubbles = traced_surfaces(focal, POSE, height, width, BUBBLES, ())
    lit = traced_sunlight(gbuffer, focal, POSE)
    open_sky = traced_sky(gbuffer, focal, POSE, count)
    radiance = lit_frame(gbuffer, bubbles, focal, POSE, lit, open_sky)
    return {**gbuffer, "lit": lit, "open_sky": open_sky, "radiance": radiance}


def tune_occlusion(depth, normals, focal, target, settings, steps, rate=0.1):
    """Settings of `ambient_occlusion` nearest to a target (H, W), by Adam in their logarithms.

    Returns:
        (settings (3,), losses (steps,)): mean squared errors of surfaces before each step.
    """
    offsets, seen = spiral(*depth.shape, 8), np.isfinite(depth)
    x, m, v, losses = np.log(settings), np.zeros(3), np.zeros(3), np.zeros(steps)
    for k in range(steps):
        what = depth, normals, focal, offsets, np.exp(x)
        error = np.where(seen, ambient_occlusion(*what, np.zeros(depth.shape))[0] - target, 0.0)
        losses[k] = np.sum(error**2) / seen.sum()
        g = ambient_occlusion(*what, 2 * error / seen.sum())[1] * np.exp(x)
        m, v = 0.9 * m + 0.1 * g, 0.99 * v + 0.01 * g * g
        x = x - rate * m / (1 - 0.9 ** (k + 1)) / (np.sqrt(v / (1 - 0.99 ** (k + 1))) + 1e-12)
    return np.exp(x), losses
