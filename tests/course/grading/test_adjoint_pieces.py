"""The parts of a run under watch: probes, traces, copies, what is put back, types."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.grading.adjoint_evidence import puts_back
from photograd_course.grading.adjoint_watch import Remembering, find_breach
from photograd_course.grading.failures import StudentFailure
from photograd_course.grading.outcome import Status
from photograd_course.grading.shifted_copies import Copies, Seen, nearby, scaled, shifted
from photograd_course.student.checking import check_here
from photograd_course.worker import adjoint_trace
from photograd_course.worker.adjoint_trace import TooMuchToKeep
from photograd_course.worker.adjoint_types import dual, overloads
from photograd_course.worker.adjoint_watch import Watch

from course.grading.right_styles import CLOSURES, TAPE

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
X = np.array([0.7, -1.3, 2.1])
SAME = """
from dataclasses import dataclass
import numpy as np
@dataclass
class Pair:
    a: float = 1.5
    def both(self, *more, k=2.0):
        return super().__repr__()[:1], [each * k for each in (self.a, *more)]
def f(x, /, y=-0.5, *, z: float = 3.0):
    total: float = 0.0
    for k, (a, b) in enumerate(zip(x, x[::-1])):
        total += a * b if k % 2 else (half := a / 2)
    x2 = x.copy()
    x2[1:] -= x[0]
    x2.T[0], kept = total, {"sum": x2.sum(), **{"half": half}}
    match x2.shape:
        case (3,):
            name = f"{total:.3f}"
    def inner(t=y):
        nonlocal total
        total = total + t
        return lambda u: u @ x2
    return inner()(x), total, kept, name, Pair().both(*x), ~np.isnan(x2), [*map(np.exp, x)]
