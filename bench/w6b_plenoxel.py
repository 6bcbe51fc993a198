"""W6b: a sparse grid of density and spherical harmonics, forward, and forward and backward.

A bumpy shell in n^3 voxels on [-1, 1]^3, degree 3: 49 numbers at each of its voxels. A step of 1/n
from where a ray enters; a sample counts if a voxel is at one of its corners, what lacks is zero.
tau = max(density, 0) dt, L = sum of T tau max(1/2 + sum_k Y_k c_k, 0); the loss is the mean of
(L - target)^2 over rays and channels, and the target is the image of other values.

The grid comes indexed [z, y, x] with coefficients [channel, k]; it is stored as [x, y, z] and
[k, channel] before the timing, as other programs store theirs. Clearing the gradient and the loss
are inside.
"""

from __future__ import annotations

from typing import Any

import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import MarchPolicy

Array = NDArray[Any]
CUBE = ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


class Plenoxel:
    """The workload: a sparse grid, rays, and the image that other values make."""

    def __init__(self, n: int, res: int, views: int) -> None:
        occupied, data = _inputs.sparse_shell(n, 0.0)
        _, other = _inputs.sparse_shell(n, 0.6)
        origins, directions = map(np.ascontiguousarray, _inputs.orbit_rays(res, views))
        self.active = ActiveVoxels(np.ascontiguousarray(occupied.transpose(2, 1, 0)))
        # Row of each of our voxels in the data, which run in the order [z, y, x].
        number = np.full(occupied.shape, -1, np.int64)
        number[occupied] = np.arange(len(data))
        i, j, k = self.active.voxels.T
        self.order = number[k, j, i]
        policy = MarchPolicy(
            CUBE,
            1 / n,
            lattice="entry",
            quadrature="riemann",
            border="zero",
            density_activation="relu",
            color_activation="relu",
        )
        self.settings = policy.settings(0.0)  # no early stop
        placed = _core.place_samples(self.settings, origins, directions)
        self.rays = (origins, directions, *placed)
        self.background = np.zeros(49, np.float32)
        self.values = self.stored(data)
        self.gradient = tuple(np.zeros_like(a) for a in (*self.values, self.background))
        self.nothing = np.zeros_like(placed[0])  # cotangent of transmittance and depth
        self.target = self.march(self.stored(other))[0]
        name = f"W6b n={n} res={res} views={views}"
        self.inputs = _inputs.inputs_row(name, occupied, data, other, origins, directions)

    def stored(self, data: Array) -> tuple[Array, Array]:
        """Density (N,) and coefficients (N, 16, 3) in the order of our rows."""
        rows = data[self.order]
        sh = rows[:, 1:].reshape(-1, 3, 16).transpose(0, 2, 1)
        return np.ascontiguousarray(rows[:, 0]), np.ascontiguousarray(sh)

    def march(self, values: tuple[Array, Array]) -> tuple[Any, ...]:
        """Color (R, 3), transmittance (R,), depth (R,), number of samples looked up."""
        return _core.march_sparse_sh(
            self.active.table, (*values, self.background), self.settings, 0.5, self.rays
        )

    def forward(self) -> tuple[Any, ...]:
        return self.march(self.values)

    def forward_backward(self) -> float:
        outputs = self.march(self.values)
        difference = outputs[0] - self.target
        loss = float(np.square(difference).mean(dtype=np.float64))
        for array in self.gradient:
            array.fill(0)
        d_color = difference * np.float32(2 / difference.size)
        _core.march_sparse_sh_backward(
            self.active.table,
            (*self.values, self.background),
            self.settings,
            0.5,
            self.rays,
            outputs[:3],
            (d_color, self.nothing, self.nothing),
            self.gradient,
        )
        return loss


def main() -> None:
    args = _common.options("W6b: sparse harmonics", n=128, res=128, views=4).parse_args()
    _core.set_thread_count(args.threads)
    work = Plenoxel(args.n, args.res, args.views)
    forward, outputs = _common.measure(work.forward, args.reps, args.warmup)
    both, loss = _common.measure(work.forward_backward, args.reps, args.warmup)
    density, sh = (a.astype(np.float64) for a in work.gradient[:2])
    quality = {
        "image_mean": float(outputs[0].mean(dtype=np.float64)),
        "loss": loss,
        "grad_norm_density": float(np.linalg.norm(density)),
        "grad_norm_sh": float(np.linalg.norm(sh)),
    }
    samples = int(work.rays[3].sum(dtype=np.int64))
    size = {"n": args.n, "voxels": len(work.active), "rays": len(work.target), "samples": samples}
    _common.report(
        "W6b",
        args,
        size,
        quality,
        forward=forward,
        both=both,
        inputs=work.inputs,
        looked_up=outputs[3],
    )


if __name__ == "__main__":
    main()
