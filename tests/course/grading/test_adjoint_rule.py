"""The rule that adjoints are written: its breaches are found, and honest code has none."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.build.named import read_alternatives
from photograd_course.grading.check import Check
from photograd_course.grading.outcome import Status
from photograd_course.grading.runner import adjoint_functions
from photograd_course.student.checking import check_here
from photograd_course.worker.adjoint_rule import COMPLEX, DIFFERENCES, DUAL, HIDDEN, breaches

from course.attacks.attack import read_attacks

ROOT = Path(__file__).parents[3]
TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
ASSIGNMENTS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))

BROKEN = {
    "one imaginary constant": (
        COMPLEX,
        "def f_adjoint(x, g):\n    return g * f(x + 1e-30j).imag / 1e-30\n",
    ),
    "a named step": (
        COMPLEX,
        "H = 1e-20\ndef f_adjoint(x, g):\n    z = x + 1j * H\n    return g * f(z).imag / H\n",
    ),
    "complex of two numbers": (
        COMPLEX,
        "def f_adjoint(x, g):\n    return g * f(complex(x, 1e-9)).imag * 1e9\n",
    ),
    "in a helper": (
        COMPLEX,
        "def slope(h, x):\n    return f(x + h * 1j).imag / h\n"
        "def f_adjoint(x, g):\n    return g * slope(1e-8, x)\n",
    ),
    "dual numbers": (
        DUAL,
        "class Dual:\n    def __init__(self, a, b):\n        self.a, self.b = a, b\n"
        "    def __mul__(self, other):\n        return Dual(self.a * other.a, 0)\n"
        "    __rmul__ = __mul__\n"
        "def f_adjoint(x, g):\n    return g * f(Dual(x, 1.0)).b\n",
    ),
    "an array that carries derivatives": (
        DUAL,
        "import numpy as np\nclass Jet(np.ndarray):\n    pass\n"
        "def f_adjoint(x, g):\n    return g * f(x.view(Jet)).slope\n",
    ),
    "central differences": (
        DIFFERENCES,
        "def f_adjoint(x, g):\n    h = 1e-5\n    return g * (f(x + h) - f(x - h)) / (2 * h)\n",
    ),
    "in place, in a list": (
        DIFFERENCES,
        "STEP = 10**-6\ndef f_adjoint(x, g):\n    values = []\n    for sign in (1, -1):\n"
        "        moved = x.copy()\n        moved[0] += sign * STEP\n"
        "        values.append(f(moved))\n"
        "    rise = values[0] - values[1]\n    return g * rise * (0.5 / STEP)\n",
    ),
    "through a helper's default": (
        DIFFERENCES,
        "def slope(f, x, h=1e-6):\n    return (f(x + h) - f(x)) / h\n"
        "def f_adjoint(x, g):\n    return g * slope(f, x)\n",
    ),
    "text that is run": (
        HIDDEN,
        "def f_adjoint(x, g):\n    return eval('f(x + 1e-9j)').imag * g\n",
    ),
    "text that is run by way of a pure module": (
        HIDDEN,
        "import dataclasses\ndef f_adjoint(x, g):\n"
        "    return dataclasses.builtins.eval('f(x + 1e-9j)').imag * g\n",
    ),
    "another name for what runs text": (
        HIDDEN,
        "from dataclasses import builtins as b\ndef f_adjoint(x, g):\n"
        "    return getattr(b, 'ev' 'al')('f(x + 1e-9j)').imag * g\n",
    ),
}
HONEST = {
    "floors and rates": "def f_adjoint(x, g):\n    n = (x * x + 1e-12) ** 0.5\n"
    "    return g * (x - 1.0) / (n + 1e-12) - 1e-3 * g\n",
    "differences of neighbors": "def f_adjoint(x, g):\n    return g * (x[1:] - x[:-1]) / 0.5\n",
    "complex powers": "def f_adjoint(x, y, g):\n    p = (x + 1j * y) ** 3\n    return g * p.imag\n",
    "differencing that nothing calls": "def test():\n    return (f(1 + 1e-5) - f(1)) / 1e-5\n"
    "def f_adjoint(x, g):\n    return g * x\n",
    "no Python": "def f_adjoint(:\n",
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_breach_is_found(name: str) -> None:
    what, text = BROKEN[name]
    found = breaches({"m": "def f(x):\n    return x * x\n" + text}, ["f_adjoint"])
    assert found["f_adjoint"]["what"] == what
    assert found["f_adjoint"]["file"] == "m.py"


@pytest.mark.parametrize(
    ("attack", "what"), [(72, COMPLEX), (73, DUAL), (74, DIFFERENCES)], ids=["72", "73", "74"]
)
def test_each_variant_of_an_attack_is_found_for_what_it_is(attack: int, what: str) -> None:
    chosen = next(each for each in read_attacks() if each.number == attack)
    for name, data in chosen.variants().items():
        found = breaches({"arena": data.decode()}, ["weighted_sum_backward"])
        said = HIDDEN if name == "by text" else what
        assert found["weighted_sum_backward"]["what"] == said, name


@pytest.mark.parametrize("name", HONEST)
def test_honest_code_breaks_no_rule(name: str) -> None:
    assert breaches({"m": HONEST[name]}, ["f_adjoint"]) == {}


@pytest.mark.parametrize("folder", ASSIGNMENTS, ids=lambda folder: folder.name)
def test_no_solution_and_no_alternative_breaks_it(folder: Path) -> None:
    bundle = read_folder(folder)
    adjoints = adjoint_functions(bundle.checks)
    module = bundle.manifest.module
    for name, text in {"solution": bundle.solution, **read_alternatives(folder)}.items():
        assert breaches({**bundle.brought, module: text}, adjoints) == {}, name


def test_a_breach_costs_every_check_of_the_adjoint_and_no_other() -> None:
    bundle = read_folder(TOY)
    text = bundle.solution.replace(
        "return d_s * falling, -d_s * w * falling",
        "h = 1e-5\n    slow = (np.exp(-x - h) - np.exp(-x + h)) / (2 * h)\n"
        "    return d_s * falling, d_s * w * slow",
    )
    assert text != bundle.solution
    checks: list[Check] = list(bundle.checks)
    assert adjoint_functions(checks) == ["weighted_sum_backward"]
    found = {o.id: o for o in check_here(bundle, {"toy.py": text.encode()}, checks)}
    lost = {name for name, outcome in found.items() if outcome.status is not Status.PASSED}
    assert lost == {"90.2.differences", "90.2.cost"}
    assert {found[name].reason for name in lost} == {"rule"}
    assert "weighted_sum_backward divides a difference" in found["90.2.differences"].text
    assert "toy.py, line" in found["90.2.differences"].text
