"""Task 02.5, hidden checks."""

from photograd_course.grading import Array, Items, Record, Tolerance, checks_for

from ..common import DIFFERENCES, EXACT, ordered
from ..task_5 import evaluate, trusted_program

check = checks_for(calls=("backward",), visibility="hidden")

ANALYTIC = Tolerance(
    1e-9, "complex steps have no truncation: 2.5e-15 was the worst of 300 graphs, five engines each"
)


@check(
    "02.5.random",
    points=4,
    sole="fifty expressions, against finite differences and complex steps of ours",
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
