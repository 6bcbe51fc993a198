"""Task 02.3, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, away, gate, gates, require_slopes

check = checks_for(tolerance=EXACT)


@check("02.3.exp", points=3, calls=("Value.exp",), sole="names the gate; whole graphs fail too")
def the_exponential(t):
    """exp(0) = 1 and exp(log 7) = 7; its local derivative agrees with finite differences."""
    found = gates(t, "exp", np.log([1.0, 7.0]))
    t.close("values of exp", found["values"], [1.0, 7.0], reveal=True)
    require_slopes(t, "exp", t.rng.uniform(-2.0, 2.0, 6))


@check("02.3.log", points=3, calls=("Value.log",), sole="names the gate; whole graphs fail too")
def the_logarithm(t):
    """log 1 = 0 and log e = 1; its local derivative agrees with finite differences."""
    found = gates(t, "log", np.exp([0.0, 1.0]))
    t.close("values of log", found["values"], [0.0, 1.0], reveal=True)
    require_slopes(t, "log", t.rng.uniform(0.3, 3.0, 6))


@check("02.3.power", points=4, calls=("Value.__pow__",))
def powers(t):
    """Powers agree with finite differences, at negative numbers and at zero too."""
    for n in (2, 3, -1):
        require_slopes(t, "pow", away(t.rng, 0.5, 2.0, 5), np.full(5, float(n)))
    require_slopes(t, "pow", t.rng.uniform(0.5, 2.0, 5), t.rng.uniform(0.2, 0.9, 5))
    found = gate(t, "pow", 0.0, 1.0)
    t.close("local derivative of x**1 at 0", found["slopes"], [1.0, 0.0], reveal=True)
