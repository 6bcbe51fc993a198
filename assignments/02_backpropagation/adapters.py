"""Between the checks and your engine: graphs come as lists of numbers, and numbers go back.

Runs beside your `engine.py`; do not change or submit it. A node is known by its
place in a list; inputs stand first, and every node after those that it uses.
"""

import engine
import numpy as np

READS_ALLOWED = 500_000  # a walk that has gone so far need not be waited for


class TooManyReads(Exception):
    """`inputs` was read far more often than there are nodes."""


class MalformedValue(TypeError):
    """A gate of the engine returned no `Value`, or one whose `inputs` cannot be read."""


def required_value(op, result):
    """`result` of the gate `op`, if it is a Value whose inputs are pairs (value, local derivative).

    Raises:
        MalformedValue: it is not; says what it is, and what was expected.
    """
    if not isinstance(result, engine.Value):
        raise MalformedValue(f"{op}: expected a Value as result, got {type(result).__name__}")
    pairs, wanted = result.inputs, "inputs must be a tuple of pairs (value, local derivative)"
    if isinstance(pairs, (tuple, list)) and all(map(is_pair, pairs)):
        return result
    if is_pair(pairs):
        raise MalformedValue(
            f"{op}: {wanted}, yours is one pair: ((x, du_dx)) is (x, du_dx); "
            "put a comma after the pair: ((x, du_dx),)"
        )
    if not isinstance(pairs, (tuple, list)):
        raise MalformedValue(f"{op}: {wanted}, yours is a {type(pairs).__name__}")
    got = ", ".join(each_kind(part) for part in pairs)
    raise MalformedValue(f"{op}: {wanted}, yours holds {got}")


def is_pair(part):
    """Whether this is (Value, number)."""
    return (
        isinstance(part, (tuple, list))
        and len(part) == 2
        and isinstance(part[0], engine.Value)
        and isinstance(part[1], (int, float, np.number))
    )


def each_kind(part):
    """The types in an entry of `inputs`, in words."""
    if isinstance(part, (tuple, list)):
        return "(" + ", ".join(type(inner).__name__ for inner in part) + ")"
    return type(part).__name__


def apply(op, a, b):
    """One gate of the engine: `a` a Value, `b` a Value or a plain number (None where not used)."""
    if op == "exp":
        return a.exp()
    if op == "log":
        return a.log()
    if op == "pow":
        return a**b
    if op == "max":
        return a.maximum(b)
    if op == "radd":
        return b + a
    if op == "rmul":
        return b * a
    return {"add": a.__add__, "mul": a.__mul__, "sub": a.__sub__, "div": a.__truediv__}[op](b)


def gate(op, a, b=None, same=False):
    """One gate alone: its value, and the local derivative that it stored for each of its inputs.

    Args:
        op: name of the gate.
        a: a float, the first input.
        b: a float, the second input; a plain number for "pow"; None where there is none.
        same: a is both inputs, as in x * x.

    Returns:
        {"value", "slopes": (2,), "strangers"}: local derivatives of a and b, summed over uses, and
        the number of recorded inputs that are neither of the two.
    """
    first = engine.Value(a)
    plain = b is None or op in {"pow", "radd", "rmul"}
    second = first if same else b if plain else engine.Value(b)
    result = required_value(op, apply(op, first, second))
    slopes, strangers = np.zeros(2), 0
    for node, slope in result.inputs:
        if node is first:
            slopes[0] += slope
        elif node is second:
            slopes[1] += slope
        else:
            strangers += 1
    return {"value": result.data, "slopes": slopes, "strangers": strangers}


def gates(op, a, b, same=False):
    """`gate` for arrays a (N,) and b (N,) or None: values (N,), local derivatives (N, 2)."""
    second = [None] * len(a) if b is None else [float(number) for number in b]
    done = [gate(op, float(x), y, same) for x, y in zip(a, second, strict=True)]
    values = np.array([each["value"] for each in done])
    return {"values": values, "slopes": np.array([each["slopes"] for each in done])}


def build(program, inputs):
    """The nodes of a program: Values of the inputs, then one for each instruction [op, a, b].

    `a` is the place of a node; `b` too, or a number for "pow", "radd" and "rmul", or None.
    """
    nodes = [engine.Value(number) for number in inputs]
    for op, a, b in program:
        plain = b is None or op in {"pow", "radd", "rmul"}
        nodes.append(required_value(op, apply(op, nodes[a], b if plain else nodes[b])))
    return nodes


def run_graph(program, inputs, seed=1.0):
    """Values (M,) of all nodes of a program, and gradients (M,) of the last by each of them."""
    nodes = build(program, inputs)
    engine.backward(nodes[-1], seed)
    values = np.array([node.data for node in nodes])
    return {"values": values, "gradients": np.array([node.grad for node in nodes])}


def run_graphs(programs, inputs):
    """`run_graph` of each program: last values (P,), gradients of the inputs as a list."""
    last, gradients = [], []
    for program, given in zip(programs, inputs, strict=True):
        nodes = build(program, given)
        engine.backward(nodes[-1])
        last.append(nodes[-1].data)
        gradients.append(np.array([node.grad for node in nodes[: len(given)]]))
    return {"values": np.array(last), "gradients": gradients}


