"""Task 02.1, public checks."""

from photograd_course.grading import checks_for

from .common import EXACT, away, gate, gates, require_slopes

check = checks_for(calls=("Value.__add__", "Value.__mul__"))


@check(
    "02.1.values",
    points=2,
    tolerance=EXACT,
    sole="tells a wrong value from a wrong local derivative",
)
def sums_and_products_have_their_value(t):
    """Sums and products have the right value, with a plain number on either side too."""
    a, b = away(t.rng, 0.5, 3.0, 6), away(t.rng, 0.5, 3.0, 6)
    for op, right in (("add", a + b), ("radd", a + b), ("mul", a * b), ("rmul", a * b)):
        found = gates(t, op, a, b)
        t.close(f"values of {op}", found["values"], right, reveal=True)


@check("02.1.slopes", points=4, sole="names the gate; whole graphs fail too")
def slopes_of_sums_and_products(t):
    """A sum and a product store the local derivative of each input (against finite differences)."""
    a, b = away(t.rng, 0.5, 3.0, 6), away(t.rng, 4.0, 6.0, 6)
    for op in ("add", "mul"):
        require_slopes(t, op, a, b)


@check(
    "02.1.square",
    points=3,
    tolerance=EXACT,
    sole="the same value on both sides; the worked graph fails too, for its x * x",
)
def the_same_value_twice(t):
    """For x + x the local derivatives sum to 2, for x * x to 2 x."""
    x = float(t.rng.uniform(1.5, 3.0))
    found = gate(t, "add", x, same=True)
    t.close("local derivative of x + x", found["slopes"].sum(), 2.0, reveal=True)
    found = gate(t, "mul", x, same=True)
    t.close("local derivative of x * x", found["slopes"].sum(), 2 * x, reveal=True)
