"""One run of one check: calls of the submission, and comparisons."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ..worker.codec import encode, round_trip
from ..worker.layouts import without_functions
from .failures import CheckFailed, GraderFault, StudentFailure, WrongForm
from .hints import fingerprint
from .relations import find_relation
from .situations import lengths_of, situation_of
from .specs import Spec
from .tolerance import Tolerance
from .wording import changed_argument, not_finite, power_of_ten, worst_entry

# Reasons for no answer that may have to do with the arguments.
OF_ARGUMENTS = ("raised", "timeout", "died", "output")
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
        self._situation = ""  # of all calls and comparisons, where the check has said it
        self._args: Sequence[Any] = ()  # of the last call

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
        with self._said(args):
            returns.require(value, function.rpartition(".")[2])
        return value

    @contextmanager
    def situation(self, said: str) -> Iterator[None]:
        """Failures in this block say for which class of arguments, such as "for one row"."""
        before, self._situation = self._situation, said
        try:
            with self._said():
                yield
        finally:
            self._situation = before

    @contextmanager
    def _said(self, args: Sequence[Any] = ()) -> Iterator[None]:
        """A failure tells for which class of arguments; the first that says so is right."""
        try:
            yield
        except CheckFailed as failure:
            failure.details.setdefault("case", self._situation or situation_of(args))
            raise
        except StudentFailure as failure:
            if failure.reason in OF_ARGUMENTS:
                failure.case = failure.case or self._situation or situation_of(args)
            raise

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
        with self._said(args):
            returns.require(value, name)
        before = round_trip(without_functions(list(args)))
        self.asked += 1
        if encode("args", 0, after) != encode("args", 0, before):
            which = changed_argument(before, after)
            text = f"{name}: changes its {which} argument, which belongs to the caller"
            raise CheckFailed(text, {"explained": True})
        return value

    def _answer(self, function: str, args: Sequence[Any], layout: str | None = None) -> Any:
        """What the submission returns, unless a function among ``args`` has given the verdict."""
        where = function if "." in function else f"{self._module}.{function}"
        self._args = args
        try:
            given = [self._watched(arg) for arg in args]
            seconds = self.check.seconds
            with self._said(args):
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
        if not np.isfinite(answer).all():
            raise not_finite(what, answer, right)
        public = self.check.visibility == "public"
        relation = find_relation(answer, right, bound.relative, lengths_of(self._args))
        seen = (relation.text if public else relation.kind) if relation else ""
        head = f"{what}: relative error {error:.1e}, allowed {bound.relative:.0e}"
        worst = np.unravel_index(int(np.argmax(difference)), right.shape)
        said = worst_entry(answer, right, worst, error, reveal=reveal and public)
        raise CheckFailed(
            f"{head}; {said}" + (f". {seen[0].upper()}{seen[1:]}" if seen else ""),
            {
                "error": error,
                "tolerance": bound.relative,
                "worst_index": [int(i) for i in worst],
                "expected_sign": int(np.sign(right[worst])),
                "expected_scale": power_of_ten(right[worst]),
                "relation": relation.kind if relation else "",
                "explained": relation is not None and relation.explains,
                "advice": hint,
            },
            fingerprint(what, answer, error),
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
