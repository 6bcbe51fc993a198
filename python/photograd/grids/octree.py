"""Octrees and quadtrees: space cut into cells that are small only where something changes.

The tree says which cube is a leaf; `values` (L, C) says what each leaf holds, an array like any
other. A leaf's value stands for all cells of the dense grid that it covers, so dL/dleaf is the sum
of their gradients: `Octree.expand` and `Octree.expand_backward`. [Meagher1982]
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array

Classify = Callable[[tuple[int, ...], int], Sequence[float] | None]
"""(lower corner in cells, side in cells) -> channels of a uniform cube, or None to cut it up."""


@dataclass(frozen=True)
class TreeStatistics:
    """What a tree costs.

    Attributes:
        nodes: of any kind.
        leaves_per_level: number of leaves by level; level 0 is the root.
        bytes: of the nodes and of the values together.
    """

    nodes: int
    leaves_per_level: tuple[int, ...]
    bytes: int

    @property
    def leaves(self) -> int:
        """Leaves of all levels."""
        return sum(self.leaves_per_level)


@dataclass(frozen=True, eq=False)
class LeafVisits:
    """The leaves that R rays pass through, each ray's in the order of t.

    Attributes:
        ray_offset: (R + 1,) int64; ray r has the rows ray_offset[r] to ray_offset[r + 1].
        leaf: (M,) int32 leaf numbers.
        t0, t1: (M,) where the ray enters and leaves, in lengths of its direction; t0 < t1.
    """

    ray_offset: npt.NDArray[np.int64]
    leaf: npt.NDArray[np.int32]
    t0: Array
    t1: Array


class _SpatialTree:
    """What octrees and quadtrees share; D is `dimensions`."""

    dimensions: ClassVar[int]
    core_class: ClassVar[Any]

    def __init__(self, core: Any, values: Array, bounds: Array, shape: tuple[int, ...]) -> None:
        self._core = core
        self.values = values
        self.bounds = bounds
        self.shape = shape

    @classmethod
    def from_dense(
        cls,
        values: Array,
        bounds: npt.ArrayLike | None = None,
        *,
        background: float | Sequence[float] = 0.0,
        tolerance: float = 0.0,
    ) -> Self:
        """Collapse the uniform blocks of an array.

        Args:
            values: (X, Y, Z, C), for a quadtree (X, Y, C); C is 1 to 4. bool for occupancy,
                float32 or float64 for coefficients (sigma_a, sigma_s), radiance and the like.
            bounds: (2, D) outer faces of the array in meters; by default cells of one meter.
            background: value of the cells with which the root's cube exceeds the array.
            tolerance: a block becomes one leaf, with the mean as its value, if no channel varies
                by more than this in it. 0 keeps every cell as it is.

        Raises:
            DtypeError, ShapeError: other types or shapes; occupancy of more than one channel.
            RangeError: no cell, too many cells or channels, values that are not finite, a negative
                tolerance, or one for occupancy.
        """
        name = f"{cls.__name__}.from_dense"
        call, axes = Arguments(name), ("X", "Y", "Z")[: cls.dimensions]
        occupancy = np.asarray(values).dtype == np.bool_
        if occupancy:
            array = call.array("values", values, (*axes, 1), dtype=np.bool_).view(np.uint8)
        else:
            array = call.array("values", values, (*axes, "C"))
        behind = _spread(name, "background", background, array.shape[-1:], array.dtype)
        core, leaves = cls.core_class.from_dense(array, behind, float(tolerance))
        shape = array.shape[:-1]
        held = leaves.view(np.bool_) if occupancy else leaves
        return cls(core, held, _box(name, bounds, shape), shape)

    @classmethod
    def from_function(
        cls,
        classify: Classify,
        depth: int,
        bounds: npt.ArrayLike | None = None,
        *,
        channels: int = 1,
    ) -> Self:
        """Ask a function from the root downwards; only what it calls uniform becomes a leaf.

        Args:
            classify: (lower, side) in cells -> the channels of a uniform cube, or None to have it
                cut into halves. Single cells must be given a value.
            depth: 0 to 20; the root has 2^depth cells a side.
            bounds: (2, D) outer faces of the root in meters; by default cells of one meter.
            channels: 1 to 4.

        Returns:
            A tree with float64 values.

        Raises:
            RangeError, ShapeError: depth or channels out of range; an answer of another length, or
                None for a single cell.
        """
        core, leaves = cls.core_class.from_function(depth, classify, channels)
        shape = (1 << depth,) * cls.dimensions
        return cls(core, leaves, _box(f"{cls.__name__}.from_function", bounds, shape), shape)

    @property
    def depth(self) -> int:
        """Levels below the root."""
        return int(self._core.depth)

    @property
    def cell_size(self) -> npt.NDArray[np.float64]:
        """(D,) sides of the smallest cell in meters."""
        size: npt.NDArray[np.float64] = (self.bounds[1] - self.bounds[0]) / self.shape
        return size

    def leaf_at(self, points: Array) -> npt.NDArray[np.int32]:
        """Leaf (N,) of points (N, D) in meters; -1 outside of the root's cube.

        Raises:
            DtypeError, ShapeError, RangeError: not floating point, of another shape, not finite.
        """
        name = f"{type(self).__name__}.leaf_at"
        cells = self._cells(name, "points", points, shift=True)
        leaf = np.empty(len(cells), np.int32)
        self._core.locate(cells, leaf)
        return leaf

    def traverse(
        self,
        origins: Array,
        directions: Array,
        *,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
    ) -> LeafVisits:
        """The leaves that rays spend some length in; touching an edge or a corner is none.

        A ray along a face belongs to the leaf above it, as a point on the face does.

        Args:
            origins: (R, D) in meters, inside or outside.
            directions: (R, D) of any length but zero, same dtype.
            t_min, t_max: limits in lengths of the direction, one for all rays or (R,).

        Raises:
            DtypeError, ShapeError, RangeError: other types or shapes; not finite; no direction.
        """
        name = f"{type(self).__name__}.traverse"
        o, d = self.rays_in_cells(origins, directions)
        limits = []
        for argument, limit in (("t_min", t_min), ("t_max", t_max)):
            limits.append(_spread(name, argument, limit, (len(o),), o.dtype, low=-np.inf))
        return LeafVisits(*self._core.traverse(o, d, *limits))

    def rays_in_cells(self, origins: Array, directions: Array) -> tuple[Array, Array]:
        """Rays (R, D) of the world in cells of the root: t is the same in both.

        Raises what `traverse` raises.

        Args:
            origins: (R, D) in meters.
            directions: (R, D) of any length but zero, same dtype.
        """
        name = f"{type(self).__name__}.traverse"
        o = self._cells(name, "origins", origins, shift=True)
        d = self._cells(name, "directions", directions, shift=False)
        still = ~d.any(axis=1)
        if still.any():
            got = f"{int(still.sum())} that are zero, first in row {int(np.argmax(still))}"
            raise RangeError(message(name, "directions", "directions with a length", got))
        return o, d

    @property
    def core(self) -> Any:
        """The tree of the core, for its other functions."""
        return self._core

    def leaf_boxes(self) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
        """Lower corners (L, D) and sides (L,) of the leaves, in cells."""
        lower, side = self._core.leaf_boxes()
        return lower, side

    def statistics(self) -> TreeStatistics:
        """Nodes, leaves and bytes."""
        nodes, _, size, per_level = self._core.statistics()
        return TreeStatistics(nodes, tuple(per_level), size + self.values.nbytes)

    def expand(self, values: Array | None = None) -> Array:
        """The dense array (X, Y, Z, C) of leaf values (L, C), by default the tree's own.

        Raises:
            ShapeError: not one row a leaf.
        """
        call, held = Arguments(f"{type(self).__name__}.expand"), self.values
        if values is not None:
            shape, dtype = (len(self.values), "C"), np.asarray(values).dtype
            held = call.array("values", values, shape, dtype=dtype, finite=False)
        dense: Array = held[self._leaf_of_cell()]
        return dense

    def expand_backward(self, d_dense: Array) -> Array:
        """dL/dvalues (L, C) for dL/ddense (X, Y, Z, C): the sum over the cells of each leaf.

        Raises:
            ShapeError: not of the shape of the dense array.
        """
        call = Arguments(f"{type(self).__name__}.expand_backward")
        d_dense = call.array("d_dense", d_dense, (*self.shape, "C"), finite=False)
        leaf, count = self._leaf_of_cell().ravel(), len(self.values)
        rows = d_dense.reshape(len(leaf), -1)
        sums = [np.bincount(leaf, rows[:, c], count) for c in range(rows.shape[1])]
        return np.stack(sums, axis=-1).astype(d_dense.dtype)

    def _leaf_of_cell(self) -> npt.NDArray[np.int32]:
        leaf = np.empty(self.shape, np.int32)
        lower, side = self._core.leaf_boxes()
        for number, (corner, size) in enumerate(zip(lower, side, strict=True)):
            leaf[tuple(slice(at, at + size) for at in corner)] = number
        return leaf

    def _cells(self, name: str, argument: str, array: Array, *, shift: bool) -> Array:
        """World coordinates in cells of the root, contiguous and in the same dtype."""
        array = Arguments(name).array(argument, array, ("N", self.dimensions))
        origin = self.bounds[0] if shift else np.zeros(self.dimensions)
        cells = (array - origin.astype(array.dtype)) / self.cell_size.astype(array.dtype)
        return np.ascontiguousarray(cells)


@typed_call
class Octree(_SpatialTree):
    """A tree of cubes: values (X, Y, Z, C)."""

    dimensions: ClassVar[int] = 3
    core_class: ClassVar[Any] = _core.Octree


def tree_of_leaves(
    lower: npt.NDArray[np.integer[Any]],
    side: npt.NDArray[np.integer[Any]],
    bounds: npt.ArrayLike,
    shape: tuple[int, int, int],
) -> Octree:
    """The octree with just these leaves; its values (L, 1) are their numbers.

    Args:
        lower: (L, 3) lower corners in cells, as of `Octree.leaf_boxes`.
        side: (L,) sides in cells.
        bounds: (2, 3) outer faces of the array of cells in meters.
        shape: cells along each axis; the root's cube may exceed them.

    Raises:
        ShapeError: arrays of other shapes.
        RangeError: cubes that do not fill the root's.
    """
    call = Arguments("tree_of_leaves", np.int64)
    side = call.array("side", side, ("L",))
    cubes = np.column_stack([call.array("lower", lower, ("L", 3)), side])
    edge = int((cubes[:, :3] + cubes[:, 3:]).max(initial=1))
    depth = max(edge - 1, 0).bit_length()
    if not all(1 <= cells <= 1 << depth for cells in shape):
        expected = f"1 to {1 << depth} cells, as the leaves have"
        raise RangeError(message("tree_of_leaves", "shape", expected, shape))
    if not _fill_the_cube(cubes, depth):
        expected = f"{len(side)} cubes that fill one of {1 << depth} cells a side, once"
        raise RangeError(message("tree_of_leaves", "side", expected, "others"))
    number = {(*corner, size): leaf for leaf, (*corner, size) in enumerate(cubes.tolist())}

    def classify(at: tuple[int, ...], size: int) -> list[float] | None:
        found = number.get((*at, size))
        return None if found is None else [float(found)]

    whole = Octree.from_function(classify, depth)
    return Octree(whole._core, whole.values, _box("tree_of_leaves", bounds, shape), shape)


def _fill_the_cube(cubes: npt.NDArray[np.int64], depth: int) -> bool:
    """Whether cubes (L, 4), lower corner and side, tile 2^depth cells a side: along the Morton
    curve each is an interval, and one begins where the last ends. Asked beforehand, since a tree
    with a hole would be cut down to single cells there.
    """
    lower, side = cubes[:, :3], cubes[:, 3]
    if depth > 20 or not len(cubes) or int(side.min()) < 1 or int(lower.min()) < 0:
        return False
    if (side & (side - 1)).any() or (lower & (side[:, None] - 1)).any():
        return False
    start = np.zeros(len(cubes), np.int64)
    for bit in range(depth):
        for axis in range(3):
            start |= (lower[:, axis] >> bit & 1) << (3 * bit + axis)
    order = np.argsort(start)
    ends = np.cumsum(side[order] ** 3)
    return bool((start[order] == ends - side[order] ** 3).all()) and int(ends[-1]) == 8**depth


@typed_call
class Quadtree(_SpatialTree):
    """The same in the plane: values (X, Y, C)."""

    dimensions: ClassVar[int] = 2
    core_class: ClassVar[Any] = _core.Quadtree


def _box(name: str, bounds: npt.ArrayLike | None, shape: tuple[int, ...]) -> Array:
    """(2, D) float64 with a positive size along each axis."""
    if bounds is None:
        return np.array([np.zeros(len(shape)), shape], np.float64)
    return Arguments(name, np.float64).box("bounds", bounds, len(shape)).copy()


def _spread(
    name: str,
    argument: str,
    value: npt.ArrayLike,
    shape: tuple[int, ...],
    dtype: Any,
    *,
    low: float | None = None,
) -> Array:
    """One number for all, or one for each: finite ones, or with `low` any but NaN."""
    call = Arguments(name, np.float64)
    array = call.array(argument, value, (), shape, finite=low is None, low=low)
    return np.array(np.broadcast_to(array, shape), dtype)
