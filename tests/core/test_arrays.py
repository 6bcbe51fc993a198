"""The validator of array arguments: what it converts, what it refuses, and in which words."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._arrays import Arguments
from photograd.errors import DtypeError, RangeError, ShapeError

ROWS = np.arange(6.0).reshape(2, 3)


def test_an_array_that_fits_is_returned_itself() -> None:
    for dtype in (np.float32, np.float64):
        array = ROWS.astype(dtype)
        assert Arguments("f").array("a", array, ("N", 3)) is array


def test_what_the_core_gets_is_contiguous() -> None:
    found = Arguments("f").array("a", np.ones((3, 2)).T, ("N", 3))
    assert found.flags.c_contiguous
    assert found.shape == (2, 3)


def test_a_number_stays_without_axes() -> None:
    assert Arguments("f").array("a", 2.0, (), ("N",)).shape == ()


def test_lists_take_the_dtype_of_the_call() -> None:
    call = Arguments("f")
    call.array("a", ROWS.astype(np.float32), ("N", 3))
    assert call.array("b", [[1, 2, 3], [4, 5, 6]], ("N", 3)).dtype == np.float32
    assert Arguments("f").array("b", [1, 2], ("N",)).dtype == np.float64


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_stated_dtype_converts_everything(dtype: Any) -> None:
    call = Arguments("f", dtype)
    for value in (ROWS, ROWS.astype(np.float32), ROWS.astype(np.int16), ROWS.tolist()):
        found = call.array("a", value, ("N", 3))
        assert found.dtype == dtype
        np.testing.assert_array_equal(found, ROWS)


def test_a_stated_dtype_may_be_the_only_one() -> None:
    call = Arguments("f", np.float32, convert=False)
    assert call.array("a", [1.0, 2.0], ("N",)).dtype == np.float32
    with pytest.raises(DtypeError, match=r"^f: a: expected float32, got float64 \(use .astype\)$"):
        call.array("a", np.ones(2), ("N",))


def test_a_dtype_may_be_stated_for_one_argument() -> None:
    call = Arguments("f")
    call.array("a", ROWS, ("N", 3))
    assert call.array("faces", [[0, 1, 2]], ("F", 3), dtype=np.uint32).dtype == np.uint32
    assert call.array("b", np.ones(2), ("N",)).dtype == np.float64


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (ROWS.astype(np.int32), r"^f: a: expected float32 or float64, got int32 \(convert it"),
        (ROWS.astype(np.float16), "expected float32 or float64, got float16"),
        (ROWS > 0, "^f: a: expected numbers, got an array of bool$"),
        (ROWS + 1j, "expected numbers, got an array of complex128"),
        ("red", "expected numbers, got 'red'"),
        (None, "expected numbers, got None"),
        ([[1.0], [1.0, 2.0]], r"expected numbers, got \[\[1.0\], \[1.0, 2.0\]\]"),
        (["x" * 90], r"expected numbers, got .{57}\.\.\.$"),
    ],
)
def test_what_is_not_real_numbers(value: Any, text: str) -> None:
    with pytest.raises(DtypeError, match=text):
        Arguments("f").array("a", value)


def test_arrays_of_integers_may_be_refused() -> None:
    call = Arguments("f", np.float32)
    with pytest.raises(DtypeError, match=r"^f: a: expected floating point numbers, got uint8"):
        call.array("a", np.zeros((2, 2, 3), np.uint8), floating=True)
    assert call.array("a", [[0, 1]], floating=True).dtype == np.float32


def test_one_call_has_one_dtype() -> None:
    call = Arguments("f")
    call.array("points", ROWS.astype(np.float32), ("N", 3))
    text = r"^f: w: expected float32 as points, got float64 \(use .astype\)$"
    with pytest.raises(DtypeError, match=text):
        call.array("w", ROWS, ("N", 3))


@pytest.mark.parametrize(
    ("shapes", "text"),
    [
        ([("N", 2)], r"^f: a: expected shape \(N, 2\), got \(2, 3\)$"),
        ([("N",)], r"expected shape \(N,\), got \(2, 3\)$"),
        ([(), ("N",)], r"expected a number or shape \(N,\), got \(2, 3\)$"),
        ([("H", "2 H")], r"expected shape \(H, 2 H\), got \(2, 3\)$"),
        ([(..., 4)], r"expected shape \(..., 4\), got \(2, 3\)$"),
        ([(..., 1, 2, 3)], r"expected shape \(..., 1, 2, 3\), got"),
        ([(2, 4)], r"expected shape \(2, 4\), got \(2, 3\)$"),
    ],
)
def test_other_shapes(shapes: list[Any], text: str) -> None:
    with pytest.raises(ShapeError, match=text):
        Arguments("f").array("a", ROWS, *shapes)


def test_axes_of_one_name_agree_within_a_call() -> None:
    call = Arguments("f")
    call.array("points", ROWS, ("N", 3))
    call.array("u2", np.ones((2, 2)), ("N", 2))
    with pytest.raises(ShapeError, match=r"^f: w: expected shape \(N, 3\) with N = 2 as in points"):
        call.array("w", np.ones((4, 3)), ("N", 3))
    Arguments("f").array("w", np.ones((4, 3)), ("N", 3))


def test_a_refused_shape_names_no_axis() -> None:
    call = Arguments("f")
    with pytest.raises(ShapeError):
        call.array("a", ROWS, ("N", 2))
    call.array("a", np.ones((5, 2)), ("N", 2))


def test_the_first_shape_that_fits_is_taken() -> None:
    call = Arguments("f")
    call.array("a", [1.0, 2.0, 3.0], (), (3,), ("N", 3))
    call.array("b", np.ones((5, 3)), (), (3,), ("N", 3))
    with pytest.raises(ShapeError, match="N = 5 as in b"):
        call.array("c", np.ones((4, 3)), ("N", 3))


def test_multiples_of_an_axis() -> None:
    assert Arguments("f").array("texels", np.ones((2, 4, 3)), ("H", "2 H", 3)).shape == (2, 4, 3)
    for shape in ((2, 3, 3), (2, 5, 3), (2, 2, 3)):
        with pytest.raises(ShapeError):
            Arguments("f").array("texels", np.ones(shape), ("H", "2 H", 3))


def test_leading_axes_are_free() -> None:
    for shape in ((3,), (2, 3), (4, 2, 3)):
        assert Arguments("f").array("a", np.ones(shape), (..., 3)).shape == shape


def test_shortest_axes() -> None:
    with pytest.raises(ShapeError, match=r"expected shape \(M, 2\) with M >= 3, got \(2, 2\)"):
        Arguments("f").array("profile", np.ones((2, 2)), ("M", 2), min_length=3)
    Arguments("f").array("profile", np.ones((3, 2)), ("M", 2), min_length=3)


@pytest.mark.parametrize(
    ("value", "bounds", "text"),
    [
        ([1.0, np.nan], {}, "^f: a: expected finite numbers, got nan in row 1$"),
        ([[0, 0, 0], [np.inf, 1, 2]], {}, r"expected finite numbers, got \[inf  1.  2.\] in row 1"),
        (np.full((2, 2, 2), np.nan), {}, r"got nan at \[0, 0, 0\]$"),
        (np.nan, {}, "got nan$"),
        ([0.5, 1.0], {"low": 0, "below": 1}, r"numbers in \[0, 1\), got 1.0 in row 1$"),
        ([-1.0], {"low": 0}, "finite numbers of at least 0, got -1.0 in row 0"),
        ([0.0], {"above": 0}, "finite numbers above 0, got 0.0 in row 0"),
        ([3.0], {"high": 2}, "finite numbers of at most 2, got 3.0"),
        ([2.0], {"below": 2}, "finite numbers below 2, got 2.0"),
        ([np.nan], {"finite": False, "low": -np.inf}, "expected numbers, got nan in row 0"),
        ([1e300], {"dtype": np.float32}, "expected finite numbers, got inf"),
    ],
)
def test_numbers_out_of_range(value: Any, bounds: dict[str, Any], text: str) -> None:
    with pytest.raises(RangeError, match=text):
        Arguments("f").array("a", value, **bounds)


def test_bounds_that_are_kept() -> None:
    Arguments("f").array("a", [0.0, 1.0], low=0, high=1)
    Arguments("f").array("a", [0.1, 0.9], above=0, below=1)
    Arguments("f").array("a", [-np.inf, np.inf], low=-np.inf, finite=False)
    Arguments("f").array("a", [np.nan], finite=False)
    Arguments("f").array("a", np.zeros((0, 3)), ("N", 3), low=1)


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        ([0.5], DtypeError, "^f: faces: expected integers, got float64$"),
        ([-1], RangeError, r"expected numbers in \[0, 2\^32 - 1\], got -1 in row 0"),
        ([[0, 1, 1 << 32]], RangeError, "in row 0"),
    ],
)
def test_integers(value: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        Arguments("f").array("faces", value, dtype=np.uint32)


@pytest.mark.parametrize(
    ("box", "error", "text"),
    [
        ([[0, 0, 0], [1, 1]], DtypeError, "^f: box: expected numbers"),
        ([[0, 0], [1, 1]], ShapeError, r"expected shape \(2, 3\), got \(2, 2\)"),
        ([[0, 0, 0], [1, 0, 1]], RangeError, "expected corners, lower below upper, got"),
        ([[0, 0, 0], [1, np.nan, 1]], RangeError, "expected finite numbers"),
    ],
)
def test_boxes_have_a_size_along_each_axis(box: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        Arguments("f", np.float64).box("box", box)
    assert Arguments("f", np.float64).box("box", [[0, 0], [1, 2]], 2).tolist() == [[0, 0], [1, 2]]


@pytest.mark.parametrize(
    ("value", "bounds", "error", "text"),
    [
        ("1", {}, DtypeError, "^f: n: expected a number, got '1'$"),
        (True, {}, DtypeError, "expected a number, got True"),
        ([1.0], {}, DtypeError, r"expected a number, got \[1.0\]"),
        (np.nan, {}, RangeError, "^f: n: expected a finite number, got nan$"),
        (10**400, {"low": 0}, RangeError, "expected a finite number of at least 0, got 1000"),
        (0, {"above": 0}, RangeError, "expected a finite number above 0, got 0"),
        (1.0, {"low": 0, "below": 1}, RangeError, r"in \[0, 1\), got 1.0"),
        (np.float32(2), {"high": 1}, RangeError, "of at most 1"),
    ],
)
def test_numbers(value: Any, bounds: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        Arguments("f").number("n", value, **bounds)
    assert Arguments("f").number("n", np.float32(0.5), above=0, high=0.5) == 0.5


@pytest.mark.parametrize(
    ("value", "bounds", "error", "text"),
    [
        (3.0, {}, DtypeError, "^f: n: expected a whole number, got 3.0$"),
        (False, {}, DtypeError, "expected a whole number, got False"),
        (0, {"low": 1}, RangeError, "expected a whole number of at least 1, got 0"),
        (-1, {"low": 0, "high": 2**64 - 1}, RangeError, r"in \[0, 2\^64 - 1\], got -1"),
    ],
)
def test_whole_numbers(value: Any, bounds: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        Arguments("f").integer("n", value, **bounds)
    assert type(Arguments("f").integer("n", np.int8(3), low=3, high=3)) is int


def test_masks_are_arrays_of_bool() -> None:
    mask = Arguments("f").array("mask", [[True, False]], ("N", 2), dtype=np.bool_)
    assert mask.dtype == np.bool_
    with pytest.raises(DtypeError, match="mask: expected an array of bool, got an array of int64"):
        Arguments("f").array("mask", [0, 1], ("N",), dtype=np.bool_)
    with pytest.raises(ShapeError, match=r"mask: expected shape \(N, 2\), got \(2,\)"):
        Arguments("f").array("mask", [True, False], ("N", 2), dtype=np.bool_)
