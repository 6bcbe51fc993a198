"""Checks of assignment 02. Graphs travel as lists of numbers, see adapters.py.

A gate is asked for its value and for the slopes that it noted, so that a mistake there does not
count against `backward`; graphs made by hand, with their order given, do the same for `backward`.
"""

from __future__ import annotations

import numpy as np
from photograd_course.grading import (
    Array,
    Integer,
    Items,
    Number,
    Record,
    Subject,
    Tolerance,
    Truth,
    asks,
    check,
)

EXACT = Tolerance(
    1e-12, "three ways to write the gates differ by 2e-16; the nearest wrong slope is off by 0.1"
)
DIFFERENCES = Tolerance(
    1e-6,
    "differences leave 3e-8 at most, since graphs where they leave more are not asked; "
    "wrong slopes and orders are off by 1e-2 and more",
)
ANALYTIC = Tolerance(
    1e-9, "complex steps have no truncation: 2.5e-15 was the worst of 300 graphs, five engines each"
)
REPORTED = Tolerance(
    2e-8, "differences, and so what is reported, are right to 1e-10; one-sided ones are off by 6e-7"
)
ACCEPTED = Tolerance(
    1e-7, "right gradients have an error of 1e-10, one-sided differences report 3e-6", floor=1.0
)

STEPS = Tolerance(1e-3, "x + h is rounded: 1e-11 of h; a step half or twice as long is off by 0.5")

STEP = 1e-5
SLOPES = Record({"value": Number(), "slopes": Array((2,)), "strangers": Integer(0)})
RUN = "adapters.run_graph"

# Mutants that fail the same checks.
WRONG_SLOPES = (
    "sum_one_sided",
    "sum_subtracts",
    "sum_shares_the_slope",
    "sum_like_a_product",
    "product_of_slopes_one",
    "product_one_sided",
    "product_of_itself",
)
WRONG_ROUTES = ("max_to_both", "max_to_the_smaller", "max_slope_is_value")
WRONG_TIES = ("max_tie_to_first", "max_tie_to_none", "max_halves_a_tie")
WRONG_EXP = ("exp_slope_one", "exp_like_a_power", "exp_slope_is_input")
WRONG_LOG = ("log_sign", "log_slope_of_its_value", "log_to_base_ten")
WRONG_POW = ("pow_keeps_exponent", "pow_without_factor", "pow_like_exponential")
WRONG_LOOPS = ("walks_forward", "forgets_the_chain", "slope_by_value")


def gates_spec(n):
    return Record({"values": Array((n,)), "slopes": Array((n, 2))})


def differences_of_gate(t, op, a, b):
    """Slopes (N, 2) by central differences of the gate's own values; column 1 is 0 without b."""
    n = len(a)
    slopes = np.zeros((n, 2))
    for column in range(1 if b is None or op == "pow" else 2):
        moved = []
        for sign in (1, -1):
            at = [np.array(a), None if b is None else np.array(b)]
            at[column] = at[column] + sign * STEP
            found = t.call("adapters.gates", op, at[0], at[1], returns=gates_spec(n))
            moved.append(found["values"])
        slopes[:, column] = (moved[0] - moved[1]) / (2 * STEP)
    return slopes


def require_slopes(t, op, a, b=None):
    """A gate's slopes against differences of its own values."""
    found = t.call("adapters.gates", op, a, b, returns=gates_spec(len(a)))
    t.close(f"slopes of {op}", found["slopes"], differences_of_gate(t, op, a, b), DIFFERENCES)


def away(rng, low, high, n):
    """Numbers of either sign with low <= |x| <= high."""
    return rng.uniform(low, high, n) * rng.choice([-1.0, 1.0], n)


@check(
    "02.1.values",
    task="02.1",
    points=2,
    calls=("Value.__add__", "Value.__mul__"),
    tolerance=EXACT,
    sole="tells a wrong value from a wrong slope",
)
def sums_and_products_have_their_value(t):
    """Sums and products have the right value, with a plain number on either side too."""
    a, b = away(t.rng, 0.5, 3.0, 6), away(t.rng, 0.5, 3.0, 6)
    for op, right in (("add", a + b), ("radd", a + b), ("mul", a * b), ("rmul", a * b)):
        found = t.call("adapters.gates", op, a, b, returns=gates_spec(6))
        t.close(f"values of {op}", found["values"], right, reveal=True)


