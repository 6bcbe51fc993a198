"""The inputs of the workloads, made from formulas, and their fingerprints.

Other programs that measure the same workloads make the same inputs, bit for bit. `fingerprint` is
recorded for the usual sizes: a library or processor that rounds a sine differently shows up in the
"inputs" field of a report instead of as an unexplained digit in its quality row.
"""

from __future__ import annotations

import hashlib
import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

RECORDED = {
    "W1 nv=500 res=2048": "5b2b0689c738cf38",
    "W4 n=128 res=200 views=8": "92a6b833a56f6bc9",
    "W4 n=16 res=8 views=1": "bbf2719ce201136b",
    "W5 n=512 points=1000000": "90849c1cc0c7762d",
    "W5 n=256 points=200000": "bed43a2402088295",
    "W6a points=2000000": "445afa5c746f01b0",
    "W6a points=1000": "002ee91ab6cb7117",
    "W6b n=128 res=128 views=4": "54d7fd96b0050b75",
    "W6b n=32 res=16 views=1": "8572acd7267ff727",
    "W8 n=100000 res=512": "58aff03f9ae90801",
    "W9 nv=132": "17c26eaf121b8b47",
    "W10 evals=10000000 scalar 1024": "118bf309f8e2f4ff",
    "W10 evals=10000000 texture 1024": "8a436409dee41dd0",
    "W10 evals=2000 scalar 20": "f1e0f5d78c888c36",
    "W10 evals=2000 texture 20": "835310570d8723b4",
    "W8 n=300 res=32": "8215033ff18857d7",
}


