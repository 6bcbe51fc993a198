"""The one validator of array arguments, for every public function of the package.

    call = Arguments("BsdfModel.f")
    wo = call.array("wo", wo, ("N", 3))
    wi = call.array("wi", wi, ("N", 3))  # as many rows as wo, and of its dtype

Conversion follows one rule. Numbers and lists are converted. NumPy arrays with axes are converted
where the function has stated a dtype; without one they have to be float32 or float64, the same in
all arguments of a call, and the function computes in that precision.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import EllipsisType
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.errors import DtypeError, Error, RangeError, ShapeError, message
from photograd.types import Array

Axis = int | str | EllipsisType
"""A length, or a name such as "N" or "2 H" (twice H); `...` stands for any leading axes."""


PLAIN = (int, float, str, list, tuple, dict)


class Arguments:
    """The array arguments of one call: axes of one name have one length.

    Attributes:
        function: the public function that was called, for errors.
        dtype: in which it computes; None until the first array decides.
    """

    def __init__(
        self, function: str, dtype: npt.DTypeLike | None = None, *, convert: bool = True
    ) -> None:
        """State `dtype` to convert every array of the call to it; `convert` False refuses others.

        The latter is for functions of one precision that take more numbers than one would copy.
        """
        self.function = function
        self.dtype = None if dtype is None else np.dtype(dtype)
        self._converts = dtype is not None and convert
        self._decided_by = ""
        self._axes: dict[str, tuple[int, str]] = {}  # length, and the argument that has it

    def array(
        self,
        name: str,
        value: Any,
        *shapes: tuple[Axis, ...],
        dtype: npt.DTypeLike | None = None,
        floating: bool = False,
        finite: bool = True,
        min_length: int = 0,
        low: float | None = None,
        high: float | None = None,
        above: float | None = None,
        below: float | None = None,
    ) -> Array:
        """`value` as a C-contiguous array, itself where it is one already.

        Args:
            name: of the argument, for errors.
            value: an array, a nested list, or a number.
            shapes: those that are accepted, such as ("N", 3); the first that fits names its axes.
            dtype: of this argument alone; an integer type refuses fractions, bool refuses numbers.
            floating: refuses arrays of integers, such as images of bytes, in place of converting.
            finite: whether NaN and infinity are refused; bounds refuse NaN in any case.
            min_length: of the named axes.
            low, high, above, below: bounds, the first two included, the last two excluded.

        Raises:
            DtypeError: not numbers, or of a dtype that is not converted.
            ShapeError: another shape, or a named axis of another length than before.
            RangeError: a number that is not finite or out of bounds; names the first.
        """
        array = self._converted(name, value, dtype, floating)
        self._bind(name, array.shape, shapes, min_length)
        bounds = (low, high, above, below)
        self._check_range(name, array, finite and array.dtype.kind == "f", bounds)
        return array

    def number(
        self,
        name: str,
        value: Any,
        *,
        low: float | None = None,
        high: float | None = None,
        above: float | None = None,
        below: float | None = None,
    ) -> float:
        """`value` as a finite number within bounds; arguments as of `array`.

        Raises:
            DtypeError: no real number; true and false are none.
            RangeError: not finite, or out of bounds.
        """
        if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
            self._refuse(DtypeError, name, "a number", shortened(value))
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        inside = (low is None or number >= low) and (high is None or number <= high)
        inside = inside and (above is None or number > above) and (below is None or number < below)
        if not (inside and math.isfinite(number)):
            expected = f"a finite number{_interval(low, high, above, below)}"
            self._refuse(RangeError, name, expected, shortened(value))
        return number

    def integer(
        self, name: str, value: Any, *, low: int | None = None, high: int | None = None
    ) -> int:
        """`value` as a whole number within bounds, both included.

        Raises:
            DtypeError: no integer; 3.0, true and false are none.
            RangeError: out of bounds.
        """
        if isinstance(value, bool) or not isinstance(value, int | np.integer):
            self._refuse(DtypeError, name, "a whole number", shortened(value))
        number = int(value)
        if (low is not None and number < low) or (high is not None and number > high):
            expected = f"a whole number{_interval(low, high, None, None)}"
            self._refuse(RangeError, name, expected, number)
        return number

    def size(self, name: str, value: Any, *, most: int = 1 << 26) -> tuple[int, int]:
        """`value` as (height, width) of at least one pixel and at most `most`.

        Raises:
            DtypeError, ShapeError, RangeError: anything else.
        """
        array = self.array(name, value, (2,), dtype=np.int64, low=1, high=most)
        height, width = array.tolist()
        if height * width > most:
            got = f"{height} x {width}"
            self._refuse(RangeError, name, f"at most {_bound(most)} pixels", got)
        return height, width

    def box(self, name: str, value: Any, axes: int = 3) -> Array:
        """Corners (2, axes), lower below upper along each axis; converted as by `array`.

        Raises:
            DtypeError, ShapeError, RangeError: anything else.
        """
        box = self.array(name, value, (2, axes))
        if not bool((box[0] < box[1]).all()):
            self._refuse(RangeError, name, "corners, lower below upper", box.tolist())
        return box

    def run(self, core: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
        """What a function of the core returns; its errors name the function that was called.

        Raises:
            RangeError: numbers or objects that the core has no type for, such as 2^40 voxels.
        """
        try:
            return core(*arguments, **named)
        except TypeError as failure:
            if "incompatible" not in str(failure):
                raise
            plain = [each for each in (*arguments, *named.values()) if isinstance(each, PLAIN)]
            got, expected = shortened(plain), "numbers and objects that the core can hold"
            raise RangeError(message(self.function, "arguments", expected, got)) from failure
        except Error as failure:
            _, _, rest = str(failure).partition(": ")
            raise type(failure)(f"{self.function}: {rest}") from failure

    def _converted(
        self, name: str, value: Any, stated: npt.DTypeLike | None, floating: bool
    ) -> Array:
        if stated is not None and np.dtype(stated) == np.bool_:
            return self._truths(name, value)
        array = _numbers(self.function, name, value)
        if stated is not None or self._converts:
            target = np.dtype(self.dtype if stated is None else stated)
            if target.kind in "iu":
                self._check_integers(name, array, target)
            elif floating and isinstance(value, np.ndarray) and array.dtype.kind != "f":
                remedy = "convert it, with .astype"
                self._refuse(DtypeError, name, "floating point numbers", array.dtype, remedy)
        else:
            target = self._call_dtype(name, array, isinstance(value, np.ndarray) and value.ndim > 0)
        with np.errstate(over="ignore"):  # what float32 cannot hold becomes infinite
            return np.asarray(array, target, order="C")

    def _truths(self, name: str, value: Any) -> Array:
        array = np.asarray(value)
        if array.dtype != np.bool_:
            got = f"an array of {array.dtype}"
            self._refuse(DtypeError, name, "an array of bool", got, "compare first")
        return np.asarray(array, order="C")

    def _call_dtype(self, name: str, array: Array, has_dtype: bool) -> np.dtype[Any]:
        """The dtype of the call, which the first array decides."""
        if self.dtype is None and has_dtype and array.dtype not in (np.float32, np.float64):
            remedy = "convert it, with .astype(np.float64)"
            self._refuse(DtypeError, name, "float32 or float64", array.dtype, remedy)
        if self.dtype is None:
            self.dtype = array.dtype if has_dtype else np.dtype(np.float64)
            self._decided_by = name
        if has_dtype and array.dtype != self.dtype:
            expected = f"{self.dtype}" + (f" as {self._decided_by}" if self._decided_by else "")
            self._refuse(DtypeError, name, expected, array.dtype, "use .astype")
        return self.dtype

    def _check_integers(self, name: str, array: Array, target: np.dtype[Any]) -> None:
        if array.size and array.dtype.kind not in "iu":
            self._refuse(DtypeError, name, "integers", array.dtype)
        limits = np.iinfo(target)
        self._check_range(name, array, False, (limits.min, limits.max, None, None))

    def _bind(
        self, name: str, found: tuple[int, ...], shapes: tuple[tuple[Axis, ...], ...], least: int
    ) -> None:
        for shape in shapes:
            axes = self._axes_of(name, found, shape, least)
            if axes is not None:
                self._axes = axes
                return
        if shapes:
            self._refuse(ShapeError, name, self._expected_shape(shapes, least), f"{found}")

    def _axes_of(
        self, name: str, found: tuple[int, ...], shape: tuple[Axis, ...], least: int
    ) -> dict[str, tuple[int, str]] | None:
        """The named axes when `found` has this shape, or None."""
        if shape and shape[0] is ...:
            shape = shape[1:]
            found = found[len(found) - len(shape) :] if len(found) >= len(shape) else ()
        if len(shape) != len(found):
            return None
        axes = dict(self._axes)
        for axis, length in zip(shape, found, strict=True):
            if isinstance(axis, int):
                if length != axis:
                    return None
                continue
            *factor, letter = str(axis).split()
            count, rest = divmod(length, int(factor[0]) if factor else 1)
            if rest or count < least or axes.setdefault(letter, (count, name))[0] != count:
                return None
        return axes

    def _expected_shape(self, shapes: tuple[tuple[Axis, ...], ...], least: int) -> str:
        texts = []
        for shape in shapes:
            parts = ["..." if axis is ... else f"{axis}" for axis in shape]
            texts.append(f"({parts[0]},)" if len(parts) == 1 else f"({', '.join(parts)})")
        arrays = " or ".join(text for text in texts if text != "()")
        accepted = ["a number"] * (() in shapes) + [f"shape {arrays}"] * bool(arrays)
        letters = {str(axis).split()[-1] for s in shapes for axis in s if isinstance(axis, str)}
        known = sorted(letters & set(self._axes))
        facts = [f"{k} = {self._axes[k][0]} as in {self._axes[k][1]}" for k in known]
        if least and letters - set(known):
            facts.append(f"{', '.join(sorted(letters - set(known)))} >= {least}")
        return " or ".join(accepted) + (f" with {' and '.join(facts)}" if facts else "")

    def _check_range(
        self, name: str, array: Array, finite: bool, bounds: tuple[float | None, ...]
    ) -> None:
        low, high, above, below = bounds
        tests = [np.isfinite(array)] if finite else []
        tests += [array >= low] if low is not None else []
        tests += [array <= high] if high is not None else []
        tests += [array > above] if above is not None else []
        tests += [array < below] if below is not None else []
        if all(test.all() for test in tests):
            return
        first = np.argwhere(~np.logical_and.reduce(tests))[0].tolist()
        what = f"{'finite ' if finite else ''}number"
        expected = (f"{what}s" if array.ndim else f"a {what}") + _interval(*bounds)
        self._refuse(RangeError, name, expected, _told(array, first))

    def _refuse(
        self, kind: type[Exception], name: str, expected: str, got: Any, remedy: str | None = None
    ) -> None:
        raise kind(message(self.function, name, expected, got, remedy))


def _numbers(function: str, name: str, value: Any) -> Array:
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as failure:
        raise DtypeError(message(function, name, "numbers", shortened(value))) from failure
    if array.dtype.kind not in "iuf":
        got = f"an array of {array.dtype}" if isinstance(value, np.ndarray) else shortened(value)
        raise DtypeError(message(function, name, "numbers", got))
    return array


def _interval(
    low: float | None, high: float | None, above: float | None, below: float | None
) -> str:
    if low == -np.inf and high is None:
        return ""  # anything but NaN
    left = low if low is not None else above
    right = high if high is not None else below
    if left is not None and right is not None:
        ends = "(["[low is not None], ")]"[high is not None]
        return f" in {ends[0]}{_bound(left)}, {_bound(right)}{ends[1]}"
    if left is not None:
        return f" {'above' if low is None else 'of at least'} {_bound(left)}"
    if right is not None:
        return f" {'below' if high is None else 'of at most'} {_bound(right)}"
    return ""


def _bound(bound: float) -> str:
    """As a text; large powers of two, and what lies one below, as such."""
    if isinstance(bound, int):
        for number, rest in ((abs(bound), ""), (abs(bound + 1), " - 1")):
            if number >= 1 << 20 and number & (number - 1) == 0:
                return f"{'-' * (bound < 0)}2^{number.bit_length() - 1}{rest}"
    return f"{bound:g}"


def _told(array: Array, index: list[int]) -> str:
    """The number at an index, with its row where that is short."""
    if not index:
        return f"{array}"
    if array.ndim <= 2 and array[index[0]].size <= 4:
        return f"{array[index[0]]} in row {index[0]}"
    return f"{array[tuple(index)]} at {index}"


def shortened(value: object) -> str:
    """What an error says that it got, in at most 60 characters."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
