"""A lens with a flat front and a height field as its back, and how rays depend on the heights.

    vertex (i, j) of the back = corner + (j / (n - 1)) edge_x + (i / (m - 1)) edge_y
                                + (thickness + h[i, j]) axis          axis = edge_x x edge_y, unit
    normal at a vertex ~ axis - h_x x - h_y y        x, y: unit edges

h_x and h_y are central differences, one-sided along the border. The front is at the corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.caustics.surfaces import SpecularMesh, SurfaceGradient
from photograd.errors import RangeError, message
from photograd.transport.shapes import MeshShape
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class Lens:
    """A closed slab of glass between a flat front and a height field.

    Attributes:
        corner: (3,) of the front, meters.
        edge_x, edge_y: (3,) of the front, perpendicular, meters; light goes along edge_x x edge_y.
        thickness: meters between the front and height 0.
        heights: (m, n) meters, rows along edge_y; at least 2 each way.
        eta: refractive index over that of what is around, above 1.

    Raises:
        ShapeError: arrays of other shapes.
        RangeError: numbers that are not finite, edges that are not perpendicular, eta not above 1,
            or a back that comes down to the front.
    """

    corner: Any
    edge_x: Any
    edge_y: Any
    thickness: float
    heights: Any
    eta: float = 1.5

    def __post_init__(self) -> None:
        call = Arguments("Lens", np.float64)
        for name in ("corner", "edge_x", "edge_y"):
            object.__setattr__(self, name, np.array(call.array(name, getattr(self, name), (3,))))
        x, y = (np.sqrt(np.square(e).sum()) for e in (self.edge_x, self.edge_y))
        if not (x > 0 and y > 0) or abs(float((self.edge_x * self.edge_y).sum())) > 1e-6 * x * y:
            got = f"{self.edge_x} and {self.edge_y}"
            expected = "perpendicular edges of some length"
            raise RangeError(message("Lens", "edge_x, edge_y", expected, got))
        call.number("thickness", self.thickness, above=0)
        call.number("eta", self.eta, above=1)
        heights = call.array("heights", self.heights, ("m", "n"), min_length=2)
        object.__setattr__(self, "heights", np.array(heights))
        thinnest = float(self.thickness + heights.min())
        if not thinnest > 0:
            expected, remedy = "a back behind the front", "make the lens thicker"
            raise RangeError(message("Lens", "heights", expected, f"{thinnest:.3g} m", remedy))

    @property
    def frame(self) -> FloatArray:
        """(3, 3) rows: unit x, unit y, and the axis, in the world."""
        x, y = (e / np.sqrt(np.square(e).sum()) for e in (self.edge_x, self.edge_y))
        return np.array([x, y, np.cross(x, y)])

    @property
    def spacing(self) -> tuple[float, float]:
        """Meters between columns and between rows."""
        m, n = self.heights.shape
        x, y = (float(np.sqrt(np.square(e).sum())) for e in (self.edge_x, self.edge_y))
        return x / (n - 1), y / (m - 1)

    def plane(self) -> FloatArray:
        """(m, n, 3) points of the front below the vertices."""
        m, n = self.heights.shape
        x, y = np.arange(n) / (n - 1), np.arange(m) / (m - 1)
        across = x[None, :, None] * self.edge_x + y[:, None, None] * self.edge_y
        return np.asarray(self.corner + across)

    def back(self) -> FloatArray:
        """(m, n, 3) vertices of the back."""
        return np.asarray(self.plane() + (self.thickness + self.heights)[..., None] * self.frame[2])

    def normals(self) -> FloatArray:
        """(m, n, 3) normals of the back, not unit."""
        frame, (dx, dy) = self.frame, self.spacing
        h_x = slopes(self.heights.T).T / dx
        h_y = slopes(self.heights) / dy
        return np.asarray(frame[2] - h_x[..., None] * frame[0] - h_y[..., None] * frame[1])

    def surfaces(self) -> list[SpecularMesh]:
        """Front, back and sides, for `SpecularScene`; the back has smooth normals."""
        shape = self.heights.shape
        grid = grid_faces(*shape)
        front, back = self.plane().reshape(-1, 3), self.back().reshape(-1, 3)
        m, n = shape
        corners = np.array([0, n - 1, m * n - 1, (m - 1) * n])
        return [
            SpecularMesh(front[corners], np.array([[0, 2, 1], [0, 3, 2]]), eta=self.eta),
            SpecularMesh(back, grid, self.normals().reshape(-1, 3), self.eta),
            SpecularMesh(np.concatenate([front, back]), side_faces(m, n), eta=self.eta),
        ]

    def heights_backward(self, gradients: list[SurfaceGradient]) -> FloatArray:
        """dL/dheights (m, n).

        Args:
            gradients: dL/d of the three `surfaces`, in their order.
        """
        shape = self.heights.shape
        frame, (dx, dy) = self.frame, self.spacing
        _, back, side = gradients
        moved = back.vertices + side.vertices[len(back.vertices) :]
        d_heights = np.einsum("vk,k->v", moved, frame[2]).reshape(shape)
        d_normals = back.normals.reshape(*shape, 3)
        d_hx = -np.einsum("ijk,k->ij", d_normals, frame[0]) / dx
        d_hy = -np.einsum("ijk,k->ij", d_normals, frame[1]) / dy
        return np.asarray(d_heights + slopes_backward(d_hx.T).T + slopes_backward(d_hy))

    def closed_mesh(self) -> tuple[FloatArray, Array]:
        """Vertices (V, 3), meters, and faces (F, 3) of the whole lens: closed, each vertex once."""
        m, n = self.heights.shape
        vertices = np.concatenate([self.plane().reshape(-1, 3), self.back().reshape(-1, 3)])
        grid = grid_faces(m, n)
        return vertices, np.concatenate([grid[:, ::-1], grid + m * n, side_faces(m, n)])

    def shape(self, name: str, material: str) -> MeshShape:
        """The lens as a shape of a scene, with the normals that chains see.

        Args:
            name: of the shape.
            material: name of a material of model glass, with the same eta.
        """
        vertices: list[Array] = []
        faces: list[Array] = []
        normals: list[Array] = []
        for part in self.surfaces():
            corners = part.faces
            points, bent = part.vertices, part.normals
            if bent is None:  # a vertex of its own for each corner of a flat face
                points = part.vertices[corners].reshape(-1, 3)
                a, b, c = (part.vertices[corners[:, k]] for k in range(3))
                bent = np.repeat(np.cross(b - a, c - a), 3, axis=0)
                corners = np.arange(len(points)).reshape(-1, 3)
            faces.append(corners + sum(map(len, vertices)))
            vertices.append(points)
            normals.append(bent / np.sqrt(np.square(bent).sum(axis=1, keepdims=True)))
        return MeshShape(
            name,
            np.concatenate(vertices),
            np.concatenate(faces),
            material,
            normals=np.concatenate(normals),
        )


def slopes(h: FloatArray) -> FloatArray:
    """(m, n) central differences between rows, one-sided at the first and the last.

    Args:
        h: (m, n).
    """
    out = np.empty_like(h)
    out[1:-1] = 0.5 * (h[2:] - h[:-2])
    out[0], out[-1] = h[1] - h[0], h[-1] - h[-2]
    return out


def slopes_backward(d_out: FloatArray) -> FloatArray:
    """dL/dh, the transpose of `slopes`.

    Args:
        d_out: (m, n) dL/d of what it returned.
    """
    d_h = np.zeros_like(d_out)
    d_h[2:] += 0.5 * d_out[1:-1]
    d_h[:-2] -= 0.5 * d_out[1:-1]
    d_h[1] += d_out[0]
    d_h[0] -= d_out[0]
    d_h[-1] += d_out[-1]
    d_h[-2] -= d_out[-1]
    return d_h


def grid_faces(m: int, n: int) -> Array:
    """(2 (m - 1) (n - 1), 3) faces of a grid of m rows and n columns, against its axis x row."""
    first = (np.arange(m - 1)[:, None] * n + np.arange(n - 1)).reshape(-1)
    a, b, c, d = first, first + 1, first + n + 1, first + n
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def side_faces(m: int, n: int) -> Array:
    """Faces between the border of a grid and that of its copy, m n vertex numbers later."""
    ring = np.concatenate(
        [
            np.arange(n - 1),
            np.arange(m - 1) * n + n - 1,
            (m - 1) * n + np.arange(n - 1, 0, -1),
            np.arange(m - 1, 0, -1) * n,
        ]
    )
    after = np.roll(ring, -1)
    up = m * n
    one = np.stack([ring, after, after + up], axis=1)
    return np.concatenate([one, np.stack([ring, after + up, ring + up], axis=1)])
