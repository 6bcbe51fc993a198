"""Task 02.5, public checks."""

import numpy as np
from photograd_course.grading import Array, Record, checks_for

from .common import DIFFERENCES, EXACT, STEP, away, random_edges, reachable

check = checks_for(calls=("backward",), tolerance=EXACT)

RUN = "adapters.run_graph"


def path_sums(edges, root, seed):
    """Gradients of all nodes, as the solution of a linear system.

    Node j gets the seed if it is the root, and from each k that uses it W[k, j] times what k got.
    """
    n = len(edges)
    weights = np.zeros((n, n))
    for k, each in enumerate(edges):
        for place, slope in each:
            weights[k, place] += slope
    return np.linalg.solve(np.eye(n) - weights.T, seed * np.eye(n)[root])


def program_34():
    """(x + y) + x * x."""
    return [["add", 0, 1], ["mul", 0, 0], ["add", 2, 3]]


WORKED = (  # program, inputs, value, gradients of the inputs
    ([["add", 0, 1], ["mul", 3, 2]], [3.0, 4.0, 5.0], 35.0, [5.0, 5.0, 7.0]),
    ([["add", 0, 1]], [15.0, 12.0], 27.0, [1.0, 1.0]),
    ([["mul", 0, 1]], [15.0, 12.0], 180.0, [12.0, 15.0]),
    ([["max", 0, 1]], [15.0, 12.0], 15.0, [1.0, 0.0]),
    (program_34(), [5.0, 4.0], 34.0, [11.0, 1.0]),
)


@check("02.5.worked", points=2, sole="the numbers of the handout's figures, to compare by hand")
def the_graphs_of_the_handout(t):
    """(x + y) z of Figure 1 and four more graphs of the handout have the printed gradients."""
    for program, inputs, value, gradients in WORKED:
        n = len(program) + len(inputs)
        answer = Record({"values": Array((n,)), "gradients": Array((n,))})
        found = t.call(RUN, program, inputs, returns=answer)
        t.close(f"value {value:g}", found["values"][-1], value, reveal=True)
        t.close(
            f"gradients of {value:g}", found["gradients"][: len(inputs)], gradients, reveal=True
        )


def run_by_hand(t, edges, roots, seeds, default_seed=False):
    orders = [reachable(edges, root) for root in roots]
    return t.call(
        "adapters.run_by_hand",
        edges,
        orders,
        seeds,
        default_seed,
        returns=Array((len(roots), len(edges))),
    )


@check(
    "02.5.adds", points=4, sole="gates and order are given here, so that the loop alone is at fault"
)
def contributions_of_all_uses_are_added(t):
    """Each use of a value adds local derivative times the user's gradient to its gradient."""
    for _ in range(5):
        edges = random_edges(t.rng, 14)
        got = run_by_hand(t, edges, [13], [1.0], default_seed=True)
        t.close("gradients", got[0], path_sums(edges, 13, 1.0))


@check("02.5.seed", points=2)
def gradients_are_proportional_to_the_seed(t):
    """The seed multiplies all gradients, and a seed of zero gives zero."""
    edges = [[], [], [[0, 2.0], [1, -3.0]], [[2, 0.5], [0, 1.0]]]
    right = np.array([2.0, -1.5, 0.5, 1.0])
    seed = float(away(t.rng, 2.0, 3.0, 1)[0])
    t.close("gradients", run_by_hand(t, edges, [3], [seed])[0], seed * right, reveal=True)
    got = run_by_hand(t, edges, [3], [0.0])
    t.require(not got.any(), "a seed of zero leaves gradients that are not zero")


@check("02.5.again", points=3)
def a_second_call_starts_from_zero(t):
    """Called again, or from another root, backward gives what it gives the first time."""
    edges = random_edges(t.rng, 14)
    got = run_by_hand(t, edges, [13, 13, 10], [1.0, 1.0, -2.0])
    alone = run_by_hand(t, edges, [10], [-2.0])
    needed = reachable(edges, 10)
    t.require(got[0].any() and alone.any(), "all gradients are zero")
    t.close("gradients of the second call", got[1], got[0])
    t.close("gradients from another root", got[2][needed], alone[0][needed])
    left = [k for k in range(14) if k not in needed]
    t.require(
        np.array_equal(got[2][left], got[1][left]),
        "values on which the root does not depend have changed",
    )


# Random expressions, and a forward evaluation of the grader's own.
UNARY = {"exp": np.exp, "log": np.log}