@check(
    "02.1.slopes",
    task="02.1",
    points=4,
    calls=("Value.__add__", "Value.__mul__"),
    sole="names the gate; whole graphs fail too",
)
def slopes_of_sums_and_products(t):
    """A sum and a product note the slope towards each input (against differences)."""
    a, b = away(t.rng, 0.5, 3.0, 6), away(t.rng, 4.0, 6.0, 6)
    for op in ("add", "mul"):
        require_slopes(t, op, a, b)


@check(
    "02.1.square",
    task="02.1",
    points=3,
    calls=("Value.__add__", "Value.__mul__"),
    tolerance=EXACT,
    sole="the same value on both sides; the worked graph fails too, for its x * x",
)
def the_same_value_twice(t):
    """x + x has the slope 2 towards x, and x * x has the slope 2 x."""
    x = float(t.rng.uniform(1.5, 3.0))
    found = t.call("adapters.gate", "add", x, None, True, returns=SLOPES)
    t.close("slope of x + x", found["slopes"].sum(), 2.0, reveal=True)
    found = t.call("adapters.gate", "mul", x, None, True, returns=SLOPES)
    t.close("slope of x * x", found["slopes"].sum(), 2 * x, reveal=True)


@check(
    "02.2.routes",
    task="02.2",
    points=4,
    calls=("Value.maximum",),
    tolerance=EXACT,
    sole="names the gate; whole graphs fail too",
)
def the_larger_input_takes_all(t):
    """maximum has the larger value, and only the larger input gets a slope."""
    a = away(t.rng, 0.5, 3.0, 8)
    b = a + away(t.rng, 0.5, 1.0, 8)
    found = t.call("adapters.gates", "max", a, b, returns=gates_spec(8))
    t.close("values of maximum", found["values"], np.maximum(a, b), reveal=True)
    require_slopes(t, "max", a, b)


@check("02.2.tie", task="02.2", points=3, calls=("Value.maximum",), tolerance=EXACT)
def a_tie_is_settled(t):
    """At a tie the second input takes all; no differences here, they would give 1/2 and 1/2."""
    x = float(t.rng.uniform(1.5, 3.0))
    found = t.call("adapters.gate", "max", x, x, returns=SLOPES)
    t.close("slopes at a tie", found["slopes"], [0.0, 1.0], reveal=True)
    found = t.call("adapters.gate", "max", x, None, True, returns=SLOPES)
    t.close("slope of maximum(x, x)", found["slopes"].sum(), 1.0, reveal=True)


@check(
    "02.3.exp",
    task="02.3",
    points=3,
    calls=("Value.exp",),
    tolerance=EXACT,
    sole="names the gate; whole graphs fail too",
)
def the_exponential(t):
    """exp(0) = 1 and exp(log 7) = 7; its slope agrees with differences."""
    found = t.call("adapters.gates", "exp", np.log([1.0, 7.0]), None, returns=gates_spec(2))
    t.close("values of exp", found["values"], [1.0, 7.0], reveal=True)
    require_slopes(t, "exp", t.rng.uniform(-2.0, 2.0, 6))


@check(
    "02.3.log",
    task="02.3",
    points=3,
    calls=("Value.log",),
    tolerance=EXACT,
    sole="names the gate; whole graphs fail too",
)
def the_logarithm(t):
    """log 1 = 0 and log e = 1; its slope agrees with differences."""
    found = t.call("adapters.gates", "log", np.exp([0.0, 1.0]), None, returns=gates_spec(2))
    t.close("values of log", found["values"], [0.0, 1.0], reveal=True)
    require_slopes(t, "log", t.rng.uniform(0.3, 3.0, 6))


@check("02.3.power", task="02.3", points=4, calls=("Value.__pow__",), tolerance=EXACT)
def powers(t):
    """Powers agree with differences, at negative numbers and at zero too."""
    for n in (2, 3, -1):
        require_slopes(t, "pow", away(t.rng, 0.5, 2.0, 5), np.full(5, float(n)))
    require_slopes(t, "pow", t.rng.uniform(0.5, 2.0, 5), t.rng.uniform(0.2, 0.9, 5))
    found = t.call("adapters.gate", "pow", 0.0, 1.0, returns=SLOPES)
    t.close("slope of x**1 at 0", found["slopes"], [1.0, 0.0], reveal=True)


