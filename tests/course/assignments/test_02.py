"""Assignment 02 owes what every assignment owes; and its own words are right."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_module
from photograd_course.build.named import read_alternatives
from photograd_course.grading.outcome import Outcome, Status

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    load_checks_of,
    source,
)

FOLDER = ASSIGNMENTS / "02_backpropagation"


class TestBackpropagation(AssignmentTests):
    folder = FOLDER


def engine(mutant: str | None = None):
    return load_module("engine", source(FOLDER) if mutant is None else apply_mutant(FOLDER, mutant))


def checks_module():
    return load_checks_of(FOLDER)


GATES = {
    "x + y": lambda x, y: x + y,
    "x y": lambda x, y: x * y,
    "max": lambda x, y: x.maximum(y),
    "exp": lambda x: x.exp(),
    "log": lambda x: x.log(),
    "x ** 3": lambda x: x**3,
    "x ** -0.5": lambda x: x**-0.5,
    "x ** 2": lambda x: x**2,
}
ROW = re.compile(r"^\| (\w.*?) \| ([-\d., ]+) \| ([-\d.]+) \| ([-\d., ]+) \|$", re.MULTILINE)


def test_the_tables_of_the_handout_hold() -> None:
    module = engine()
    rows = ROW.findall((FOLDER / "handout.md").read_text("utf-8"))
    assert len(rows) == 10
    for gate, at, value, slopes in rows:
        inputs = [module.Value(float(number)) for number in at.split(",")]
        result = GATES[gate](*inputs)
        assert result.data == pytest.approx(float(value), abs=5e-7)
        found = [slope for _, slope in result.inputs]
        assert found == pytest.approx([float(each) for each in slopes.split(",")], abs=5e-7)


def test_other_numbers_of_the_handout_hold() -> None:
    module = engine()
    value, gradient = module.value_and_gradient(lambda v: (v[0] * v[1] + v[0]).log(), [2.0, 0.5])
    assert value == pytest.approx(1.098612, abs=5e-7)
    assert gradient == pytest.approx([0.5, 0.666667], abs=5e-7)
    x, y = module.Value(5.0), module.Value(4.0)
    assert len(module.topo_order((x + y) + x * x)) == 5
    two_sided, one_sided = (1.1**3 - 0.9**3) / 0.2, (1.1**3 - 1) / 0.1
    assert (two_sided, one_sided) == pytest.approx((3.01, 3.31))
    x, y = module.Value(3.0), module.Value(4.0)
    u = x / y
    assert (u.data, *(slope for _, slope in u.inputs)) == (0.75, 0.25, -0.1875)
    assert np.spacing(1e8) == pytest.approx(1.5e-8, rel=0.01)


def classmates_derivative(mutant: str) -> float:
    module = engine(mutant)
    x, y = module.Value(5.0), module.Value(4.0)
    f = (x + y) + x * x
    module.backward(f)
    if mutant == "leaks":
        module.backward(f)
    return x.grad


def test_only_one_answer_explains_the_classmates_six() -> None:
    assert classmates_derivative("once_for_each_input") == 6.0
    others = [classmates_derivative(m) for m in ("overwrite", "product_no_swap", "leaks")]
    assert 6.0 not in others
    assert others[0] in {1.0, 5.0}


def test_generated_answers_are_what_one_works_out_by_hand() -> None:
    bundle = read_folder(FOLDER, secret=SECRET)
    keys, reference = bundle.keys, engine()
    assert keys is not None
    drawn = {question.id: question.draw for question in bundle.questions if question.draw}
    for a in drawn["02.g1"]["a"]:
        for x in drawn["02.g1"]["x"]:
            for y in drawn["02.g1"]["y"]:
                assert abs(a * x - y) > 0.1, "a tie"
                right = 2 * a * x if a * x > y else y
                assert keys.derivative_of_max_product(reference, a, x, y) == pytest.approx(right)
    for k in drawn["02.g2"]["k"]:
        assert keys.contributions(reference, k) == 4 * k
    for c in drawn["02.g3"]["c"]:
        right = abs(c - 1) / max(c, 1)
        assert keys.error_of_a_factor(reference, c) == pytest.approx(right, rel=1e-6)


def test_the_oracles_of_the_checks_agree_with_one_another() -> None:
    """Sums over all paths, one by one, are the solution of the linear system."""
    module = checks_module()
    rng = np.random.default_rng(4)
    for _ in range(5):
        edges = module.random_edges(rng, 9)

        def paths(node: int, target: int, edges: list = edges) -> float:
            if node == target:
                return 1.0
            return sum(slope * paths(place, target) for place, slope in edges[node])

        right = [paths(8, target) for target in range(9)]
        assert module.path_sums(edges, 8, 1.0) == pytest.approx(right, rel=1e-12)


def test_random_expressions_use_every_gate_and_every_input() -> None:
    module = checks_module()
    rng = np.random.default_rng(5)
    seen: set[str] = set()
    for _ in range(50):
        program, x, differences, exact = module.trusted_program(rng)
        used = {k for op, a, b in program for k in (a, None if op == "pow" else b)}
        assert used >= set(range(len(x) + len(program) - 1))
        assert np.linalg.norm(differences - exact) < 3e-8 * np.linalg.norm(exact)
        seen |= {op for op, _, _ in program}
    assert seen == set(module.OPS)


def test_quadratic_work_is_seen_without_a_clock() -> None:
    """Reads and comparisons: ten times below the bound when right, ten times above when not."""
    module = checks_module()
    right = read_alternatives(FOLDER)
    for name, text in {"solution": source(FOLDER), **right}.items():
        assert work_per_node(text, module.ladder(12)) <= module.WORK_PER_NODE / 10, name
        assert work_per_node(text, module.chain(1500)) <= module.WORK_PER_NODE / 10, name
    walks = apply_mutant(FOLDER, "order_walks_all_paths")
    assert work_per_node(walks, module.ladder(12)) > 10 * module.WORK_PER_NODE
    listed = apply_mutant(FOLDER, "order_list_of_seen")
    assert work_per_node(listed, module.chain(1500)) > 10 * module.WORK_PER_NODE


def work_per_node(text: str, edges: list) -> float:
    kept = sys.modules.get("engine")
    sys.modules["engine"] = load_module("engine", text)
    try:
        adapters = load_module("adapters", (FOLDER / "adapters.py").read_text("utf-8"))
        found = adapters.work(edges, len(edges) - 1)
        return (found["reads"] + found["comparisons"]) / len(edges)
    finally:
        if kept is None:
            del sys.modules["engine"]
        else:
            sys.modules["engine"] = kept


GOOD_SUM = "return Value(self.data + other.data, ((self, 1.0), (other, 1.0)))"
GOOD_EXP = "return Value(grown, ((self, grown),))"
MALFORMED = {
    "a comma": (GOOD_EXP, "return Value(grown, ((self, grown)))", "02.3.exp"),
    "(Value)": (
        GOOD_SUM,
        "return Value(self.data + other.data, ((self,), (other,)))",
        "02.1.slopes",
    ),
    "yours is a Value": (GOOD_SUM, "return Value(self.data + other.data, self)", "02.1.slopes"),
    "expected a Value as result": (GOOD_SUM, "return self.data + other.data", "02.1.slopes"),
}


def judged(text: str, *tasks: str) -> dict[str, Outcome]:
    """Outcomes of the checks of some tasks, by id."""
    return {each.id: each for each in judge(FOLDER, text, tasks=tasks)}


@pytest.mark.parametrize("said", MALFORMED)
def test_malformed_inputs_are_named(said: str) -> None:
    good, bad, check = MALFORMED[said]
    assert source(FOLDER).count(good) == 1
    outcomes = judged(source(FOLDER).replace(good, bad), check.rpartition(".")[0], "02.5")
    assert outcomes[check].status is Status.FAILED
    assert said in outcomes[check].details["exception"]
    assert said in outcomes["02.5.expressions"].details["exception"]


HINTS = {
    "an explicit stack": ("02.4.chain", "order_recursive"),
    "marks in a list": ("02.4.chain", "order_list_of_seen"),
    "when it is popped": ("02.4.order", "order_breadth_first"),
}


@pytest.mark.parametrize("hint", HINTS)
def test_a_wrong_order_gets_the_hint_that_fits(hint: str) -> None:
    check, mutant = HINTS[hint]
    outcomes = judged(apply_mutant(FOLDER, mutant), "02.4")
    assert hint in outcomes[check].hint
    if check == "02.4.order":
        assert "in the graph a, b(a), c(a, b) with the root c" in outcomes[check].text


IN_PLACE = """\
        kept, step = x[i], eps * max(1.0, abs(x[i]))
        x[i] = kept + step
        up = f(x)[0]
        x[i] = kept - step
        quotients[i] = (up - f(x)[0]) / (2.0 * step)