def combine(op, a, b):
    """One instruction, for real and complex numbers."""
    if op in UNARY:
        return UNARY[op](a)
    if op == "max":
        return a if np.real(a) > np.real(b) else b
    if op == "pow":
        return a**b
    return {"add": a + b, "mul": a * b, "sub": a - b, "div": a / b if b else np.inf}[op]


def evaluate(program, inputs):
    """Numbers of all nodes; complex inputs give complex ones."""
    numbers = list(inputs)
    for op, a, b in program:
        second = None if b is None else b if op == "pow" else numbers[b]
        numbers.append(combine(op, numbers[a], second))
    return numbers


def allowed(op, a, b):
    """Whether a gate is smooth, and of moderate size, in a neighborhood of these numbers."""
    if op == "max":
        return abs(a - b) > 0.2
    if op == "div":
        return abs(b) > 0.5
    if op == "exp":
        return abs(a) < 1.5
    if op == "log" or (op == "pow" and b not in {2, 3}):
        return a > 0.4
    return True


OPS = ("add", "add", "sub", "mul", "mul", "div", "max", "exp", "log", "pow")


def random_program(rng, n_inputs, length):
    """Instructions that use every node at least once, as [op, a, b], and inputs (n_inputs,)."""
    inputs = away(rng, 0.4, 1.6, n_inputs)
    program, numbers, unused = [], list(inputs), list(range(n_inputs))
    while len(program) < length or len(unused) > 1:
        op = str(rng.choice(OPS)) if len(program) < length else "add"
        a, b = _two_nodes(rng, unused, len(numbers), len(program) >= length)
        second = b
        if op in UNARY:
            second = None
        elif op == "pow":
            second = [2, 3, 0.5, -1.5][int(rng.integers(4))]
        number = numbers[b] if second == b and op != "pow" else second
        if not allowed(op, numbers[a], number):
            continue
        value = combine(op, numbers[a], number)
        if not 0.02 < abs(value) < 12.0 and len(program) < length:
            continue
        used = {a} if op in UNARY or op == "pow" else {a, b}
        unused = [k for k in unused if k not in used] + [len(numbers)]
        program.append([op, a, second])
        numbers.append(value)
    return program, inputs


def _two_nodes(rng, unused, count, closing):
    """Two different places, the first of them one not used so far."""
    if closing:
        return unused[0], unused[1]
    a = int(rng.choice(unused)) if rng.random() < 0.6 else int(rng.integers(count))
    b = int(rng.integers(count - 1))
    return a, b + (b >= a)


def central(forward, x):
    """Differences (N,) of ``forward``, points (P, N) -> (P,), all in one call."""
    steps = STEP * np.maximum(1.0, np.abs(x))
    moved = forward(np.concatenate([x + np.diag(steps), x - np.diag(steps)]))
    return (moved[: len(x)] - moved[len(x) :]) / (2 * steps)


def complex_step(program, x):
    """Derivatives (N,) without truncation: the imaginary part of f(x + 1e-30 i)."""
    steps = 1e-30j * np.eye(len(x))
    return np.array([np.imag(evaluate(program, x + step)[-1]) / 1e-30 for step in steps])


def trusted_program(rng):
    """A random program at a place where differences of its values can be trusted."""
    while True:
        program, x = random_program(rng, int(rng.integers(2, 5)), int(rng.integers(8, 16)))
        right = complex_step(program, x)
        size = np.linalg.norm(right)
        found = central(lambda points, p=program: np.array([evaluate(p, q)[-1] for q in points]), x)
        if 0.05 < size < 1e3 and np.linalg.norm(found - right) < 3e-8 * size:
            return program, x, found, right


@check(
    "02.5.expressions",
    points=3,
    sole="whole graphs through all gates, where students can look at them",
    tolerance=None,
)
def expressions_agree_with_differences(t):
    """Gradients of ten random expressions agree with finite differences of your own values."""
    for _ in range(10):
        program, x, _, _ = trusted_program(t.rng)
        n = len(program) + len(x)
        answer = Record({"values": Array((n,)), "gradients": Array((n,))})
        found = t.call(RUN, program, x, returns=answer)

        def forward(points, program=program):
            return t.call("adapters.forward_values", program, points, returns=Array((len(points),)))

        t.close(
            "gradients of the inputs",
            found["gradients"][: len(x)],
            central(forward, x),
            DIFFERENCES,
        )
