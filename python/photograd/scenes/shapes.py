"""Closed shapes around the origin: ball, box, ring, superellipsoid.

All are watertight, counter-clockwise seen from outside, and carry texture coordinates with u to the
right and v down. `ico_sphere` has the evenest triangles.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from photograd_course.checks import require_integer, require_number

from photograd.scenes.surface import Surface, from_grid, joined
from photograd.types import FloatArray


def sphere(radius: float, *, rows: int = 48, columns: int = 96) -> Surface:
    """A ball with poles on the Y axis; u is longitude, v goes from the upper pole to the lower."""
    return superellipsoid((radius, radius, radius), rows=rows, columns=columns)


def superellipsoid(
    half_axes: tuple[float, float, float],
    *,
    north: float = 1.0,
    east: float = 1.0,
    rows: int = 48,
    columns: int = 96,
) -> Surface:
    """Between ellipsoid, box and octahedron [Barr1981]: |cos|^e and |sin|^e with their signs.

    Args:
        half_axes: meters along X, Y, Z.
        north: exponent of the profile: 1 round, near 0 a cylinder, 2 a double cone.
        east: exponent of the cross-section: 1 round, near 0 square, 2 a square on its corner.
        rows, columns: number of faces along and around, at least 2 and 3.

    Raises:
        RangeError, DtypeError: axes not positive, exponents outside 0.05..4, too few faces.
    """
    for axis in half_axes:
        require_number("superellipsoid", "half_axes", axis, least=1e-6)
    for name, exponent in (("north", north), ("east", east)):
        require_number("superellipsoid", name, exponent, least=0.05, most=4.0)
    require_integer("superellipsoid", "rows", rows, least=2)
    require_integer("superellipsoid", "columns", columns, least=3)
    latitude = np.pi * (0.5 - np.arange(rows + 1) / rows)
    longitude = 2.0 * np.pi * np.arange(columns) / columns
    across, up = _power(np.cos(latitude), north), _power(np.sin(latitude), north)
    across[[0, -1]] = 0.0  # the poles: cos(pi/2) is 6e-17 in floating point
    sideways = np.stack(
        [_power(np.sin(longitude), east), np.zeros(columns), _power(np.cos(longitude), east)], -1
    )
    points = across[:, None, None] * sideways
    points[..., 1] = up[:, None]
    return from_grid(points * np.asarray(half_axes), closed_columns=True)


def ico_sphere(radius: float, *, subdivisions: int = 4) -> Surface:
    """A ball of 20 * 4^subdivisions nearly equal triangles.

    uv are longitude and latitude of the vertices; triangles across the seam have none that a
    texture could use, so this one is for colors of vertices.

    Raises:
        RangeError, DtypeError: radius not positive, or subdivisions outside 0..7.
    """
    require_number("ico_sphere", "radius", radius, least=1e-6)
    require_integer("ico_sphere", "subdivisions", subdivisions, least=0, most=7)
    vertices, faces = _icosahedron()
    for _ in range(subdivisions):
        vertices, faces = _subdivided(vertices, faces)
    u = np.arctan2(vertices[:, 0], vertices[:, 2]) / (2.0 * np.pi) % 1.0
    v = np.arccos(np.clip(vertices[:, 1], -1.0, 1.0)) / np.pi
    return Surface(radius * vertices, faces, np.stack([u, v], axis=-1))


def torus(
    ring: float, thickness: float, *, rows: int = 48, columns: int = 96, flatten: float = 1.0
) -> Surface:
    """A ring around the Y axis.

    Args:
        ring: radius of the circle in the middle of the tube.
        thickness: radius of the tube, less than `ring`.
        rows, columns: number of faces around the tube and along it, at least 3.
        flatten: the tube's half height over its half width.

    Raises:
        RangeError, DtypeError: numbers outside their range.
    """
    require_number("torus", "thickness", thickness, least=1e-6)
    require_number("torus", "ring", ring, least=thickness, open_ends=True)
    require_number("torus", "flatten", flatten, least=1e-3)
    require_integer("torus", "rows", rows, least=3)
    require_integer("torus", "columns", columns, least=3)
    around = 2.0 * np.pi * np.arange(rows) / rows  # from the top outwards and down
    angle = 2.0 * np.pi * np.arange(columns) / columns
    circle = np.stack([np.sin(angle), np.zeros(columns), np.cos(angle)], axis=-1)
    points = (ring + thickness * np.sin(around))[:, None, None] * circle
    points[..., 1] = (flatten * thickness * np.cos(around))[:, None]
    return from_grid(points, closed_rows=True, closed_columns=True)


def rounded_box(
    half_sizes: tuple[float, float, float], rounding: float, *, rings: int = 4
) -> Surface:
    """A box with rounded edges and corners; each side shows the whole texture.

    Args:
        half_sizes: meters along X, Y, Z.
        rounding: radius of the edges, at most the smallest half size.
        rings: faces across half an edge, at least 1.

    Raises:
        RangeError, DtypeError: numbers outside their range.
    """
    for size in half_sizes:
        require_number("rounded_box", "half_sizes", size, least=1e-6)
    require_number("rounded_box", "rounding", rounding, least=1e-6, most=min(half_sizes))
    require_integer("rounded_box", "rings", rings, least=1)
    sizes = np.asarray(half_sizes)
    edge = np.linspace(0.0, rounding, rings + 1)
    nets = [np.unique(np.concatenate([edge - size, size - edge])) for size in half_sizes]
    sides = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            flat = _side(axis, sign, nets, half_sizes[axis])
            core = np.clip(flat, rounding - sizes, sizes - rounding)
            outward = flat - core
            outward /= np.linalg.norm(outward, axis=-1, keepdims=True)
            side = from_grid(core + rounding * outward)
            sides.append(Surface(side.vertices, side.faces, _flat_uv(flat)))
    return joined(sides)


def _flat_uv(flat: FloatArray) -> FloatArray:
    """Shares of the way (M N, 2) along the rows and columns of a flat net, not counts of them."""
    along_row = np.linalg.norm(flat[0] - flat[0, :1], axis=-1)
    along_column = np.linalg.norm(flat[:, 0] - flat[:1, 0], axis=-1)
    u, v = np.meshgrid(along_row / along_row[-1], along_column / along_column[-1])
    return np.stack([u, v], axis=-1).reshape(-1, 2)


def _side(axis: int, sign: float, nets: list[FloatArray], size: float) -> FloatArray:
    """One flat side (M, N, 3) of a box, rows downwards and columns to the right from outside."""
    down = 1 if axis != 1 else 2
    right = 3 - axis - down
    turned = [net[::-1] for net in nets]
    # right x down points into the box; the order of the remaining axes decides who is turned.
    inward = np.cross(np.eye(3)[right], np.eye(3)[down])[axis]
    rows = turned[down] if down == 1 else nets[down]
    flips = inward * (-1.0 if down == 1 else 1.0) * sign > 0.0
    columns = turned[right] if flips else nets[right]
    points = np.empty((len(rows), len(columns), 3))
    points[..., axis] = sign * size
    points[..., down] = rows[:, None]
    points[..., right] = columns
    return points


def _power(base: FloatArray, exponent: float) -> FloatArray:
    return np.asarray(np.sign(base) * np.abs(base) ** exponent)


def _icosahedron() -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Twelve unit vertices and twenty faces: two poles and two rings of five, staggered."""
    height, radius = 1.0 / np.sqrt(5.0), 2.0 / np.sqrt(5.0)
    step = 2.0 * np.pi / 5.0
    upper = [[radius * np.sin(step * k), height, radius * np.cos(step * k)] for k in range(5)]
    lower = [
        [radius * np.sin(step * (k + 0.5)), -height, radius * np.cos(step * (k + 0.5))]
        for k in range(5)
    ]
    vertices = np.array([[0.0, 1.0, 0.0], *upper, *lower, [0.0, -1.0, 0.0]])
    faces = []
    for k in range(5):
        after = (k + 1) % 5
        faces += [
            [0, 1 + k, 1 + after],
            [1 + k, 6 + k, 1 + after],
            [1 + after, 6 + k, 6 + after],
            [11, 6 + after, 6 + k],
        ]
    return vertices, np.array(faces)


def _subdivided(
    vertices: FloatArray, faces: npt.NDArray[np.int64]
) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Each triangle in four; the middles of edges are pushed out to the unit sphere."""
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    middles = vertices[unique].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    ab, bc, ca = (len(vertices) + inverse.reshape(-1, 3)).T
    a, b, c = faces.T
    quarters = [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
    new_faces = np.concatenate([np.stack(corner, axis=-1) for corner in quarters])
    return np.concatenate([vertices, middles]), new_faces
