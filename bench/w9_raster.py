"""W9: the antialiased silhouette of a mesh, and the gradient of a loss with respect to vertices.

The displaced sphere covers about half of the picture. Forward: vertices to the coverage of pixels.
The loss is the mean of (coverage - target)^2, the target being the same mesh moved by
(0.05, 0.03, 0); the edges of the mesh are listed once. The gradient is that of edge sampling, with
one random point a pixel of silhouette; `--edges 0` takes that of the antialiased picture instead.
`--ids` times the visibility buffer alone.
"""

from __future__ import annotations

from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.capture.camera import Camera
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    antialias,
    antialias_backward,
    edge_gradient,
    find_crossings,
    project,
    project_backward,
    rasterize,
    sample_edges,
)

Array = NDArray[Any]
SHIFT = np.array([0.05, 0.03, 0.0])


class Silhouette:
    """The workload: a mesh in front of a camera."""

    def __init__(self, nv: int, res: int, edges: float) -> None:
        vertices, self.faces = _inputs.displaced_sphere(2 * nv, nv)
        self.inputs = _inputs.inputs_row(f"W9 nv={nv}", vertices, self.faces)
        self.vertices = vertices.astype(np.float64)
        self.size, self.per_pixel, self.edges = (res, res), edges, MeshEdges.of(self.faces)
        pose = np.diag([1.0, -1.0, -1.0, 1.0])  # at (0, 0, 3.2), looking along -Z
        pose[2, 3] = 3.2
        focal = res / 2 / np.tan(np.radians(22.5))
        self.camera = Camera(res, res, focal, focal, res / 2, res / 2, pose)
        self.target = self.forward(SHIFT)[0]

    def ids(self) -> Array:
        return rasterize(project(self.vertices, self.camera), self.faces, self.size).face

    def forward(self, shift: Array | float = 0.0) -> tuple[Array, Any]:
        """Coverage (H, W, 1), and what the backward pass needs."""
        positions = project(self.vertices + shift, self.camera)
        visibility = rasterize(positions, self.faces, self.size)
        sampled = visibility.covered[..., None].astype(np.float64)
        crossings = find_crossings(positions, self.faces, visibility, self.edges)
        return antialias(sampled, crossings), (positions, sampled, crossings)

    def both(self) -> tuple[float, Array]:
        """The loss, and its gradient (V, 3)."""
        picture, (positions, sampled, crossings) = self.forward()
        error = picture - self.target
        d_picture = error * (2 / error.size)
        if self.per_pixel:
            d_positions = self.sampled_gradient(positions, d_picture, self.per_pixel)
        else:
            _, d_positions = antialias_backward(
                sampled, crossings, d_picture, positions, self.edges
            )
        gradient = project_backward(self.vertices, self.camera, d_positions).vertices
        return float(np.square(error).mean()), gradient

    def sampled_gradient(self, positions: Array, d_picture: Array, per_pixel: float) -> Array:
        lookup = FaceLookup(positions, self.faces, self.size)
        samples = sample_edges(positions, self.edges, self.size, per_pixel=per_pixel)

        def coverage(points: Array) -> Array:
            return (lookup.nearest(points)[0] >= 0)[:, None].astype(np.float64)

        return edge_gradient(positions, self.edges, samples, coverage, d_picture)

    def differences(self, step: float = 1e-3, factor: int = 4) -> list[float]:
        """dL/d(x, y) of the mesh's position, of pictures of factor^2 times as many samples."""
        fine = Silhouette.__new__(Silhouette)
        vars(fine).update(vars(self))
        res = factor * self.size[0]
        fine.size, camera = (res, res), self.camera
        fine.camera = Camera(
            res,
            res,
            factor * camera.fx,
            factor * camera.fy,
            res / 2,
            res / 2,
            camera.world_from_camera,
        )

        def coverage(shift: Array) -> Array:
            picture = fine.forward(shift)[0]
            return picture.reshape(self.size[0], factor, -1, factor).mean(axis=(1, 3))

        target = coverage(SHIFT)
        losses = [
            [np.square(coverage(sign * step * axis) - target).mean() for sign in (1, -1)]
            for axis in np.eye(3)[:2]
        ]
        return [float((up - down) / (2 * step)) for up, down in losses]


def main() -> None:
    parser = _common.options("W9: silhouettes of a mesh", nv=132, res=512)
    parser.add_argument("--edges", type=float, default=1.0, help="points a pixel; 0 antialiases")
    parser.add_argument("--ids", action="store_true", help="time the visibility buffer alone")
    args = parser.parse_args()
    _core.set_thread_count(args.threads)
    work = Silhouette(args.nv, args.res, args.edges)
    size = {"triangles": len(work.faces), "res": args.res}
    bound = {"bound": _bounds.raster_bound(len(work.faces), args.res), "inputs": work.inputs}
    unit = {"unit": {"name": "pixel", "count": args.res**2}}
    if args.ids:
        forward, face = _common.measure(work.ids, args.reps, args.warmup)
        quality: dict[str, Any] = {"coverage_mean": float((face >= 0).mean())}
        _common.report("W9-forward", args, size, quality, forward=forward, **bound, **unit)
        return
    forward, (picture, _) = _common.measure(work.forward, args.reps, args.warmup)
    both, (loss, gradient) = _common.measure(work.both, args.reps, args.warmup)
    quality = {
        "image_mean": float(picture.mean()),
        "loss": loss,
        "translation_grad": gradient.sum(axis=0).tolist(),
        "translation_differences": work.differences(),
    }
    _common.report("W9", args, size, quality, forward=forward, both=both, **bound, **unit)


if __name__ == "__main__":
    main()