def random_edges(rng, n, uses=3):
    """A graph of n nodes by hand: uses of earlier nodes with slopes of either sign."""
    edges = [[]]
    for k in range(1, n):
        count = int(rng.integers(0 if k < n // 3 else 1, uses + 1))
        places = rng.integers(0, k, count)
        slopes = away(rng, 0.4, 1.2, count)
        edges.append([[int(p), float(s)] for p, s in zip(places, slopes, strict=True)])
    return edges


def reachable(edges, root):
    """Places that `root` depends on, itself included, ascending."""
    found = {root}
    for k in range(root, -1, -1):
        if k in found:
            found |= {place for place, _ in edges[k]}
    return sorted(found)


def path_sums(edges, root, seed):
    """Gradients by all nodes, as the solution of a linear system.

    Node j gets the seed if it is the root, and from each k that uses it W[k, j] times what k got.
    """
    n = len(edges)
    weights = np.zeros((n, n))
    for k, each in enumerate(edges):
        for place, slope in each:
            weights[k, place] += slope
    return np.linalg.solve(np.eye(n) - weights.T, seed * np.eye(n)[root])


END = -2  # see adapters.order_of
LETTERS = "abcdefghijklmnopqrstuvwxyz"
EARLY = (
    "append a value after all its inputs; whoever marks a value already when it is put on the "
    "stack takes it for done too early: mark it when it is taken from there"
)


def named(place):
    """Node `place` as a letter."""
    return LETTERS[place] if 0 <= place < len(LETTERS) else "?"


def in_words(edges, root):
    """A graph as text: each node that `root` needs, with its inputs in brackets."""
    parts = []
    for k in reachable(edges, root):
        inputs = ", ".join(named(place) for place, _ in edges[k])
        parts.append(f"{named(k)}({inputs})" if inputs else named(k))
    return ", ".join(parts)


def require_order(t, edges, root):
    """`topo_order` of one graph: everything needed, once, inputs first."""
    needed = reachable(edges, root)
    places = t.call("adapters.order_of", edges, root, returns=Array((2 * len(edges) + 1,), "i8"))
    order = [int(place) for place in places if place != END]
    yours = " ".join(map(named, order)) or "empty"
    graph = f"in the graph {in_words(edges, root)} with the root {named(root)} (inputs in brackets)"
    where = f"{graph} your order is {yours}" if t.check.visibility == "public" else "your order"
    twice = [named(k) for k in needed if order.count(k) > 1]
    t.require(
        not twice,
        f"{where}: {', '.join(twice)} more than once",
        hint="mark each value that you have expanded, and pass over marked ones",
    )
    missing = [named(k) for k in needed if k not in order]
    t.require(
        not missing,
        f"{where}: without {', '.join(missing)}",
        hint="everything that the root depends on, and the root itself",
    )
    t.require(len(order) == len(needed), f"{where}: the root does not depend on all of these")
    place = {node: at for at, node in enumerate(order)}
    early = [(k, j) for k in needed for j, _ in edges[k] if place[k] < place[j]]
    said = f"{where}: {named(early[0][0])} before its input {named(early[0][1])}" if early else ""
    t.require(not early, said, hint=EARLY)


@check(
    "02.4.order",
    task="02.4",
    points=5,
    calls=("topo_order",),
    sole="`backward` gets its order given, so this alone looks at it in detail",
)
def inputs_stand_before_their_users(t):
    """Every value that the root needs stands in the order once, after its own inputs."""
    # From small to large, so that the graph of a message is a small one.
    require_order(t, [[]], 0)
    require_order(t, [[], [[0, 1.0]], [[0, 1.0], [1, 1.0]]], 2)
    require_order(t, [[], [[0, 1.0]], [[1, 1.0], [0, 1.0]]], 2)
    skip = [[[0, 1.0]], [[1, 1.0]], [[2, 1.0]]]
    require_order(t, [[], *skip, [[3, 1.0], [0, 1.0]], [[4, 1.0], [1, 1.0]]], 5)
    for n in (4, 4, 5, 5, 6, 6, 7, 8):
        require_order(t, random_edges(t.rng, n), n - 1)
    for _ in range(20):
        edges = random_edges(t.rng, 12)
        require_order(t, edges, 11)
        require_order(t, edges, 8)


def ladder(rungs):
    """Diamonds in a row: 3 nodes each, and 2 paths through each."""
    edges = [[]]
    for _ in range(rungs):
        top = len(edges) - 1
        edges += [[[top, 0.5]], [[top, 0.7]], [[top + 1, 1.0], [top + 2, 1.0]]]
    return edges


def chain(n):
    return [[]] + [[[k, 1.0]] for k in range(n - 1)]


def ordered(n):
    """What `adapters.chain` returns."""
    return Record({"order": Array((2 * n + 1,), "i8"), "gradient": Number()})


WORK_PER_NODE = 20  # right walks need 1 or 2; all paths through a ladder of 12 need over 300


WORK = Record({"reads": Integer(0), "comparisons": Integer(0), "too_deep": Truth()})
TOO_DEEP = "a stack of your own has no limit; Python's stack of calls has one"
LISTED = "marks in a list are searched from the front; use a set"
UNMARKED = "read the inputs of each value once: mark what you have seen"


def require_work(t, edges, what):
    found = t.call("adapters.work", edges, len(edges) - 1, returns=WORK)
    t.require(
        not found["too_deep"],
        f"{what} of {len(edges)} nodes: topo_order: RecursionError",
        hint=TOO_DEEP,
    )
    each = (found["reads"] + found["comparisons"]) / len(edges)
    t.require(
        each <= WORK_PER_NODE,
        f"{what} of {len(edges)} nodes: {each:.0f} reads and comparisons a node, allowed "
        f"{WORK_PER_NODE}",
        hint=LISTED if found["comparisons"] > found["reads"] else UNMARKED,
    )


@check("02.4.chain", task="02.4", points=4, calls=("topo_order",), seconds=20.0)
def a_chain_of_a_hundred_thousand(t):
    """A chain of 100,000 values is put in order, without a recursion error."""
    require_work(t, chain(1500), "a chain")
    n = 100_000
    order = t.call("adapters.chain", n, returns=ordered(n))["order"]
    t.require(order[0] != -3, "a chain of 100,000 nodes: topo_order: RecursionError", hint=TOO_DEEP)
    length = int((order != -2).sum())
    t.require(length == n, f"the order holds {length} values, not 100,000")
    in_order = np.array_equal(order[:n], np.arange(n))
    t.require(in_order, "the values of a chain are not in the order of the chain")


def program_34():
    """(x + y) + x * x."""
    return [["add", 0, 1], ["mul", 0, 0], ["add", 2, 3]]


WORKED = (  # program, inputs, value, gradients by the inputs
    ([["add", 0, 1], ["mul", 3, 2]], [3.0, 4.0, 5.0], 35.0, [5.0, 5.0, 7.0]),
    ([["add", 0, 1]], [15.0, 12.0], 27.0, [1.0, 1.0]),
    ([["mul", 0, 1]], [15.0, 12.0], 180.0, [12.0, 15.0]),
    ([["max", 0, 1]], [15.0, 12.0], 15.0, [1.0, 0.0]),
    (program_34(), [5.0, 4.0], 34.0, [11.0, 1.0]),
)


@check(
    "02.5.worked",
    task="02.5",
    points=2,
    calls=("backward",),
    tolerance=EXACT,
    sole="the numbers of the handout's figures, to compare by hand",
)
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
    "02.5.adds",
    task="02.5",
    points=4,
    calls=("backward",),
    tolerance=EXACT,
    sole="gates and order are given here, so that the loop alone is at fault",
)
def contributions_of_all_uses_are_added(t):
    """Through each use of a value its gradient grows by slope times the user's gradient."""
    for _ in range(5):
        edges = random_edges(t.rng, 14)
        got = run_by_hand(t, edges, [13], [1.0], default_seed=True)
        t.close("gradients", got[0], path_sums(edges, 13, 1.0))


@check("02.5.seed", task="02.5", points=2, calls=("backward",), tolerance=EXACT)
def gradients_are_proportional_to_the_seed(t):
    """The seed multiplies all gradients, and a seed of zero gives zero."""
    edges = [[], [], [[0, 2.0], [1, -3.0]], [[2, 0.5], [0, 1.0]]]
    right = np.array([2.0, -1.5, 0.5, 1.0])
    seed = float(away(t.rng, 2.0, 3.0, 1)[0])
    t.close("gradients", run_by_hand(t, edges, [3], [seed])[0], seed * right, reveal=True)
    got = run_by_hand(t, edges, [3], [0.0])
    t.require(not got.any(), "a seed of zero leaves gradients that are not zero")


@check("02.5.again", task="02.5", points=3, calls=("backward",), tolerance=EXACT)
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
    """Whether a gate is smooth, and of moderate size, in a neighbourhood of these numbers."""
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
    task="02.5",
    points=3,
    calls=("backward",),
    sole="whole graphs through all gates, where students can look at them",
)
def expressions_agree_with_differences(t):
    """Gradients of ten random expressions agree with differences of your own forward values."""
    for _ in range(10):
        program, x, _, _ = trusted_program(t.rng)
        n = len(program) + len(x)
        answer = Record({"values": Array((n,)), "gradients": Array((n,))})
        found = t.call(RUN, program, x, returns=answer)

        def forward(points, program=program):
            return t.call("adapters.forward_values", program, points, returns=Array((len(points),)))

        t.close(
            "gradients by the inputs",
            found["gradients"][: len(x)],
            central(forward, x),
            DIFFERENCES,
        )