def fingerprint(*arrays: Array) -> str:
    """First 16 hexadecimal digits of the SHA-256 of types, shapes and contents."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:16]


def inputs_row(name: str, *arrays: Array) -> dict[str, Any]:
    """Field "inputs" of a report: `agree` is None where nothing is recorded for this size."""
    found, recorded = fingerprint(*arrays), RECORDED.get(name)
    return {
        "name": name,
        "sha256": found,
        "recorded": recorded,
        "agree": None if recorded is None else found == recorded,
    }


def unit(vectors: Array) -> Array:
    """Vectors (..., 3) divided by their lengths."""
    lengths: Array = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / lengths


def pixel_centers(count: int) -> Array:
    """(count,) centers of equal cells of [-1, 1]."""
    return (np.arange(count) + 0.5) / count * 2 - 1


# W4: a dense volume


def volume_grid(n: int, phase: float) -> Array:
    """(n, n, n, 4) float32 r, g, b, sigma_t, index [z, y, x], values at voxel centers of [-1, 1]^3.

    sigma_t is a ball of fog with ripples; each color varies along one axis. Another phase is
    another scene.
    """
    c = pixel_centers(n).astype(np.float32)
    x, y, z = c[None, None, :], c[None, :, None], c[:, None, None]
    ripples = 0.4 * np.sin(9 * x + phase) * np.sin(8 * y - phase) * np.sin(7 * z + 2 * phase)
    ball = np.exp(-3.0 * (x * x + y * y + z * z))
    grid = np.empty((n, n, n, 4), np.float32)
    grid[..., 0] = 0.5 + 0.45 * np.sin(5 * x + phase)
    grid[..., 1] = 0.5 + 0.45 * np.sin(6 * y + 1 + phase)
    grid[..., 2] = 0.5 + 0.45 * np.sin(7 * z + 2 + phase)
    grid[..., 3] = 6.0 * ball * (0.6 + ripples)
    return grid


def orbit_rays(res: int, views: int) -> tuple[Array, Array]:
    """Origins and unit directions (views res res, 3) float32 of cameras around the y axis.

    Pinholes 3.2 m from the center, 45 degrees wide, that bob up and down by 0.35 radians.
    """
    half = np.tan(np.radians(45.0) / 2)
    across = pixel_centers(res) * half
    u, v = across[None, :, None], -across[:, None, None]
    origins, directions = [], []
    for view in range(views):
        azimuth = 2 * np.pi * view / views + 0.1
        height = 0.35 * np.sin(3 * azimuth)
        level, rise = np.cos(height), np.sin(height)
        eye = 3.2 * np.array([level * np.sin(azimuth), rise, level * np.cos(azimuth)])
        back = unit(eye)
        right = unit(np.cross([0, 1, 0], back))
        up = np.cross(back, right)
        directions.append(unit(u * right + v * up - back).reshape(-1, 3))
        origins.append(np.broadcast_to(eye, (res * res, 3)))
    return (
        np.concatenate(origins).astype(np.float32),
        np.concatenate(directions).astype(np.float32),
    )


# W6b: a sparse grid of spherical harmonics


def sparse_shell(n: int, phase: float) -> tuple[Array, Array]:
    """Which of n^3 voxels exist (index [z, y, x]), and their values (N, 49) float32 in C order.

    A shell of radius 0.7 with bumps, 0.16 thick, values at voxel centers of [-1, 1]^3: density,
    then 16 coefficients for each of three channels.
    """
    c = pixel_centers(n)
    z, y, x = np.meshgrid(c, c, c, indexing="ij")
    radius = np.sqrt(x * x + y * y + z * z)
    surface = 0.7 + 0.06 * np.sin(6 * x) * np.sin(5 * y) * np.sin(7 * z)
    occupied = np.abs(radius - surface) < 0.08
    x, y, z = x[occupied], y[occupied], z[occupied]
    depth = (np.abs(radius - surface) / 0.08)[occupied]
    values = np.empty((len(x), 49), np.float32)
    values[:, 0] = 12.0 * (1 - depth) * (0.7 + 0.3 * np.sin(4 * x + phase))
    k = np.arange(48)
    wave = 3 * x[:, None] * np.cos(k) + 3 * y[:, None] * np.sin(k) + 2 * z[:, None]
    values[:, 1:] = 0.15 * np.sin(wave + 0.7 * k + phase)
    values[:, [1, 17, 33]] += 0.8
    return occupied, values


# W5: a texture and points of it


def texture(n: int) -> Array:
    """(n, n, 3) float32 in [0, 1], index [row, column]: other waves in each channel."""
    c = (np.arange(n) + 0.5) / n
    v, u = np.meshgrid(c, c, indexing="ij")
    channels = []
    for k in range(3):
        along_u = np.sin(2 * np.pi * (3 + k) * u)
        along_v = np.sin(2 * np.pi * (4 - k) * v * (1 + u))
        channels.append(0.5 + 0.25 * along_u + 0.25 * along_v)
    return np.stack(channels, axis=-1).astype(np.float32)


def texture_points(count: int) -> Array:
    """(count, 2) float32 uniform texture coordinates, in random order."""
    return np.random.default_rng(3).random((count, 2), dtype=np.float32)


# W6a: directions, each with spherical-harmonic coefficients of its own


def sh_points(count: int) -> tuple[Array, Array, Array]:
    """Unit directions (count, 3), coefficients (count, 16, 3), weights (count, 3); float32."""
    random = np.random.default_rng(5)
    directions = unit(random.standard_normal((count, 3))).astype(np.float32)
    coefficients = random.standard_normal((count, 16, 3), dtype=np.float32)
    return directions, coefficients, random.standard_normal((count, 3), dtype=np.float32)


# W1: a mesh of a million triangles, and rays that all start inside


def displaced_sphere(nu: int, nv: int) -> tuple[Array, Array]:
    """Vertices (V, 3) float32 and faces (F, 3) uint32 of a sphere with bumps; F = 2 nu (nv - 1).

    nv - 1 rings of nu vertices from north to south along y, then the two poles. Corners run
    counter-clockwise as seen from outside.
    """
    theta = np.append(np.repeat(np.pi * np.arange(1, nv) / nv, nu), [0.0, np.pi])
    phi = np.append(np.tile(2.0 * np.pi * np.arange(nu) / nu, nv - 1), [0.0, 0.0])
    sine = np.sin(theta)
    fade = sine**4  # no bumps at the poles, where the triangles are thin
    coarse = 0.10 * fade * np.sin(8 * phi) * np.sin(6 * theta)
    fine = 0.02 * fade * np.sin(61 * phi) * np.sin(53 * theta)
    radius = 1.0 + coarse + fine
    outward = np.stack([sine * np.cos(phi), np.cos(theta), sine * np.sin(phi)], axis=-1)
    vertices = (outward * radius[:, None]).astype(np.float32)

    here = np.arange(nu)
    following = (here + 1) % nu
    ring = nu * np.arange(nv - 2)[:, None]  # first vertex of each ring but the last
    a, b = ring + here, ring + following
    c, d = a + nu, b + nu  # below them
    between = np.stack([a, b, c, b, d, c], axis=-1).reshape(-1, 3)
    north = np.full(nu, (nv - 1) * nu)
    last = (nv - 2) * nu
    top = np.stack([north, following, here], axis=-1)
    bottom = np.stack([north + 1, last + here, last + following], axis=-1)
    return vertices, np.concatenate([between, top, bottom]).astype(np.uint32)


def primary_directions(res: int) -> Array:
    """(res res, 3) float64: a pinhole at the center that looks along -z, 90 degrees wide."""
    c = pixel_centers(res)
    u, v = np.broadcast_arrays(c[None, :], -c[:, None])
    return unit(np.stack([u, v, -np.ones_like(u)], axis=-1).reshape(-1, 3))


def face_towards(directions: Array, nu: int, nv: int) -> Array:
    """(R,) the face of the displaced sphere that directions from the center point at, roughly."""
    theta = np.arccos(np.clip(directions[:, 1], -1, 1))
    phi = np.mod(np.arctan2(directions[:, 2], directions[:, 0]), 2 * np.pi)
    row = np.clip((theta / np.pi * nv).astype(int) - 1, 0, nv - 3)
    column = np.clip((phi / (2 * np.pi) * nu).astype(int), 0, nu - 1)
    face: Array = 2 * (row * nu + column)
    return face


def cosine_directions(normals: Array, seed: int) -> Array:
    """(R, 3) float64 directions about normals (R, 3), density cos / pi; frames of [Duff2017]."""
    x, y, z = normals.T
    sign = np.where(z >= 0, 1.0, -1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    tangent = np.stack([1 + sign * x**2 * a, sign * b, -sign * x], axis=-1)
    bitangent = np.stack([b, sign + y**2 * a, -y], axis=-1)
    u = np.random.default_rng(seed).random((len(normals), 2))
    radius, angle = np.sqrt(u[:, 0])[:, None], (2 * np.pi * u[:, 1])[:, None]
    flat = radius * np.cos(angle) * tangent + radius * np.sin(angle) * bitangent
    return unit(flat + np.sqrt(np.maximum(1 - u[:, 0], 0))[:, None] * normals)


def ray_sets(vertices: Array, faces: Array, res: int) -> dict[str, tuple[Array, Array]]:
    """{"primary", "bounce"}: origins and directions (res res, 3) float32; nu = 2 nv is assumed.

    A bounce ray starts 0.1 mm inside of the middle of the face that its primary ray sees and leaves
    in a cosine-distributed direction: neighbors start side by side and part at once.
    """
    nv = round((1 + (1 + len(faces)) ** 0.5) / 2)
    forward = primary_directions(res)
    corners = vertices.astype(np.float64)[faces[face_towards(forward, 2 * nv, nv)]]
    edge_b, edge_c = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    outward = np.cross(edge_b, edge_c)
    outward /= np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-30)
    inward = -outward
    start = corners.mean(axis=1) + 1e-4 * inward
    rays = {
        "primary": (np.zeros_like(forward), forward),
        "bounce": (start, cosine_directions(inward, seed=1)),
    }
    return {name: (o.astype(np.float32), d.astype(np.float32)) for name, (o, d) in rays.items()}


# W10: directions in pairs, and a surface


def bsdf_pairs(count: int) -> tuple[Array, Array, Array]:
    """Directions (N, 3) of both ends, z up, dense as the cosine, z >= 0.02; weights (N, 3)."""
    g = np.random.default_rng(17)

    def directions() -> Array:
        u = g.random((count, 2), dtype=np.float32)
        r, phi = np.sqrt(u[:, 0] * np.float32(0.9996)), np.float32(2 * np.pi) * u[:, 1]
        return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - r * r)], -1)

    first, second = directions(), directions()
    return first, second, g.random((count, 3), dtype=np.float32)


def bsdf_parameters(kind: str, texels: int) -> tuple[Array, Array, Array]:
    """Base color, metalness, roughness: "scalar" (3,), (), (); "texture" of texels^2 each."""
    if kind == "scalar":
        return np.array([0.7, 0.4, 0.2], np.float32), np.float32(0.3), np.float32(0.35)  # type: ignore[return-value]
    t = texture(texels)
    roughness = (0.15 + 0.7 * t[..., :1]).astype(np.float32)
    return 0.1 + 0.8 * t, np.ascontiguousarray(t[..., 1:2]), roughness


# W8: Gaussians in a ball, and a camera that sees it


def gaussians(count: int) -> dict[str, Array]:
    """Random Gaussians in the unit ball, float32, raw, degree 3; the more, the smaller."""
    g = np.random.default_rng(7)
    means = unit(g.standard_normal((count, 3))) * g.random((count, 1)) ** (1 / 3)
    size = np.log(0.008 * (100_000 / count) ** (1 / 3))
    log_scales = size + 0.5 * g.standard_normal((count, 3))
    quats = unit(g.standard_normal((count, 4)))
    opacity_logits = g.uniform(-2.0, 3.0, count)
    flat = 0.6 * g.standard_normal((count, 1, 3))
    sh = np.concatenate([flat, 0.08 * g.standard_normal((count, 15, 3))], axis=1)
    arrays = {
        "means": means,
        "log_scales": log_scales,
        "quats": quats,
        "opacity_logits": opacity_logits,
        "sh": sh,
    }
    return {name: np.ascontiguousarray(array, np.float32) for name, array in arrays.items()}


def splat_camera(res: int) -> tuple[Array, float]:
    """camera_from_world (3, 4) float32 of a camera 2.6 m from the center, and its focal length."""
    eye = 2.6 * unit(np.array([0.5, 0.35, 0.8]))
    forward = -unit(eye)
    right = unit(np.cross(forward, [0, 1, 0]))
    rotation = np.stack([right, np.cross(forward, right), forward])
    view = np.column_stack([rotation, -rotation @ eye]).astype(np.float32)
    return view, float(0.5 * res / np.tan(np.radians(50.0) / 2))


HASH = {"levels": 16, "coarsest": 16, "finest": 2048, "log2_rows": 19, "features": 2}
"""Of W7a's encoding, as arguments of `HashEncoding.geometric`."""


def field_points(count: int) -> tuple[Array, Array]:
    """Points (N, 3) in [0, 1) and target values (N, 4), float32."""
    points = np.random.default_rng(13).random((count, 3), dtype=np.float32)
    waves = np.array([[3, 1, 2], [1, 4, 1], [2, 2, 3], [5, 1, 1]], np.float32)
    return points, (0.5 + 0.5 * np.sin(6 * points @ waves.T)).astype(np.float32)


def hash_tables() -> Array:
    """Rows of all levels (levels, 2^log2_rows, features), float32; dense levels take the first."""
    shape = HASH["levels"], 2 ** HASH["log2_rows"], HASH["features"]
    return np.random.default_rng(11).uniform(-0.1, 0.1, shape).astype(np.float32)


def layer_weights(sizes: list[int], seed: int = 12) -> list[Array]:
    """Matrices (out, in) of layers of these sizes, float32."""
    random = np.random.default_rng(seed)
    return [
        (random.standard_normal((gives, takes)) * np.sqrt(2.0 / takes)).astype(np.float32)
        for takes, gives in itertools.pairwise(sizes)
    ]