"""


def watched(text: str, x: Any, puts: Any = None) -> tuple[Any, dict[str, Any]]:
    return Watch({"m": text}, {}).run("m.f", [np.array(x)], puts)


def three(text: str) -> tuple[Seen, tuple[Seen, Seen]]:
    """A run, and two whose input is moved a little."""
    rng = np.random.default_rng(5)
    seen = [Seen.of(watched(text, X)[1])]
    seen += [Seen.of(watched(text, X * (1 - 1e-6 * rng.random(3)))[1]) for _ in range(2)]
    return seen[0], (seen[1], seen[2])


def offsets(run: Seen, copies: Copies) -> set[complex]:
    found = run.values[copies.member] - run.values[copies.base]
    return {complex(np.round(each, 9)) for each in found}


def test_probes_change_no_value() -> None:
    names: dict[str, Any] = {}
    exec(compile(SAME, "m.py", "exec"), names)
    assert repr(watched(SAME, X)[0]) == repr(names["f"](X.copy()))


def test_additive_copies_are_found_whatever_the_step_came_from() -> None:
    text = "import numpy as np\ndef f(x):\n    h = np.ldexp(1.0, -10)\n"
    text += "    return [x + h, x - 1j * h, (x * 3) + h, x * x, np.sin(x) - x]\n"
    run, moved = three(text)
    assert offsets(run, shifted(run, moved)) == {0.000976562 + 0j, -0.000976562j}


def test_multiples_and_steps_that_grow_are_found() -> None:
    run, moved = three("def f(x):\n    return x * 1.0005\n")
    found = scaled(run, moved)
    assert np.allclose(run.values[found.member] / run.values[found.base], 1.0005)
    run, moved = three("import numpy as np\ndef f(x):\n    return x + 1e-4 * np.abs(x).max()\n")
    found = nearby(run, moved, X)
    assert np.allclose(run.values[found.member] - run.values[found.base], 2.1e-4)


def test_a_sum_of_two_parts_is_no_copy() -> None:
    run, moved = three("def f(x):\n    return x[:2] + 0.5 * x[2], x[0] * x[1], -x, 1 / x\n")
    assert len(shifted(run, moved).member) == 0


def test_a_copy_gets_what_its_base_is_in_that_run_by_all_its_names() -> None:
    text = "import numpy as np\ndef f(x):\n    y = np.add(x, 0.001)\n    z = y[:2]\n"
    text += "    return y * 1, z * 1, float(x[0]) + 0.001\n"
    run, moved = three(text)
    copies = shifted(run, moved)
    puts = puts_back(run, copies, np.zeros(len(copies.member)))
    y, z, first = watched(text, X, puts)[0]
    assert (y.tolist(), z.tolist(), first) == (X.tolist(), X[:2].tolist(), X[0])
    moved_too = puts_back(run, copies, np.full(len(copies.member), 0.25))
    assert np.allclose(watched(text, X, moved_too)[0][0], X + 0.25)


def test_too_many_numbers_end_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(adjoint_trace, "MOST_NUMBERS", 10)
    with pytest.raises(TooMuchToKeep):
        watched("def f(x):\n    while True:\n        x = x * 1.0\n", X)


def test_a_tape_is_told_from_a_dual_number() -> None:
    names: dict[str, Any] = {"np": np}
    exec(TAPE + CLOSURES, names)
    two = names["Node"](2.0) * 3.0, names["Var"](2.0) * names["Var"](3.0)
    assert [(overloads(each), dual(each)) for each in two] == [(True, ""), (True, "")]
    number = type("Number", (), {"__mul__": lambda a, _: a})()
    number.value, number.slope, number.parents = 2.0, 1.0, (number,)
    assert "carries derivatives" in dual(number)
    assert "poly1d" in dual(np.poly1d([1.0, 2.0]))
    assert not any(map(overloads, (1.0, np.float64(1), np.zeros(2), [1.0], "a", np.ma.ones(2))))


@pytest.mark.parametrize(
    "slope",
    [
        "h = np.ldexp(1.0, -70)\n    slow = np.exp(-(x + np.sqrt(-1 + 0j) * h)).imag / h",
        "h = np.cbrt(np.spacing(1.0))\n    slow = (np.exp(-x - h) - np.exp(-x + h)) / (2 * h)",
    ],
)
def test_a_worker_watches_public_checks_too(slope: str) -> None:
    bundle = read_folder(TOY)
    text = bundle.solution.replace(
        "return d_s * falling, -d_s * w * falling",
        f"{slope}\n    return d_s * falling, d_s * w * slow",
    )
    assert text != bundle.solution
    found = {each.id: each for each in check_here(bundle, {"toy.py": text.encode()}, bundle.checks)}
    lost = {name for name, outcome in found.items() if outcome.status is not Status.PASSED}
    assert lost == {"90.2.differences", "90.2.cost"}
    assert {found[name].reason for name in lost} == {"computed"}
    said = found["90.2.differences"].text
    assert said.startswith(
        "weighted_sum_backward is a quotient of shifted evaluations (toy.py, line"
    )


def test_a_refused_import_hides_no_derivative() -> None:
    bundle = read_folder(TOY)
    slope = "h = np.cbrt(np.spacing(1.0))\n    slow = (np.exp(-x - h) - np.exp(-x + h)) / (2 * h)"
    text = bundle.solution.replace(
        "return d_s * falling, -d_s * w * falling",
        f"{slope}\n    return d_s * falling, d_s * w * slow",
    ).replace("import numpy as np\n", "import numpy as np\nimport socket\n", 1)
    found = {each.id: each for each in check_here(bundle, {"toy.py": text.encode()}, bundle.checks)}
    assert found["90.2.differences"].reason == "computed"


class Wary:
    """A submission whose derivative answers another way when it is watched."""

    breaches: dict[str, Any] = {}  # noqa: RUF012

    def __init__(self, answer: Any) -> None:
        self._answer = answer

    def call(self, function: str, args: Any, *, seconds: float) -> Any:
        del function, args, seconds
        return np.array([2.0])

    def watch(self, function: str, args: Any, puts: Any, *, seconds: float) -> Any:
        del function, args, puts, seconds
        if isinstance(self._answer, StudentFailure):
            raise self._answer
        return self._answer, {}


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (StudentFailure("raised", "f raised ValueError"), "an exception only while it is watched"),
        (np.array([3.0]), "another answer while it is watched"),
        (StudentFailure("timeout", "too late"), ""),
    ],
)
def test_who_behaves_otherwise_under_watch_is_named_and_loses_nothing(
    answer: Any, said: str
) -> None:
    remembered = Remembering(Wary(answer), ["f"])  # type: ignore[arg-type]
    remembered.call("m.f", [np.ones(3)], seconds=1.0)
    breach, otherwise = find_breach(remembered)
    assert breach is None
    assert otherwise.endswith(said)
    assert otherwise.startswith("f ") or not said
