"""Task 02.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Record, Subject, Tolerance, checks_for

from ..common import DIFFERENCES, EXACT, ordered
from ..task_5 import complex_step, evaluate, random_program, trusted_program

check = checks_for(calls=("backward",), visibility="hidden")

ANALYTIC = Tolerance(
    1e-9, "complex steps have no truncation: 2.5e-15 was the worst of 300 graphs, five engines each"
)


def expressions(t, n):
    """n programs, the same for all n, and three inputs of each at random.

    No gradient cancels to rounding errors.
    """
    programs, inputs, rng = [], [], np.random.default_rng(n)
    while len(programs) < n:
        program, x = random_program(rng, 3, 8)
        x = x * (1 + 1e-3 * t.rng.uniform(-1.0, 1.0, 3))
        if np.abs(complex_step(program, x)).max() > 1e-3:
            programs.append(program)
            inputs.append(x)
    return programs, inputs


def values_and_gradients(n):
    """What `adapters.run_graphs` returns for these."""
    return Record({"values": Array((n,)), "gradients": Items(*[Array((3,))] * n)})


def derived(_, programs, inputs):
    """What is right: the values, and complex-step derivatives."""
    pairs = list(zip(programs, inputs, strict=True))
    values = np.array([evaluate(program, x)[-1] for program, x in pairs])
    return {"values": values, "gradients": [complex_step(program, x) for program, x in pairs]}


@check(
    "02.5.random",
    points=4,
    tolerance=ANALYTIC,
    sole="fifty expressions, against finite differences and complex steps of ours",
    battery=[
        Subject("adapters.run_graphs", expressions, values_and_gradients, right=derived, large=100)
    ],
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
        t.close("gradients against finite differences", got, differences, DIFFERENCES)
        t.close("gradients", got, exact, ANALYTIC)


@check("02.5.chain", points=2, tolerance=EXACT, seconds=20.0)
def a_long_chain_backward(t):
    """backward passes a chain of 50,000 values."""
    slope = float(1.0 + t.rng.uniform(1e-6, 1e-5))
    found = t.call("adapters.chain", 50_000, slope, True, returns=ordered(50_000))
    t.close("gradient of the first value", found["gradient"], slope**49_999, ANALYTIC)
