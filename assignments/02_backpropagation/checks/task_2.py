"""Task 02.2, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, away, gate, gates, require_slopes

check = checks_for(calls=("Value.maximum",), tolerance=EXACT)


@check("02.2.routes", points=4, sole="names the gate; whole graphs fail too")
def the_larger_input_takes_all(t):
    """maximum has the larger value, and only the larger input gets a local derivative."""
    a = away(t.rng, 0.5, 3.0, 8)
    b = a + away(t.rng, 0.5, 1.0, 8)
    found = gates(t, "max", a, b)
    t.close("values of maximum", found["values"], np.maximum(a, b), reveal=True)
    require_slopes(t, "max", a, b)


@check("02.2.tie", points=3, sole="says that only ties are wrong")
def a_tie_is_settled(t):
    """At a tie the second input gets the derivative; finite differences would give 1/2 each."""
    x = float(t.rng.uniform(1.5, 3.0))
    found = gate(t, "max", x, x)
    t.close("local derivatives at a tie", found["slopes"], [0.0, 1.0], reveal=True)
    found = gate(t, "max", x, same=True)
    t.close("local derivative of maximum(x, x)", found["slopes"].sum(), 1.0, reveal=True)