def forward_values(program, points):
    """Last values (P,) of a program at points (P, N)."""
    return np.array([build(program, point)[-1].data for point in points])


def by_hand(edges):
    """Nodes made without gates; edges[k] lists [place of the input, slope] for each use."""
    nodes = []
    for uses in edges:
        nodes.append(engine.Value(1.0, tuple((nodes[k], slope) for k, slope in uses)))
    return nodes


def places(order, nodes):
    """Where each value of an order stands among M nodes.

    Returns:
        Places (2 M + 1,), -1 for a value that is none of the nodes, and -2 behind the end.
    """
    place = {id(node): k for k, node in enumerate(nodes)}
    found = [place.get(id(node), -1) for node in order]
    end = [-2] * (2 * len(nodes) + 1)
    return np.array((found + end)[: len(end)])


def order_of(edges, root):
    """`topo_order` of node `root` of a graph made by hand, as `places` has it."""
    nodes = by_hand(edges)
    return places(engine.topo_order(nodes[root]), nodes)


def order_again(edges, root):
    """`order_of` for the second call with the same graph."""
    nodes = by_hand(edges)
    engine.topo_order(nodes[root])
    return places(engine.topo_order(nodes[root]), nodes)


def run_by_hand(edges, orders, seeds, default_seed=False):
    """`backward` on a graph made by hand, once for each order, one after another.

    Args:
        edges: see `by_hand`.
        orders: places in the order that `topo_order` is to give, so that a mistake there does not
            count here; the last is the root.
        seeds: one for each.
        default_seed: leave the seed out.

    Returns:
        Gradients (calls, M) after each call.
    """
    nodes = by_hand(edges)
    own_order, after = engine.topo_order, []
    try:
        for order, seed in zip(orders, seeds, strict=True):
            given = [nodes[k] for k in order]
            engine.topo_order = lambda _, given=given: list(given)
            if default_seed:
                engine.backward(given[-1])
            else:
                engine.backward(given[-1], seed)
            after.append([node.grad for node in nodes])
    finally:
        engine.topo_order = own_order
    return np.array(after)


def chain(n, slope=1.0, with_backward=False):
    """A chain of n nodes, each with one input.

    Returns:
        {"order": see `places`; all -3 where Python's limit on the depth of calls was met,
        "gradient": of the first node, 0 without `with_backward`}.
    """
    nodes = [engine.Value(1.0)]
    for _ in range(n - 1):
        nodes.append(engine.Value(1.0, ((nodes[-1], slope),)))
    if with_backward:
        original, engine.topo_order = engine.topo_order, lambda _: list(nodes)
        try:
            engine.backward(nodes[-1])
        finally:
            engine.topo_order = original
        return {"order": places(nodes, nodes), "gradient": nodes[0].grad}
    try:
        return {"order": places(engine.topo_order(nodes[-1]), nodes), "gradient": 0.0}
    except RecursionError:
        return {"order": np.full(2 * n + 1, -3), "gradient": 0.0}


class Counter:
    """Counts how often inputs are read and how often nodes are compared with one another."""

    def __init__(self):
        self.reads = self.comparisons = 0

    def read(self):
        """One more time inputs are read."""
        self.reads += 1
        self.stop_where_too_many()

    def compare(self):
        """One more comparison."""
        self.comparisons += 1
        self.stop_where_too_many()

    def stop_where_too_many(self):
        if self.reads + self.comparisons > READS_ALLOWED:
            raise TooManyReads(f"{READS_ALLOWED} reads and comparisons")


class Counted(tuple):
    """Inputs of a node; reading them is counted."""

    counter = None

    def __iter__(self):
        self.counter.read()
        return super().__iter__()

    def __getitem__(self, place):
        self.counter.read()
        return super().__getitem__(place)


def work(edges, root):
    """How often `topo_order` reads inputs and compares nodes; READS_ALLOWED and one more at most.

    Returns:
        {"reads", "comparisons", "too_deep": whether Python's limit on the depth of calls was met}.
    """
    counter = Counter()

    class Watched(engine.Value):
        def __eq__(self, other):
            counter.compare()
            return self is other

        __hash__ = object.__hash__

    class Reads(Counted):
        pass

    Reads.counter = counter
    nodes = []
    for uses in edges:
        nodes.append(Watched(1.0, Reads((nodes[k], slope) for k, slope in uses)))
    counter.reads = counter.comparisons = 0
    too_deep = False
    try:
        engine.topo_order(nodes[root])
    except TooManyReads:
        pass
    except RecursionError:
        too_deep = True
    return {"reads": counter.reads, "comparisons": counter.comparisons, "too_deep": too_deep}


def checked(f, x):
    """The error that `grad_check` finds in a function of the grader's, which may be infinite."""
    return float(engine.grad_check(f, x))


def checked_twice(f, x):
    """The errors (2,) of two such calls in a row, with the same array x."""
    return np.array([checked(f, x), checked(f, x)])
