"""One run of one check: calls of the submission, and comparisons."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ..worker.codec import encode, round_trip
from ..worker.layouts import without_functions
from .failures import CheckFailed, GraderFault, StudentFailure, WrongForm
from .specs import Spec
from .tolerance import Tolerance

# Wrong answers that agree to so many digits have the same cause.
FINGERPRINT_DIGITS = 8


Breach = tuple[str, tuple[str, int]]  # a sentence, and (file, line) in the submission


class Student(Protocol):
    """Where calls go: into a worker, or into this process for code that we trust."""

    @property
    def breaches(self) -> Mapping[str, Breach]:
        """Of the rule that adjoints are written, by function."""

    def call(self, function: str, args: Sequence[Any], *, seconds: float) -> Any:
        """The value of one function of the submission; raises StudentFailure."""

    def look(
        self, function: str, args: Sequence[Any], *, seconds: float, layout: str
    ) -> tuple[Any, Any]:
        """The value as `call` has it, and the arguments as the function has left them.

        Args:
            function, args, seconds: as for `call`.
            layout: of the arrays, a name in `worker.layouts.LAYOUTS`.
        """

    def watch(
        self, function: str, args: Sequence[Any], puts: Any, *, seconds: float
    ) -> tuple[Any, Any] | None:
        """The value in code with probes, and what these saw (`worker.adjoint_trace`).

        None where nothing is watched; raises StudentFailure where no value comes.

        Args:
            function, args, seconds: as for `call`.
            puts: what is put back, as `adjoint_evidence.puts_back` makes it, or None.
        """

    def cpu_seconds(self) -> float | None:
        """Processor time used so far, measured from outside; None where that is not possible."""

    def close(self) -> None:
        """End it, and all that it has started."""


class CheckLike(Protocol):
    """What a trial knows of the check that it runs; `Check` has more."""

    @property
    def id(self) -> str:
        """For messages."""

    @property
    def visibility(self) -> str:
        """Only of a public check are expected values shown."""

    @property
    def tolerance(self) -> Tolerance | None:
        """Of comparisons that name no other."""

    @property
    def seconds(self) -> float:
        """Wall-clock limit of one call."""


class Trial:
    """What the body of a check gets.

    Attributes:
        rng: random numbers of this check; the same seed gives the same check.
        reference: the solution's module, for hidden checks; None on a student's machine.
        margins: error / tolerance of each comparison, in order; what the doctor looks at.
        asked: how many other conditions were looked at.
    """

    def __init__(
        self,
        check: CheckLike,
        student: Student,
        *,
        seed: Sequence[int],
        module: str,
        reference: Any = None,
    ) -> None:
        self.check = check
        self.rng = np.random.default_rng(list(seed))
        self.margins: list[float] = []
        self.asked = 0
        self._student = student
        self._verdict: CheckFailed | None = None
        self._module = module
        self._reference = reference

    @property
    def reference(self) -> Any:
        """The solution's module.

        Raises:
            GraderFault: this is a student's machine, where no check may use it.
        """
        if self._reference is None:
            raise GraderFault(f"{self.check.id}: uses the reference, which is not here")
        return self._reference

    @property
    def has_reference(self) -> bool:
        """Whether the solution is at hand."""
        return self._reference is not None

    def call(self, function: str, *args: Any, returns: Spec) -> Any:
        """Call the submission, and look at kind, shape, dtype and finiteness of what comes back.

        Args:
            function: its name; of the graded module, or "module.name" for another.
            args: scalars, arrays, lists, dicts; functions, which the submission can call.
            returns: what the value must be.

        Raises:
            StudentFailure: no value came.
            CheckFailed: the value is not of that kind, or a function among `args` has raised it;
                what the submission makes of such an exception does not matter.
        """
        value = self._answer(function, args)
        returns.require(value, function.rpartition(".")[2])
        return value

    def look(self, function: str, *args: Any, returns: Spec, layout: str = "plain") -> Any:
        """Like `call`, and require that the arguments stay as they were, to the last bit.

        The worker looks at them: nothing has to be asked of the submission. Code that patches the
        worker can lie about its arguments here, never about a value.

        Args:
            function, args, returns: as for `call`.
            layout: of the arrays, a name in `worker.layouts.LAYOUTS`.
        """
        name = function.rpartition(".")[2]
        value, after = self._answer(function, args, layout)
        returns.require(value, name)
        before = round_trip(without_functions(list(args)))
        self.asked += 1
        if encode("args", 0, after) != encode("args", 0, before):
            raise CheckFailed(f"{name}: changes an argument, which belongs to its caller")
        return value

    def _answer(self, function: str, args: Sequence[Any], layout: str | None = None) -> Any:
        """What the submission returns, unless a function among ``args`` has given the verdict."""
        where = function if "." in function else f"{self._module}.{function}"
        try:
            given = [self._watched(arg) for arg in args]
            seconds = self.check.seconds
            if layout is None:
                value = self._student.call(where, given, seconds=seconds)
            else:
                value = self._student.look(where, given, seconds=seconds, layout=layout)
        except StudentFailure:
            if self._verdict is not None:
                raise self._verdict from None
            raise
        if self._verdict is not None:
            raise self._verdict
        return value

    def _watched(self, arg: Any) -> Any:
        """The argument; of a function, one that remembers if it has given the verdict."""
        if not callable(arg):
            return arg

        def service(*args: Any) -> Any:
            try:
                return arg(*args)
            except CheckFailed as failure:
                self._verdict = failure
                raise

        return service

    def cpu_seconds(self) -> float | None:
        """Processor time of the submission so far; None where it cannot be measured outside."""
        return self._student.cpu_seconds()

    def close(
        self,
        what: str,
        got: ArrayLike,
        expected: ArrayLike,
        tolerance: Tolerance | None = None,
        *,
        reveal: bool = False,
        hint: str = "",
    ) -> None:
        """Require that ``got`` is ``expected`` within the tolerance, by relative norm.

        Args:
            what: names the quantity, such as "d_sigma".
            got, expected: numbers or arrays; the shapes must be equal.
            tolerance: by default the check's.
            reveal: the expected value may be shown; never in hidden checks.
            hint: said on failure.

        Raises:
            CheckFailed: with the error, the worst index, and the expected sign and scale.
            GraderFault: there is no tolerance, or ``expected`` is not finite.
        """
        bound = tolerance or self.check.tolerance
        if bound is None:
            raise GraderFault(f"{self.check.id}: compares without a tolerance")
        right, answer = np.asarray(expected, np.float64), np.asarray(got, np.float64)
        if not np.isfinite(right).all():
            raise GraderFault(f"{self.check.id}: {what}: the expected value is not finite")
        if answer.shape != right.shape:
            raise WrongForm(f"{what}: expected shape {right.shape}, got {answer.shape}")
        if right.size == 0:
            raise GraderFault(f"{self.check.id}: {what}: compares nothing")
        scale = max(float(np.linalg.norm(right)), bound.floor)
        difference = np.abs(answer - right)
        error = float(np.linalg.norm(difference)) / scale if scale > 0 else np.inf
        if scale == 0 and not difference.any():
            error = 0.0
        self.margins.append(error / bound.relative)
        if error <= bound.relative:  # written so that NaN fails
            return
        worst = np.unravel_index(int(np.argmax(np.nan_to_num(difference, nan=np.inf))), right.shape)
        raise CheckFailed(
            self._sentence(what, error, bound, answer, right, worst, reveal),
            {
                "error": error,
                "tolerance": bound.relative,
                "worst_index": [int(i) for i in worst],
                "expected_sign": int(np.sign(right[worst])),
                "expected_scale": _power_of_ten(right[worst]),
                "advice": hint,
            },
            fingerprint(what, answer),
            (answer, right) if right.ndim else None,
        )

    def require(self, condition: bool, text: str, *, hint: str = "", **details: Any) -> None:
        """Fail with ``text`` unless ``condition`` is True."""
        self.asked += 1
        if condition is not True and not (isinstance(condition, np.bool_) and bool(condition)):
            raise CheckFailed(text, {**details, "advice": hint}, fingerprint(text, np.zeros(0)))

    def refuses(self, function: str, *args: Any, error: str) -> None:
        """Require that the submission raises ``error``, named by its type, for these arguments."""
        self.asked += 1
        try:
            self._answer(function, args)
        except StudentFailure as failure:
            if failure.reason == "raised" and failure.private.startswith(f"{error}:"):
                return
            if failure.reason != "raised":
                raise
            raise CheckFailed(f"{function}: expected {error}, got another exception") from failure
        raise CheckFailed(f"{function}: expected {error}, but it returned")

    def _sentence(
        self,
        what: str,
        error: float,
        bound: Tolerance,
        got: Any,
        right: Any,
        worst: tuple[Any, ...],
        reveal: bool,
    ) -> str:
        at = f" at index {tuple(int(i) for i in worst)}" if right.ndim else ""
        head = f"{what}: relative error {error:.1e}, allowed {bound.relative:.0e}"
        told = _told_apart(float(got[worst]) + 0.0, float(right[worst]) + 0.0)  # no minus zero
        if reveal and self.check.visibility == "public":
            return f"{head}; yours{at} is {told[0]}, expected {told[1]}"
        mine = f"yours{at} is {float(got[worst]) + 0.0:.6g}"
        expected = _sign_and_size(float(right[worst]))
        if expected == _sign_and_size(float(got[worst])):
            alike = "sign and order of magnitude" if error < 1 else "sign"
            return f"{head}; {mine}, of the right {alike}, but wrong"
        return f"{head}; {mine}, expected {expected}"


def _told_apart(a: float, b: float) -> tuple[str, str]:
    """Two numbers with six digits, or with as many more as show that they differ."""
    for digits in range(6, 18):
        texts = f"{a:.{digits}g}", f"{b:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts


def fingerprint(what: str, answer: ArrayLike) -> str:
    """A short hash of a wrong answer, equal for answers that agree to eight digits."""
    values = np.asarray(answer, np.float64)
    finite = np.abs(values[np.isfinite(values)])
    top = float(finite.max()) if finite.size else 0.0
    step = top * 10.0**-FINGERPRINT_DIGITS
    rounded = (np.rint(values / step) if step > 0 else values) + 0.0  # no minus zero
    size = f"{top:.{FINGERPRINT_DIGITS - 2}e}"
    data = f"{what}|{values.shape}|{size}|".encode() + rounded.astype("<f8").tobytes()
    return hashlib.sha256(data).hexdigest()[:24]


def _sign_and_size(value: float) -> str:
    """As much as may be said of a hidden value."""
    sign = {1.0: "positive", -1.0: "negative"}.get(float(np.sign(value)), "zero")
    return f"something {sign}, of the order {_power_of_ten(value)}" if value else sign


def _power_of_ten(value: float) -> str:
    if not value or not np.isfinite(value):
        return "0"
    return f"1e{int(np.floor(np.log10(abs(value)))):+03d}"