"""


def test_moving_x_in_place_is_not_taken_for_another_mistake() -> None:
    text = apply_mutant(FOLDER, "check_moves_x")
    table = json.loads((FOLDER / "hints.json").read_text("utf-8"))
    said = {id: each.hint for id, each in judged(text, "02.6").items()}
    assert "You change x itself" in said["02.6.rejects"]
    assert not any("divide by the norm" in hint for hint in said.values())
    assert any("divide by the norm" in hint for hint in table.values())
    # Differences that are right, in an x that is not put back.
    first = text.index("        step = eps * max")
    last = text.index("    error = float")
    moved = text[:first] + IN_PLACE + text[last:]
    outcome = judged(moved, "02.6")["02.6.accepts"]
    assert "asks for other points" in outcome.text
    assert "copies of it" in outcome.hint


def test_the_exploration_runs_with_a_finished_engine(tmp_path: Path) -> None:
    for name in ("engine.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    done = subprocess.run(
        [sys.executable, "explore.py", "--figure", "0"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert float(re.search(r"grad_check: (\S+)", done.stdout)[1]) < 1e-6
    before, after = re.search(r"loss (\S+) -> (\S+)", done.stdout).groups()
    assert float(after) < float(before) / 20
    assert (tmp_path / "explore_picture.png").exists()
    assert (tmp_path / "explore_network.png").exists()
