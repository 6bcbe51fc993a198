"""Which voxels of a grid exist: a mask, its bricks, and the core's tables made from them.

The topology is data, not a parameter: a gradient says nothing about a voxel that does not exist.
What a fit may do about that is here: prune, and dilate what is left, so that matter can grow back
by one voxel at a time.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._memory import available_memory
from photograd.errors import Error, RangeError, message
from photograd.types import Array

SIDE = 8


class ActiveVoxels:
    """The active voxels of an X x Y x Z grid, row by row; never changed once made.

    Rows are numbered brick by brick (8^3 voxels, bricks in C order), in C order within a brick.
    A rendering keeps the object that it was made with, so that a topology cannot change under it.
    """

    def __init__(self, mask: Array) -> None:
        """`mask` (X, Y, Z) bool.

        Raises Error where nothing is active, DtypeError or ShapeError for other arrays.
        """
        mask = Arguments("ActiveVoxels").array("mask", mask, ("X", "Y", "Z"), dtype=np.bool_)
        if not mask.any():
            raise Error(
                message(
                    "ActiveVoxels",
                    "mask",
                    "one active voxel or more",
                    "none",
                    "everything was pruned: lower the threshold",
                )
            )
        self.mask = mask
        x, y, z = mask.shape
        self.shape = (x, y, z)
        blocks = _blocks(mask)
        full = blocks.any(axis=(3, 4, 5))
        self.origins: Array = np.ascontiguousarray(np.argwhere(full) * SIDE, np.int32)
        self.active: Array = np.ascontiguousarray(blocks[full])
        self.topology = _core.BrickTopology(
            self.origins, self.active.view(np.uint8), available_memory()
        )
        self.table = _core.CellTable(self.topology, list(self.shape), available_memory())

    @classmethod
    def of_state(cls, state: Mapping[str, Array], where: str) -> ActiveVoxels:
        """From what `state` returned. Raises RangeError for other entries.

        Args:
            state: {name: array}.
            where: on whose behalf the error speaks.
        """
        if set(state) != {"shape", "mask"}:
            expected = "entries 'mask' and 'shape'"
            raise RangeError(message(where, "state", expected, f"{sorted(state)}"))
        x, y, z = (int(n) for n in state["shape"])
        if min(x, y, z) < 1 or -(-x * y * z // 8) != len(state["mask"]):
            expected = f"voxels of which {len(state['mask'])} bytes are the mask, a bit each"
            raise RangeError(message(where, "state.shape", expected, (x, y, z)))
        bits = np.unpackbits(state["mask"], count=x * y * z)
        return cls(bits.reshape(x, y, z).astype(bool))

    def state(self) -> dict[str, Array]:
        """For checkpoints: the shape and the mask, a bit a voxel."""
        return {"shape": np.array(self.shape, np.int64), "mask": np.packbits(self.mask)}

    def __len__(self) -> int:
        return int(self.topology.voxels)

    @property
    def voxels(self) -> Array:
        """(N, 3) index of the voxel of each row."""
        brick, *inside = np.nonzero(self.active)
        return np.asarray(self.origins[brick] + np.stack(inside, axis=-1), np.int32)

    @property
    def rows(self) -> Array:
        """(X, Y, Z) int64: the row of each voxel, -1 where there is none."""
        table = np.full(self.shape, -1, np.int64)
        i, j, k = self.voxels.T
        table[i, j, k] = np.arange(len(self))
        return table

    def resampled(self, rows: Array, to: ActiveVoxels, fill: float) -> Array:
        """Rows (N, ...) of these voxels at those of another grid over the same box, trilinear.

        `fill` stands for voxels that are not active.

        Args:
            rows: (N, ...).
            to: the other grid.
            fill: for voxels that are not active.
        """
        scale = np.array(self.shape) / np.array(to.shape)
        at = np.ascontiguousarray((to.voxels + 0.5) * scale - 0.5, rows.dtype)
        flat = np.ascontiguousarray(rows).reshape(len(rows), -1)
        out = np.empty((len(to), flat.shape[1]), rows.dtype)
        empty = np.full(flat.shape[1], fill, rows.dtype)
        _core.sample_bricks(self.topology, flat, empty, at, out)
        return out.reshape(len(to), *rows.shape[1:])

    @property
    def memory(self) -> int:
        """Bytes of the tables."""
        return int(self.topology.memory + self.table.memory)


def dilated(mask: Array, steps: int = 1) -> Array:
    """All voxels within `steps` of an active one along each axis (a cube around it).

    Args:
        mask: (X, Y, Z).
        steps: voxels on each side.
    """
    for _ in range(steps):
        for axis in range(3):
            grown = mask.copy()
            a, b = np.moveaxis(grown, axis, 0), np.moveaxis(mask, axis, 0)
            a[1:] |= b[:-1]
            a[:-1] |= b[1:]
            mask = grown
    return mask


def resampled_mask(mask: Array, shape: tuple[int, int, int]) -> Array:
    """The mask on a finer grid over the same box: voxels ask the one that their center is in.

    Args:
        mask: (X, Y, Z).
        shape: of the finer grid.
    """
    index = [
        np.minimum(((np.arange(n) + 0.5) * m / n).astype(np.int64), m - 1)
        for n, m in zip(shape, mask.shape, strict=True)
    ]
    return np.ascontiguousarray(mask[np.ix_(*index)])


def _blocks(mask: Array) -> Array:
    """(X/8, Y/8, Z/8, 8, 8, 8), filled up with False."""
    full = [-(-n // SIDE) * SIDE for n in mask.shape]
    room = np.zeros(full, bool)
    room[: mask.shape[0], : mask.shape[1], : mask.shape[2]] = mask
    x, y, z = (n // SIDE for n in full)
    return room.reshape(x, SIDE, y, SIDE, z, SIDE).transpose(0, 2, 4, 1, 3, 5)
