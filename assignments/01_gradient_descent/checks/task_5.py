"""Task 01.5, public checks."""

import numpy as np
from photograd_course.grading import Array, asks, checks_for

from .common import EXACT

check = checks_for(calls=("adam",), tolerance=EXACT)


def scripted(gradients):
    """A gradient that returns the given rows in turn, and the list of points of its calls."""
    rows, asked = iter(gradients), []

    def grad(x):
        asked.append(np.array(x))
        row = next(rows, None)
        if row is None:
            raise RuntimeError(f"grad was called more than {len(gradients)} times: once a step")
        return row

    return asks(grad, Array(np.shape(gradients)[1:], finite=False), name="grad"), asked


@check(
    "01.5.constant",
    points=3,
    sole="arithmetic that a student can do by hand: all corrections cancel",
    hint="With a constant gradient m_hat = g and v_hat = g^2 in every step, Eq. (21).",
)
def a_constant_slope_gives_steps_of_length_tau(t):
    """For a linear function every step is tau g / (|g| + eps), however steep the plane is."""
    g = np.array([1e3, -1.0, 1e-3, -1e-7]) * t.rng.uniform(1.0, 2.0, 4)
    n, tau = 12, 0.05
    x = t.call("adam", lambda _: g, np.zeros(4), tau, n, returns=Array((n + 1, 4)))
    expected = -tau * g / (np.abs(g) + 1e-8) * np.arange(n + 1)[:, None]
    t.close("the points", x, expected)


# The gradients of the handout's table, and the points that they lead to from (0, 0), by Eqs. (16)
# to (20) in 40 decimal digits.
TRACE_GRADIENTS = np.array([[1.0, 0.0], [-2.0, 0.0], [0.5, 4.0], [3.0, -1.0], [-1.0, 0.5]])
TRACE_POINTS = np.array(
    [
        [0.0, 0.0],
        [-0.099999999000000010, 0.0],
        [-0.063389646527924912, 0.0],
        [-0.049720580326178274, -0.063881359663375460],
        [-0.089130569565123351, -0.100544142564580310],
        [-0.107348211388094751, -0.137879953828913628],
    ]
)


@check(
    "01.5.trace",
    points=5,
    sole="the five steps that the handout prints, so that a student can find the first wrong",
    hint="Print m, v, m_hat and v_hat for each of the five steps beside the table.",
)
def five_steps_agree_with_the_table(t):
    """Five steps with the gradients of the handout's table lead where the table says."""
    grad, asked = scripted(TRACE_GRADIENTS)
    x = t.call("adam", grad, np.zeros(2), 0.1, 5, returns=Array((6, 2)))
    t.close("the points", x, TRACE_POINTS, reveal=True)
    t.close("the points at which the gradient is taken", np.array(asked), TRACE_POINTS[:5])