# >>> hidden
def multiplied(t, n):
    """What the adapter `gates` takes, for n products."""
    return "mul", *t.rng.normal(0.0, 3.0, (2, n))


def checked_place(t, n):
    """What `grad_check` takes, for n numbers."""
    return smooth(t.rng, n)


@check(
    "02.1.many",
    task="02.1",
    points=3,
    calls=("Value.__add__", "Value.__mul__"),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes, to rounding, at places not known beforehand",
    battery=[
        Subject(
            "adapters.gates",
            multiplied,
            gates_spec,
            right=lambda *args: {"values": args[2] * args[3], "slopes": np.stack(args[3:1:-1], 1)},
            sizes=(1, 7),
        )
    ],
)
def sums_and_products_at_random(t):
    """Values and slopes of sums and products are right at 100 random places."""
    a, b = t.rng.normal(0.0, 3.0, (2, 100))
    ones = np.ones(100)
    for op, right, slopes in (("add", a + b, [ones, ones]), ("mul", a * b, [b, a])):
        found = t.call("adapters.gates", op, a, b, returns=gates_spec(100))
        t.close(f"values of {op}", found["values"], right)
        t.close(f"slopes of {op}", found["slopes"], np.stack(slopes, 1))


@check(
    "02.2.many",
    task="02.2",
    points=2,
    calls=("Value.maximum",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at places not known beforehand",
)
def maximum_at_random(t):
    """maximum is right at 100 random places."""
    a, b = t.rng.normal(0.0, 3.0, (2, 100))
    found = t.call("adapters.gates", "max", a, b, returns=gates_spec(100))
    t.close("values of maximum", found["values"], np.maximum(a, b))
    t.close("slopes of maximum", found["slopes"], np.stack([a > b, a < b], 1).astype(float))


@check(
    "02.3.many",
    task="02.3",
    points=3,
    calls=("Value.exp", "Value.log", "Value.__pow__"),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes, to rounding, at places not known beforehand",
)
def gates_of_one_input_at_random(t):
    """exp, log and powers are right at 100 random places."""
    a, n = t.rng.uniform(0.05, 4.0, 100), t.rng.uniform(-2.5, 2.5, 100)
    cases = (
        ("exp", None, np.exp(a), np.exp(a)),
        ("log", None, np.log(a), 1 / a),
        ("pow", n, a**n, n * a ** (n - 1)),
    )
    for op, b, values, slopes in cases:
        found = t.call("adapters.gates", op, a, b, returns=gates_spec(100))
        t.close(f"values of {op}", found["values"], values)
        t.close(f"slopes of {op}", found["slopes"][:, 0], slopes)


@check("02.4.work", task="02.4", points=4, calls=("topo_order",), visibility="hidden")
def each_value_is_visited_once(t):
    """A ladder of diamonds, with 4096 paths through 37 values, costs what 37 values cost."""
    require_order(t, ladder(4), 12)
    require_work(t, ladder(12), "a ladder")


@check(
    "02.5.random",
    task="02.5",
    points=4,
    calls=("backward",),
    visibility="hidden",
    sole="fifty expressions, against differences and complex steps of ours",
)
def fifty_random_expressions(t):
    """Values and gradients of fifty random expressions are right."""
    cases = [trusted_program(t.rng) for _ in range(50)]
    answer = Record(
        {"values": Array((50,)), "gradients": Items(*[Array((len(x),)) for _, x, _, _ in cases])}
    )
    programs, inputs = [p for p, _, _, _ in cases], [x for _, x, _, _ in cases]
    found = t.call("adapters.run_graphs", programs, inputs, returns=answer)
    right = [evaluate(program, x)[-1] for program, x in zip(programs, inputs, strict=True)]
    t.close("values", found["values"], right, ANALYTIC)
    for got, (_, _, differences, exact) in zip(found["gradients"], cases, strict=True):
        t.close("gradients against differences", got, differences, DIFFERENCES)
        t.close("gradients", got, exact, ANALYTIC)


@check(
    "02.5.chain",
    task="02.5",
    points=2,
    calls=("backward",),
    visibility="hidden",
    tolerance=EXACT,
    seconds=20.0,
)
def a_long_chain_backward(t):
    """backward passes a chain of 50,000 values."""
    slope = float(1.0 + t.rng.uniform(1e-6, 1e-5))
    found = t.call("adapters.chain", 50_000, slope, True, returns=ordered(50_000))
    t.close("gradient of the first value", found["gradient"], slope**49_999, ANALYTIC)


# <<< hidden

ONE_BY_ONE = "two sides, one coordinate at a time, and a new copy of x for each point"
COPIES = "move copies of x, a new one each time"
VERDICT = Number(finite=False)
SMALL = 1e-6  # the error of a gradient that is accepted


def smooth(rng, n):
    """A function (value, gradient) of n numbers with all kinds of slopes, and a place."""
    w, m = away(rng, 0.5, 2.0, n), away(rng, 0.3, 1.0, (n, n))

    def f(x):
        s = np.sin(m @ x)
        return float(w @ s), m.T @ (w * np.cos(m @ x))

    return f, rng.uniform(0.3, 1.5, n)


@check("02.6.accepts", task="02.6", points=2, calls=("grad_check",))
def right_gradients_are_accepted(t):
    """Right gradients of smooth functions have an error close to 0, and x stays as it is."""
    for n in (1, 4, 7):
        f, x = smooth(t.rng, n)
        asked = []

        def counted(x, f=f, asked=asked):
            asked.append(np.array(x))
            return f(asked[-1])

        watched = asks(counted, Array((n,), finite=False), name="f")
        errors = t.call("adapters.checked_twice", watched, x, returns=Array((2,), finite=False))
        # Where x has changed, the second call begins elsewhere.
        calls = len(asked) // 2
        same = np.array_equal(asked[:calls], asked[calls:])
        t.require(same, "grad_check has changed the x that it was given", hint=COPIES)
        numbers = "1 number" if n == 1 else f"{n} numbers"
        t.close(
            f"error of a right gradient by {numbers}",
            errors[0],
            0.0,
            ACCEPTED,
            reveal=True,
            hint=ONE_BY_ONE,
        )
        t.require(calls <= 2 * n + 1, f"{calls} calls of f, {2 * n + 1} are enough")


@check("02.6.rejects", task="02.6", points=3, calls=("grad_check",), tolerance=REPORTED)
def wrong_gradients_are_measured(t):
    """The error of a wrong gradient is reported as Eq. (16) has it."""
    f, x = smooth(t.rng, 5)
    right = f(x)[1]
    wrong = {
        "twice as large": lambda g: 2 * g,
        "of the wrong sign": lambda g: -g,
        "reversed": lambda g: g[::-1].copy(),
        "without its last entry": lambda g: g * np.array([1.0, 1.0, 1.0, 1.0, 0.0]),
        "zero": lambda g: 0 * g,
    }
    reported, expected = [], []
    for spoil in wrong.values():

        def spoiled(x, spoil=spoil):
            value, gradient = f(np.asarray(x))
            return value, spoil(gradient)

        reported.append(t.call("adapters.checked", spoiled, x, returns=VERDICT))
        scale = max(np.linalg.norm(spoil(right)), np.linalg.norm(right))
        expected.append(np.linalg.norm(spoil(right) - right) / scale)
    # All together: mistakes that agree in one of the errors, such as 1, differ in another.
    t.close(f"errors of gradients that are {', '.join(wrong)}", reported, expected, reveal=True)


@check(
    "02.6.large",
    task="02.6",
    points=1,
    calls=("grad_check",),
    sole="Eq. (15) where students can see it; the hidden check measures the steps",
)
def large_coordinates_move_further(t):
    """Right gradients at coordinates of 1e8 have an error close to 0: steps follow Eq. (15)."""
    f, x = smooth(t.rng, 3)
    size = 1e8

    def stretched(at):
        value, gradient = f(np.asarray(at) / size)
        return value, gradient / size

    found = t.call("adapters.checked", stretched, x * size, returns=VERDICT)
    where = ", ".join(f"{number:.1e}" for number in x * size)
    t.close(
        f"error of a right gradient at x = ({where})",
        found,
        0.0,
        ACCEPTED,
        reveal=True,
        hint="the step of Eq. (15) grows with the coordinate",
    )


@check("02.6.not_finite", task="02.6", points=1, calls=("grad_check",))
def not_a_number_is_refused(t):
    """What is not finite gives infinity, and a constant's gradient of zero the error 0."""
    f, x = smooth(t.rng, 3)
    finite = "ask whether all numbers are finite before you compare"
    for bad in (np.nan, np.inf):
        found = t.call(
            "adapters.checked",
            lambda x, bad=bad: (f(np.asarray(x))[0], np.array([bad, 0.0, 0.0])),
            x,
            returns=VERDICT,
        )
        t.require(found == np.inf, f"{bad} in the gradient does not give infinity", hint=finite)
    found = t.call("adapters.checked", lambda _: (np.nan, np.ones(3)), x, returns=VERDICT)
    t.require(found == np.inf, "a value that is not a number does not give infinity", hint=finite)
    found = t.call("adapters.checked", lambda _: (1.0, np.zeros(3)), x, returns=VERDICT)
    t.require(
        found == 0.0,
        "a constant's gradient of zero does not give 0",
        hint="with both lengths zero there is nothing to divide by",
    )


# >>> hidden
@check(
    "02.6.scale",
    task="02.6",
    points=1,
    calls=("grad_check",),
    visibility="hidden",
    sole="the steps themselves, and gradients of 1e-9",
    battery=[
        Subject(
            "adapters.checked", checked_place, lambda _: VERDICT, tolerance=EXACT, has_right=False
        )
    ],
)
def large_and_small_numbers(t):
    """Coordinates of 1e8 and gradients of 1e-9 are judged like others; steps follow Eq. (15)."""
    f, x = smooth(t.rng, 3)
    x[2] = 0.0
    moves = []

    def stretched(size, height, factor):
        def g(at):
            at = np.asarray(at)
            moves.append(np.abs(at - x * size))
            value, gradient = f(at / size)
            return height * value, factor * height * gradient / size

        return g

    for size, height in ((np.array([1e8, 1.0, 1.0]), 1.0), (np.ones(3), 1e-9)):
        moves.clear()
        found = t.call("adapters.checked", stretched(size, height, 1.0), x * size, returns=VERDICT)
        where = f"x of {size[0]:g}, f of {height:g}"
        t.require(0.0 <= found <= SMALL, f"right, but refused: {where}")
        steps = STEP * np.maximum(1.0, np.abs(x * size))
        t.close("the steps of Eq. (15)", np.max(moves, 0) / steps, np.ones(3), STEPS)
        found = t.call("adapters.checked", stretched(size, height, 1.1), x * size, returns=VERDICT)
        t.require(not 0.0 <= found <= SMALL, f"wrong, but accepted: {where}")


# <<< hidden
