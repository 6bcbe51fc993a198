"""Bad input to trees is refused with a typed error that names the argument."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.grids.octree import Octree, Quadtree

CELLS = np.zeros((4, 4, 4, 2), np.float32)
TREE = Octree.from_dense(CELLS)
POINTS = np.zeros((5, 3))
NAN = np.full((4, 4, 4, 2), np.nan, np.float32)

CASES: list[tuple[Callable[[], object], type[Error], str]] = [
    (lambda: Octree.from_dense(CELLS[0]), ShapeError, "values: expected shape (X, Y, Z, C)"),
    (lambda: Quadtree.from_dense(CELLS), ShapeError, "values: expected shape (X, Y, C)"),
    (lambda: Octree.from_dense(CELLS.astype(int)), DtypeError, "values: expected float32"),
    (lambda: Octree.from_dense(NAN), RangeError, "finite numbers, got nan at"),
    (lambda: Octree.from_dense(np.zeros((4, 0, 4, 1))), ShapeError, "at least one cell"),
    (lambda: Octree.from_dense(np.zeros((2, 2, 2, 5))), RangeError, "1 to 4 channels, got 5"),
    (lambda: Octree.from_dense(CELLS, tolerance=-1.0), RangeError, "tolerance: expected a finite"),
    (lambda: Octree.from_dense(CELLS, tolerance=np.nan), RangeError, "tolerance"),
    (lambda: Octree.from_dense(CELLS > 0), ShapeError, "shape (X, Y, Z, 1)"),
    (lambda: Octree.from_dense(CELLS[..., :1] > 0, tolerance=0.1), RangeError, "tolerance"),
    (lambda: Octree.from_dense(CELLS, background=(1, 2, 3)), ShapeError, "background"),
    (lambda: Octree.from_dense(CELLS, background=np.inf), RangeError, "background"),
    (
        lambda: Octree.from_dense(CELLS, np.zeros((2, 3))),
        RangeError,
        "bounds: expected corners, lower below upper",
    ),
    (lambda: Octree.from_dense(CELLS, np.zeros((3, 2))), ShapeError, "bounds"),
    (lambda: Octree.from_function(lambda *_: None, 1), RangeError, "every single cell"),
    (lambda: Octree.from_function(lambda *_: [1, 2], 1), ShapeError, "None or 1 channels, got 2"),
    (lambda: Octree.from_function(lambda *_: [1], 21), RangeError, "depth: expected 0 to 20"),
    (lambda: Octree.from_function(lambda *_: [1], -1), RangeError, "depth"),
    (lambda: Octree.from_function(lambda *_: [1], 1, channels=0), RangeError, "channels"),
    (lambda: TREE.leaf_at(POINTS[:, :2]), ShapeError, "points: expected shape (N, 3)"),
    (lambda: TREE.leaf_at(POINTS.astype(int)), DtypeError, "points: expected float32"),
    (lambda: TREE.leaf_at(POINTS + np.nan), RangeError, "points: expected finite"),
    (lambda: TREE.traverse(POINTS, POINTS), RangeError, "got 5 that are zero, first in row 0"),
    (lambda: TREE.traverse(POINTS, POINTS[:3] + 1), ShapeError, "directions"),
    (lambda: TREE.traverse(POINTS, (POINTS + 1).astype("f4")), DtypeError, "directions"),
    (lambda: TREE.traverse(POINTS, POINTS + 1, t_min=np.nan), RangeError, "t_min"),
    (lambda: TREE.traverse(POINTS, POINTS + 1, t_max=np.ones(4)), ShapeError, "t_max"),
    (lambda: TREE.expand(np.zeros((7, 1))), ShapeError, "values: expected shape (1, C)"),
    (lambda: TREE.expand_backward(np.zeros((4, 4, 5, 2))), ShapeError, "d_dense"),
]


@pytest.mark.parametrize(("call", "kind", "words"), CASES, ids=range(len(CASES)))
def test_refused(call: Callable[[], object], kind: type[Error], words: str) -> None:
    with pytest.raises(kind) as caught:
        call()
    assert words in str(caught.value)


def test_what_a_function_raises_comes_through() -> None:
    def broken(_lower: tuple[int, ...], _side: int) -> None:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        Octree.from_function(broken, 3)
