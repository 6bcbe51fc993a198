"""What all optimizers share: checks, pieces, sparse rows, state. A method adds only its formula."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import ClassVar

import numpy as np

from ..checks import FloatArray, require_float_array, require_integer, require_number
from ..errors import DtypeError, RangeError, ShapeError, message
from ..row_map import RowMap
from .chunks import dense_pieces, row_pieces, run, scratch_like
from .gradients import Gradient, check_gradient_form

LearningRates = float | Mapping[str, float]


class Optimizer:
    """Base of the methods; a subclass names its moment arrays and writes `_update`.

    Moments are created as zeros at the first step of a group. The step count is kept for each
    group, so that a group which starts late gets a bias correction of its own.
    """

    slots: ClassVar[tuple[str, ...]] = ()

    def __init__(self, *, threads: int = 2) -> None:
        self._threads = require_integer(type(self).__name__, "threads", threads, least=1)
        self._moments: dict[str, dict[str, FloatArray]] = {}
        self._steps: dict[str, int] = {}

    def _update(
        self,
        parameter: FloatArray,
        gradient: FloatArray,
        moments: tuple[FloatArray, ...],
        scratch: FloatArray,
        learning_rate: float,
        step: int,
    ) -> None:
        """Apply the formula in place to one piece; `step` counts from 1."""
        raise NotImplementedError

    def step(
        self,
        params: Mapping[str, FloatArray],
        gradients: Mapping[str, Gradient],
        learning_rates: LearningRates,
    ) -> None:
        """Move every parameter that has a gradient one step downhill, in place.

        Args:
            params: {group: float32 or float64 array}; views with any strides are welcome.
            gradients: {group: array of the same shape and dtype}, or (rows, values): rows (M,)
                int64 strictly increasing, values (M, ...); other rows, and their moments, keep
                every bit. A group without an entry is left alone.
            learning_rates: one number for all groups, or {group: number}; >= 0.

        Raises:
            DtypeError, ShapeError, RangeError: before anything is changed; values that are not
                finite are refused too, since they would poison the moments for good.
        """
        rates = {name: self._rate(name, learning_rates) for name in gradients}
        for name, gradient in gradients.items():
            if name not in params:
                known = f"one of {sorted(params)}"
                raise RangeError(message("step", "gradients", known, repr(name)))
            self._check_group(name, params[name])
            check_gradient_form(name, params[name], gradient)
        for name, gradient in gradients.items():
            self._step_group(name, params[name], gradient, rates[name])

    def _step_group(
        self, name: str, parameter: FloatArray, gradient: Gradient, rate: float
    ) -> None:
        if name not in self._moments:
            self._moments[name] = {slot: _zeros(parameter) for slot in self.slots}
            self._steps[name] = 0
        self._steps[name] += 1
        step = self._steps[name]
        moments = tuple(self._moments[name][slot] for slot in self.slots)
        row = int(np.prod(parameter.shape[1:], dtype=np.int64))

        def on_views(piece: tuple[FloatArray, ...], scratch: FloatArray) -> None:
            here, slope, *state = piece
            self._update(here, slope, tuple(state), scratch_like(scratch, here), rate, step)

        if not isinstance(gradient, tuple):
            pieces = dense_pieces([parameter, gradient, *moments])
            size = parameter.size
            run(on_views, pieces, dtype=parameter.dtype, size=size, row=row, threads=self._threads)
            return
        rows, values = gradient

        def on_rows(part: slice, scratch: FloatArray) -> None:
            picked = rows[part]
            copies = [array[picked] for array in (parameter, *moments)]
            on_views((copies[0], values[part], *copies[1:]), scratch)
            for array, copy in zip((parameter, *moments), copies, strict=True):
                array[picked] = copy

        parts = row_pieces(rows, row)
        run(on_rows, parts, dtype=values.dtype, size=values.size, row=row, threads=self._threads)

    def state(self) -> dict[str, FloatArray]:
        """Copies of all moments and step counts: {"<slot>/<group>": array, "step/<group>": ()}."""
        saved: dict[str, FloatArray] = {}
        for name, moments in self._moments.items():
            saved[f"step/{name}"] = np.array(self._steps[name], dtype=np.int64)
            for slot, array in moments.items():
                saved[f"{slot}/{name}"] = array.copy()
        return saved

    def load_state(self, state: Mapping[str, FloatArray]) -> None:
        """Replace everything by a dictionary from `state`; the next steps repeat bit for bit.

        Raises:
            RangeError: keys that this method does not have, or that are incomplete.
            DtypeError: moments that are not float arrays.
        """
        names = [key.removeprefix("step/") for key in state if key.startswith("step/")]
        expected = {f"{slot}/{name}" for name in names for slot in ("step", *self.slots)}
        if set(state) != expected:
            odd = sorted(set(state) ^ expected)
            remedy = f"was it saved by {type(self).__name__}?"
            got = f"missing or superfluous {odd}"
            raise RangeError(message("load_state", "state", "a complete state", got, remedy))
        for key, array in state.items():
            if not key.startswith("step/"):
                require_float_array("load_state", key, array)
        self._steps = {name: int(state[f"step/{name}"]) for name in names}
        self._moments = {
            name: {slot: state[f"{slot}/{name}"].copy() for slot in self.slots} for name in names
        }

    def apply_row_map(self, row_map: RowMap, names: Iterable[str] | None = None) -> None:
        """Reorder the moments along axis 0 as the parameters were; fresh rows start at zero.

        The step count of the group stays, so the first step of a fresh row has no bias correction
        left: with Adam's defaults it is 3.2 learning rates long, then shorter.

        Args:
            row_map: where each later row came from.
            names: the groups that have these rows; None for all groups with state. Name them
                when other groups, a background for example, do not have these rows.

        Raises:
            RangeError, ShapeError: before anything is changed.
        """
        groups = list(self._moments) if names is None else [n for n in names if n in self._moments]
        changed = {
            name: {slot: row_map.apply(array) for slot, array in self._moments[name].items()}
            for name in groups
        }
        self._moments.update(changed)

    def resample(self, name: str, array_function: Callable[[FloatArray], FloatArray]) -> None:
        """Pass each moment array of a group through a function, coarse to fine for example.

        Args:
            name: the group; without state yet, nothing happens.
            array_function: returns the moment array for the new parameter; same dtype.

        Raises:
            DtypeError: the function returned another dtype.
            RangeError: a second moment came back negative or not finite.
        """
        if name not in self._moments:
            return
        changed = {}
        for slot, array in self._moments[name].items():
            new = require_float_array("resample", slot, array_function(array))
            if new.dtype != array.dtype:
                raise DtypeError(message("resample", slot, array.dtype, new.dtype))
            if slot == "mean_square" and not bool(np.all(new >= 0.0)):
                raise RangeError(message("resample", slot, "values >= 0", "negative or NaN"))
            changed[slot] = np.array(new, order="C")
        self._moments[name] = changed

    def _check_group(self, name: str, parameter: FloatArray) -> None:
        argument = f"params[{name!r}]"
        parameter = require_float_array("step", argument, parameter)
        if not parameter.flags.writeable:
            raise RangeError(message("step", argument, "a writeable array", "a read-only one"))
        for array in self._moments.get(name, {}).values():
            if array.shape != parameter.shape:
                remedy = "after a refinement call apply_row_map or resample"
                expected = f"shape {array.shape} as its moments have"
                raise ShapeError(message("step", argument, expected, parameter.shape, remedy))
            if array.dtype != parameter.dtype:
                expected = f"{array.dtype} as its moments have"
                raise DtypeError(message("step", argument, expected, parameter.dtype))

    @staticmethod
    def _rate(name: str, learning_rates: LearningRates) -> float:
        if not isinstance(learning_rates, Mapping):
            return require_number("step", "learning_rates", learning_rates, least=0.0)
        if name not in learning_rates:
            expected = f"a rate for {name!r}"
            raise RangeError(message("step", "learning_rates", expected, sorted(learning_rates)))
        return require_number("step", f"learning_rates[{name!r}]", learning_rates[name], least=0.0)


def _zeros(parameter: FloatArray) -> FloatArray:
    return np.zeros(parameter.shape, dtype=parameter.dtype)
