"""Checks of assignment 01: descent in one and many dimensions."""

from __future__ import annotations

import math

import numpy as np
from photograd_course.grading import (
    Array,
    CheckFailed,
    Items,
    Number,
    Subject,
    Tolerance,
    Truth,
    asks,
    check,
)

# Right answers: solution and alternatives with six secrets; wrong ones: all mutants with two.
EXACT = Tolerance(1e-12, "right answers differ by at most 3e-15, wrong ones by 4e-9 or more")
DIFFERENCE = Tolerance(1e-11, "right answers differ by at most 1.3e-14, wrong ones by 0.15 or more")


class Patient:
    """A function that ends an endless search: it answers 2,000 times, where 1,100 suffice."""

    def __init__(self, f):
        self.f, self.count = f, 0

    def __call__(self, x):
        """The value at x."""
        self.count += 1
        if self.count > 2000:
            raise CheckFailed(
                "backtracking: the search does not end: f was called more than 2,000 times",
                {"advice": "does tau shrink in the loop, and does Eq. (22) contain tau?"},
            )
        return self.f(x)


def walk(n, *axes):
    """What a walk of n steps returns: points, values, verdict."""
    names = ("the points", "the values", "the verdict")
    return Items(Array((n + 1, *axes)), Array((n + 1,)), Truth(), names=names)


def on_points(count, f, grad):
    """f and its gradient, which take nothing but arrays of shape (count,)."""
    spec = Array((count,), finite=False)
    return asks(f, spec, name="f"), asks(grad, spec, name="grad")


def rotated_bowl(rng, curvatures):
    """f, its gradient and the eigenvectors (columns) for given eigenvalues of the Hessian."""
    vectors, _ = np.linalg.qr(rng.normal(size=(len(curvatures), len(curvatures))))
    hessian = vectors @ np.diag(curvatures) @ vectors.T
    f, grad = lambda x: float(0.5 * x @ hessian @ x), lambda x: hessian @ x
    return *on_points(len(hessian), f, grad), vectors


def scripted(gradients):
    """A gradient that hands out the given rows in turn, and the list of points it was asked at."""
    rows, asked = iter(gradients), []

    def grad(x):
        asked.append(np.array(x))
        row = next(rows, None)
        if row is None:
            raise RuntimeError(f"grad was called more than {len(gradients)} times: once a step")
        return row

    return asks(grad, Array(np.shape(gradients)[1:], finite=False), name="grad"), asked


# 01.1 ------------------------------------------------------------------------------------------


@check(
    "01.1.quadratic",
    task="01.1",
    points=4,
    calls=("numeric_derivative",),
    tolerance=DIFFERENCE,
    sole="what students can run; hidden checks find its mistakes as well",
    hint="Move one coordinate at a time, both ways, and come back: Eq. (3).",
)
def central_differences_are_exact_for_quadratics(t):
    """For a quadratic in four variables the result is the gradient, however long the step."""
    _, slope_of, _ = rotated_bowl(t.rng, t.rng.uniform(0.5, 4.0, 4))
    b = t.rng.uniform(-2.0, 2.0, 4)
    for eps in (0.5, 0.01):
        x = t.rng.uniform(-2.0, 2.0, 4)
        got = t.call(
            "numeric_derivative",
            lambda y: float(0.5 * y @ slope_of(y) + b @ y),
            x,
            eps,
            returns=Array((4,)),
        )
        t.close(f"gradient with eps = {eps}", got, slope_of(x) + b)


@check(
    "01.1.order",
    task="01.1",
    points=4,
    calls=("numeric_derivative",),
    sole="the order is what the handout is about; a wrong order fails a hidden check, too",
    hint="Halve eps: the error should fall to a quarter, Eq. (4).",
)
def the_error_falls_with_the_square_of_the_step(t):
    """Error against eps has slope 1.9 to 2.1 on logarithmic axes, for exp and for sin."""
    steps = np.geomspace(1e-1, 1e-3, 7)
    for f, df, name in ((math.exp, math.exp, "exp"), (math.sin, math.cos, "sin")):
        x = float(t.rng.uniform(0.3, 1.0))
        errors = [
            abs(
                float(
                    t.call(
                        "numeric_derivative",
                        lambda y, f=f: f(float(y[0])),
                        np.array([x]),
                        float(eps),
                        returns=Array((1,)),
                    )[0]
                )
                - df(x)
            )
            for eps in steps
        ]
        t.require(min(errors) > 0.0, f"{name}: with these steps no formula of order 2 is exact")
        slope = float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
        t.require(1.9 <= slope <= 2.1, f"{name}: the slope is {slope:.2f}, expected 1.9 to 2.1")


# 01.2 ------------------------------------------------------------------------------------------


@check(
    "01.2.rate",
    task="01.2",
    points=4,
    calls=("gd_1d",),
    tolerance=EXACT,
    sole="what students can run; hidden checks find its mistakes as well",
    hint="Each step multiplies the distance to the minimum by the same factor, Eq. (6).",
)
def a_parabola_contracts_by_one_factor(t):
    """On a parabola the distance to the minimum is multiplied by 1 - tau lambda in each step."""
    curvature, center = float(t.rng.uniform(0.5, 3.0)), float(t.rng.uniform(-2.0, 2.0))
    for reach in (0.3, 1.6):
        x0, n = center + float(t.rng.uniform(0.5, 0.9)), 12
        x, loss, wrong = t.call(
            "gd_1d",
            lambda y: 0.5 * curvature * (y - center) ** 2,
            lambda y: curvature * (y - center),
            x0,
            reach / curvature,
            n,
            returns=walk(n),
        )
        distance = (x0 - center) * (1.0 - reach) ** np.arange(n + 1)
        t.close("the points", x, center + distance)
        t.close("the values", loss, 0.5 * curvature * (np.asarray(x) - center) ** 2)
        t.require(not wrong, "the verdict is True for a walk that converges")


@check(
    "01.2.verdict",
    task="01.2",
    points=3,
    calls=("gd_1d",),
    sole="what students can run; hidden checks find its mistakes as well",
    hint="Compare the last value with the first, Eq. (8), not the points.",
)
def the_verdict_changes_at_the_bound(t):
    """Just below tau = 2 / lambda the walk closes in, just above it flies off and says so."""
    curvature, center = float(t.rng.uniform(0.5, 3.0)), float(t.rng.uniform(3.0, 5.0))

    def go(reach, x0, n=30):
        return t.call(
            "gd_1d",
            lambda y: 0.5 * curvature * (y - center) ** 2,
            lambda y: curvature * (y - center),
            x0,
            reach / curvature,
            n,
            returns=walk(n),
        )

    for x0 in (center - 0.5, center + 0.5):
        x, _, wrong = go(1.99, x0)
        t.require(abs(x[-1] - center) < 0.45, "below the bound the walk must close in")
        t.require(not wrong, "below the bound the verdict must be False")
        x, _, wrong = go(2.01, x0)
        t.require(abs(x[-1] - center) > 0.55, "above the bound the walk must fly off")
        t.require(wrong, "above the bound the verdict must be True")
    _, _, wrong = go(0.5, center)
    t.require(not wrong, "a walk that starts in the minimum and stays has not gone wrong")
    _, _, wrong = go(2.1, center + 0.5, 1)
    t.require(wrong, "a single step that leads higher has gone wrong")
    # Two half parabolas, the left one steeper: down from 0.5 to -0.1, then up again to 0.38.
    _, _, wrong = t.call(
        "gd_1d",
        lambda y: y * y if y > 0.0 else 4.0 * y * y,
        lambda y: 2.0 * y if y > 0.0 else 8.0 * y,
        0.5,
        0.6,
        2,
        returns=walk(2),
    )
    t.require(not wrong, "the walk ends lower than it began, so the verdict should be False")


# 01.3 ------------------------------------------------------------------------------------------


@check(
    "01.3.rates",
    task="01.3",
    points=4,
    calls=("gd_nd",),
    tolerance=EXACT,
    hint="Take the gradient once, at the old point, and move all coordinates with it.",
    sole="what students can run; hidden checks find its mistakes as well",
)
def each_eigenvector_has_a_factor_of_its_own(t):
    """On a bowl the part along each eigenvector is multiplied by 1 - tau lambda_i."""
    curvatures = t.rng.uniform([0.2, 1.0, 2.0], [0.6, 1.5, 3.0])
    f, grad, vectors = rotated_bowl(t.rng, curvatures)
    start, tau, n = t.rng.uniform(1.0, 2.0, 3), 1.7 / float(curvatures[2]), 15
    x, loss, wrong = t.call("gd_nd", f, grad, vectors @ start, tau, n, returns=walk(n, 3))
    parts = start * (1.0 - tau * curvatures) ** np.arange(n + 1)[:, None]
    t.close("the points", x, parts @ vectors.T)
    t.close("the values", loss, 0.5 * parts**2 @ curvatures)
    t.require(not wrong, "the verdict is True for a walk that converges")


@check(
    "01.3.stability",
    task="01.3",
    points=4,
    calls=("gd_nd",),
    hint="If 01.3.rates fails too, repair that first. The verdict compares the last value with the "
    "first, Eq. (8).",
)
def the_largest_curvature_decides(t):
    """The verdict changes at tau = 2 / lambda_max, and looks at the last and the first value."""
    curvatures = np.array([0.1, 1.0, 4.0])
    f, grad, vectors = rotated_bowl(t.rng, curvatures)
    start = vectors @ t.rng.choice([-1.0, 1.0], 3)
    for reach, fate in ((1.99, False), (2.01, True)):
        x, loss, wrong = t.call("gd_nd", f, grad, start, reach / 4.0, 200, returns=walk(200, 3))
        steep = np.abs(np.asarray(x) @ vectors[:, 2])
        at, way = f"at tau = {reach} / lambda_max", "grow" if fate else "shrink"
        t.require(
            (steep[-1] > steep[0]) == fate,
            f"{at} the distance along the steepest direction should {way} over the walk, "
            f"yours goes from {steep[0]:.3g} to {steep[-1]:.3g}",
        )
        t.require(wrong == fate, f"{at} the verdict should be {fate}, yours is {not fate}")
        t.require(
            (loss[-1] > loss[0]) == fate,
            f"{at} the values should {way} over the walk, "
            f"yours go from {loss[0]:.3g} to {loss[-1]:.3g}",
        )
    # It has begun to rise, but has not come back to where it began.
    start = vectors @ np.array([1.0, 1.0, 1e-3])
    _, _, wrong = t.call("gd_nd", f, grad, start, 2.1 / 4.0, 40, returns=walk(40, 3))
    t.require(not wrong, "the walk ends lower than it began, so the verdict should be False")
    _, _, wrong = t.call("gd_nd", f, grad, np.zeros(3), 0.1, 2, returns=walk(2, 3))
    t.require(not wrong, "a walk that starts in the minimum and stays has not gone wrong")
    _, _, wrong = t.call("gd_nd", f, grad, vectors[:, 2], 2.1 / 4.0, 1, returns=walk(1, 3))
    t.require(wrong, "a single step that leads higher has gone wrong")


# 01.4 ------------------------------------------------------------------------------------------


@check(
    "01.4.constant",
    task="01.4",
    points=4,
    calls=("momentum",),
    tolerance=EXACT,
    sole="arithmetic that a student can do by hand; the others need the walk to bend",
    hint="With a constant gradient the steps grow towards tau g / (1 - beta), Eq. (14).",
)
def a_constant_slope_leads_to_a_terminal_velocity(t):
    """Down a plane the k-th step is tau g (1 - beta^k) / (1 - beta) long."""
    g, x0 = t.rng.uniform(0.5, 2.0, 3) * t.rng.choice([-1.0, 1.0], 3), t.rng.uniform(-1.0, 1.0, 3)
    tau, beta, n = 0.1, float(t.rng.uniform(0.5, 0.9)), 30
    x = t.call("momentum", lambda _: g, x0, tau, beta, n, returns=Array((n + 1, 3)))
    lengths = (1.0 - beta ** np.arange(1, n + 1)) / (1.0 - beta)
    t.close("the steps", np.diff(x, axis=0), -tau * lengths[:, None] * g)


@check(
    "01.4.plain",
    task="01.4",
    points=3,
    calls=("momentum",),
    tolerance=EXACT,
    hint="With beta = 0 there is no memory: the walk is that of gradient descent.",
)
def without_memory_it_is_gradient_descent(t):
    """With beta = 0 a bowl contracts by 1 - tau lambda_i, as without momentum."""
    curvatures = t.rng.uniform(0.5, 2.0, 3)
    x0, tau, n = t.rng.uniform(1.0, 2.0, 3), 0.4, 10
    x = t.call("momentum", lambda y: curvatures * y, x0, tau, 0.0, n, returns=Array((n + 1, 3)))
    t.close("the points", x, x0 * (1.0 - tau * curvatures) ** np.arange(n + 1)[:, None])


# 01.5 ------------------------------------------------------------------------------------------


@check(
    "01.5.constant",
    task="01.5",
    points=3,
    calls=("adam",),
    tolerance=EXACT,
    sole="arithmetic that a student can do by hand: all corrections cancel",
    hint="With a constant gradient m_hat = g and v_hat = g^2 in every step, Eq. (21).",
)
def a_constant_slope_gives_steps_of_length_tau(t):
    """Down a plane every step is tau g / (|g| + eps), however steep the plane is."""
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
    task="01.5",
    points=5,
    calls=("adam",),
    tolerance=EXACT,
    sole="the five steps that the handout prints, so that a student can find the first wrong",
    hint="Print m, v, m_hat and v_hat for each of the five steps beside the table.",
)
def five_steps_agree_with_the_table(t):
    """Five steps with the gradients of the handout's table lead where the table says."""
    grad, asked = scripted(TRACE_GRADIENTS)
    x = t.call("adam", grad, np.zeros(2), 0.1, 5, returns=Array((6, 2)))
    t.close("the points", x, TRACE_POINTS, reveal=True)
    t.close("the points at which the gradient is taken", np.array(asked), TRACE_POINTS[:5])


# 01.6 ------------------------------------------------------------------------------------------


@check(
    "01.6.armijo",
    task="01.6",
    points=4,
    calls=("backtracking",),
    tolerance=EXACT,
    hint="The right-hand side of Eq. (22) falls with tau, along the direction you were given.",
)
def the_step_is_the_first_that_keeps_its_promise(t):
    """The step length satisfies Armijo's rule, and the one tried before it does not."""
    refused = 0
    for _ in range(8):
        f, grad, _ = rotated_bowl(t.rng, t.rng.uniform(0.5, 20.0, 3))
        x = t.rng.uniform(-2.0, 2.0, 3)
        d = -grad(x) * t.rng.uniform(0.3, 1.0, 3) - 0.1 * grad(x)
        if float(grad(x) @ d) >= 0.0:
            continue
        c, shrink = float(t.rng.uniform(0.2, 0.45)), float(t.rng.uniform(0.6, 0.9))
        tau = float(
            t.call("backtracking", Patient(f), grad, x, d, 1.0, c, shrink, returns=Number())
        )

        def keeps(tau, f=f, grad=grad, x=x, d=d, c=c):
            promised = tau * float(d @ grad(x))
            return f(d * tau + x) <= f(x) + c * promised

        t.require(tau > 0.0, "the step length must be positive")
        count = round(math.log(tau) / math.log(shrink))
        t.close("the step length, as a power of shrink", tau, shrink**count)
        t.require(keeps(shrink**count), "the step length breaks Armijo's rule")
        if count:
            refused += 1
            t.require(not keeps(shrink ** (count - 1)), "a longer step would have been accepted")
    t.require(refused >= 4, "too few steps were refused")
    # f(1) = -1/4 is the bound itself, in binary numbers without rounding.
    tau = t.call(
        "backtracking",
        Patient(lambda y: float(0.75 * y[0] ** 2 - y[0])),
        lambda y: 1.5 * y - 1.0,
        np.zeros(1),
        np.ones(1),
        1.0,
        0.25,
        0.5,
        returns=Number(),
    )
    t.require(float(tau) == 1.0, "a value that equals the bound is good enough")


@check(
    "01.6.refuses",
    task="01.6",
    points=2,
    calls=("backtracking",),
    hint="Raise ValueError unless the slope along d is negative; NaN is not negative.",
)
def a_direction_uphill_is_refused(t):
    """A direction that leads uphill, nowhere, or nobody knows where raises ValueError."""
    f, grad, vectors = rotated_bowl(t.rng, np.array([1.0, 3.0]))
    unknown, x = np.full(2, math.nan), vectors[:, 0]
    for case, slope_of, d in (
        ("d leads uphill", grad, x),
        ("d is zero", grad, np.zeros(2)),
        ("the gradient is NaN", lambda _: unknown, np.ones(2)),
    ):
        asked = Patient(f)
        try:
            t.refuses("backtracking", asked, slope_of, x, d, error="ValueError")
        except CheckFailed as failure:
            raise CheckFailed(f"{case}: {failure.text}", failure.details) from failure
        t.require(asked.count < 10, f"{case}: look at the slope before you search")


# >>> hidden
def cubics(t, n):
    """A function of n variables with a third derivative, where, and how far to move."""
    a = t.rng.uniform(0.5, 2.0, n)
    return lambda x: float(np.sum(a * x**3 - x**2)), t.rng.uniform(1.0, 2.0, n), 0.1


def bowls(t, n):
    """A bowl, its gradient and a start; of n variables, or of one."""
    a = t.rng.uniform(0.5, 2.0, max(n, 1))
    f, grad = lambda x: float(0.5 * x @ (a * x)), lambda x: a * x
    return *on_points(len(a), f, grad), t.rng.uniform(1.0, 2.0, len(a))


def left_domain(t, n):
    """What `gd_nd` takes, for n steps of which each ends where f is NaN."""

    def f(x):
        return float(np.sum(x - np.log(x))) if (x > 0.0).all() else math.nan

    return *on_points(2, f, lambda x: 1.0 - 1.0 / x), t.rng.uniform(1.15, 1.2, 2), 12.0, n


def refused(t, n):
    """What `backtracking` takes: n step lengths are refused."""
    x, reach = t.rng.uniform(1.0, 2.0, 3), float(t.rng.uniform(1.2, 1.8))
    return Patient(lambda y: float(0.5 * y @ y)), lambda y: y, x, -(2.0**n) * reach * x


FAR = (0, 1, 2, 200)  # steps: none, and more than any example takes


@check(
    "01.1.cubic",
    task="01.1",
    points=4,
    calls=("numeric_derivative",),
    visibility="hidden",
    tolerance=DIFFERENCE,
    hint="For a x^3 the result is 3 a x^2 + a eps^2 exactly: Eq. (4) has no further term.",
    battery=[Subject("numeric_derivative", cubics, lambda n: Array((n,)))],
)
def a_cubic_is_off_by_a_known_amount(t):
    """For a cubic the error is eps^2 times a sixth of the third derivative, exactly."""
    for eps in (1.0, 0.5):
        a, b = t.rng.uniform(0.5, 2.0, 2)
        x = np.array([float(t.rng.uniform(1.5, 3.0))])
        got = t.call(
            "numeric_derivative",
            lambda y, a=a, b=b: float(a * y[0] ** 3 + b * y[0]),
            x,
            eps,
            returns=Array((1,)),
        )
        excess = np.asarray(got) - 3.0 * a * x**2 - b
        t.close("the error", excess, np.array([a * eps**2]))


@check(
    "01.2.basins",
    task="01.2",
    points=3,
    calls=("gd_1d",),
    visibility="hidden",
    tolerance=Tolerance(1e-9, "right answers differ by 1.1e-15 at most, wrong ones by 1"),
    hint="Short steps stay in the valley where they began; a long one may jump out of it.",
    battery=[
        Subject(
            "gd_1d",
            lambda t, n: (math.cos, lambda x: -math.sin(x), float(t.rng.uniform(0.3, 3.0)), 0.3, n),
            walk,
            sizes=FAR,
        )
    ],
)
def the_walk_ends_in_the_predicted_valley(t):
    """With two valleys, start and step length decide in which one the walk ends."""
    tilt = float(t.rng.uniform(0.1, 0.3))  # f = (x^2 - 1)^2 + tilt x

    def f(x):
        return (x * x - 1.0) ** 2 + tilt * x

    def df(x):
        return 4.0 * x * (x * x - 1.0) + tilt

    left, hump, right = np.sort(np.roots([4.0, 0.0, -4.0, tilt]).real)
    for x0, end in ((hump - 0.1, left), (hump + 0.1, right), (-1.6, left), (1.5, right)):
        x, _, _ = t.call("gd_1d", f, df, float(x0), 0.05, 200, returns=walk(200))
        t.close(f"the end of a walk from {x0:.2f}", x[-1], end)
    # One long step over the hump: from 1.7 by -0.1 f'(1.7), about -1.3, to 0.4; twice that: across.
    x, _, _ = t.call("gd_1d", f, df, 1.9, 0.14, 200, returns=walk(200))
    t.close("the end of a walk that jumps", x[-1], t.reference.gd_1d(f, df, 1.9, 0.14, 200)[0][-1])


@check(
    "01.2.undefined",
    task="01.2",
    points=3,
    calls=("gd_1d",),
    visibility="hidden",
    hint="NaN > 1 is False: write the verdict so that NaN counts as gone wrong, Eq. (8).",
)
def nothing_is_not_better(t):
    """A walk that leaves the domain of the function has gone wrong."""

    def f(x):
        return x - math.log(x) if x > 0.0 else math.nan

    names = ("the points", "the values", "the verdict")
    spec = Items(Array((4,)), Array((4,), finite=False), Truth(), names=names)
    x0 = float(t.rng.uniform(1.15, 1.2))
    _, loss, wrong = t.call("gd_1d", f, lambda x: 1.0 - 1.0 / x, x0, 12.0, 3, returns=spec)
    t.require(bool(np.isnan(loss[-1])), "f is not defined where this walk must end")
    t.require(wrong, "the last value is NaN, so the verdict should be True")


@check(
    "01.3.contraction",
    task="01.3",
    points=4,
    calls=("gd_nd",),
    visibility="hidden",
    tolerance=Tolerance(
        1e-6,
        "over the last 20 steps the factor is right to 4e-16, so 2 % are not needed; "
        "wrong ones differ by 0.08 or more",
    ),
    hint="At the best step length each step multiplies the distance by Eq. (11), to the end.",
    battery=[
        Subject(
            "gd_nd",
            lambda t, n: (*bowls(t, n), 0.3, n),
            lambda n: walk(n, max(n, 1)),
            sizes=FAR,
            tolerance=EXACT,
        ),
        Subject(
            "gd_nd",
            left_domain,
            lambda n: Items(Array((n + 1, 2)), Array((n + 1,), finite=False), Truth()),
            sizes=(1, 2),
        ),
    ],
)
def the_condition_number_gives_the_rate(t):
    """At the best step length the distance shrinks by (kappa - 1) / (kappa + 1) a step."""
    for kappa in (5.0, 25.0):
        low = float(t.rng.uniform(0.5, 2.0))
        curvatures = low * np.array([1.0, 0.5 + 0.5 * kappa, kappa])
        f, grad, vectors = rotated_bowl(t.rng, curvatures)
        start, n = vectors @ t.rng.uniform(1.0, 2.0, 3), 75 if kappa < 10.0 else 150
        tau = 2.0 / (low + low * kappa)
        x, _, _ = t.call("gd_nd", f, grad, start, tau, n, returns=walk(n, 3))
        length = np.linalg.norm(np.asarray(x), axis=1)
        t.require(bool(length[-1] > 0.0), "the distance is still far above rounding here")
        t.close(
            f"factor per step, kappa = {kappa:g}",
            (length[n] / length[n - 20]) ** (1.0 / 20.0),
            (kappa - 1.0) / (kappa + 1.0),
        )


@check(
    "01.4.roots",
    task="01.4",
    points=5,
    calls=("momentum",),
    visibility="hidden",
    tolerance=Tolerance(1e-11, "right answers differ by 4e-15 at most, wrong ones by 0.2 or more"),
    hint="The gradient is taken at the point, not where the velocity would lead.",
    battery=[
        Subject(
            "momentum",
            lambda t, n: (*bowls(t, n)[1:], 0.3, 0.7, n),
            lambda n: Array((n + 1, max(n, 1))),
            sizes=FAR,
        )
    ],
)
def a_parabola_swings_as_two_roots_say(t):
    """On a bowl each part of the walk is a sum of two powers, damped waves among them."""
    curvatures = np.array([0.1, 1.0, 6.0]) * t.rng.uniform(0.9, 1.1, 3)
    x0, n = t.rng.uniform(1.0, 2.0, 3), 25
    tau, beta = 0.3, float(t.rng.uniform(0.6, 0.85))
    x = t.call("momentum", lambda y: curvatures * y, x0, tau, beta, n, returns=Array((n + 1, 3)))
    expected = np.empty((n + 1, 3))
    for i, curvature in enumerate(curvatures):
        first, second = np.roots([1.0, -(1.0 + beta - tau * curvature), beta]).astype(complex)
        weight = (1.0 - tau * curvature - second) / (first - second)
        powers = np.arange(n + 1)
        expected[:, i] = (x0[i] * (weight * first**powers + (1 - weight) * second**powers)).real
    t.close("the points", x, expected)


@check(
    "01.5.sums",
    task="01.5",
    points=6,
    calls=("adam",),
    visibility="hidden",
    tolerance=EXACT,
    hint="beta1, beta2 and eps are arguments; their defaults are only defaults.",
    battery=[
        Subject(
            "adam",
            lambda t, n: (*bowls(t, n)[1:], 0.1, n),
            lambda n: Array((n + 1, max(n, 1))),
            sizes=FAR,
        )
    ],
)
def random_gradients_are_weighted_as_they_should(t):
    """With other decays and random gradients the points are those of the sums, written out."""
    n, beta1, beta2, eps = 20, float(t.rng.uniform(0.5, 0.8)), float(t.rng.uniform(0.9, 0.98)), 1e-3
    gradients = t.rng.uniform(0.2, 1.0, (n, 3)) * t.rng.choice([-1.0, 1.0], (n, 3))
    x0 = t.rng.uniform(-1.0, 1.0, 3)
    grad, asked = scripted(gradients)
    got = t.call("adam", grad, x0, 0.1, n, beta1, beta2, eps, returns=Array((n + 1, 3)))
    steps = np.empty((n, 3))
    for k in range(n):
        age = np.arange(k, -1, -1)[:, None]  # of each gradient so far
        mean = np.sum(beta1**age * gradients[: k + 1], axis=0) / np.sum(beta1**age)
        square = np.sum(beta2**age * gradients[: k + 1] ** 2, axis=0) / np.sum(beta2**age)
        steps[k] = -0.1 * mean / (np.sqrt(square) + eps)
    t.close("the steps", np.diff(got, axis=0), steps)
    t.close("the points at which the gradient is taken", np.array(asked), got[:-1])


@check(
    "01.6.undefined",
    task="01.6",
    points=2,
    calls=("backtracking",),
    visibility="hidden",
    hint="Write the loop so that NaN is refused: `not value <= bound`.",
)
def a_step_out_of_the_domain_is_refused(t):
    """Where the function is NaN the step is too long."""

    def f(x):
        return float(x[0] - math.log(x[0])) if x[0] > 0.0 else math.nan

    x = np.array([float(t.rng.uniform(2.0, 3.0))])
    d = np.array([-4.0])
    tau = float(t.call("backtracking", Patient(f), lambda y: 1.0 - 1.0 / y, x, d, returns=Number()))
    t.require(tau > 0.0 and float(x[0] + tau * d[0]) > 0.0, "this step leaves the domain of f")
    t.require(f(x + tau * d) < f(x), "this step does not lead downhill")


# Iterations of the best of 120 fixed step lengths from 1e-3 to 30, until a millionth of the excess
# is left; tests/course/assignments/test_01.py counts them again.
FIXED_STEPS = {"bowl": 98, "valley": 244, "quartic": 23, "logistic": 6, "two walls": 30}


def five_functions():
    """Name to (f, gradient, start, minimum)."""
    hessian = np.array([[0.2, 0.0, 0.0], [0.0, 3.25, 2.75], [0.0, 2.75, 3.25]])  # 0.2, 0.5, 6
    data = np.random.default_rng(0).normal(size=(30, 3))
    data *= np.sign(data @ np.array([1.0, -2.0, 0.5]) + 0.5 * data[::-1, 0])[:, None]
    weights, walls = np.array([1.0, 2.0, 4.0]), np.array([1.0, 3.0])
    return {
        "bowl": (
            lambda x: float(0.5 * x @ hessian @ x),
            lambda x: hessian @ x,
            np.array([6.0, 2.0, 1.0]),
        ),
        "valley": (
            lambda x: float((1 - x[0]) ** 2 + 4 * (x[1] - x[0] ** 2) ** 2),
            lambda x: np.array(
                [-2 * (1 - x[0]) - 16 * x[0] * (x[1] - x[0] ** 2), 8 * (x[1] - x[0] ** 2)]
            ),
            np.array([-1.2, 1.0]),
        ),
        "quartic": (
            lambda x: float(np.sum(weights * x**2 / 2 + x**4 / 4)),
            lambda x: weights * x + x**3,
            np.array([3.0, -2.0, 1.0]),
        ),
        "logistic": (
            lambda x: float(np.mean(np.logaddexp(0, -data @ x)) + 0.05 * x @ x),
            lambda x: 0.1 * x - data.T @ np.exp(-np.logaddexp(0, data @ x)) / 30,
            np.array([-3.0, 3.0, -3.0]),
        ),
        "two walls": (
            lambda x: float(np.sum(np.logaddexp(walls * x, -walls * x)) + 0.05 * x @ x),
            lambda x: walls * np.tanh(walls * x) + 0.1 * x,
            np.array([2.0, -1.5]),
        ),
    }


def goal_of(name, f, x0):
    """The value at which a millionth of the excess over the minimum is left."""
    least = {
        "bowl": 0.0,
        "valley": 0.0,
        "quartic": 0.0,
        "logistic": LOGISTIC_MINIMUM,
        "two walls": 2.0 * math.log(2.0),
    }[name]
    return least + 1e-6 * (f(x0) - least)


LOGISTIC_MINIMUM = 0.5052239008227084  # where the gradient is 1e-15


@check(
    "01.6.descends",
    task="01.6",
    points=4,
    calls=("backtracking",),
    visibility="hidden",
    seconds=15.0,
    hint="Begin with the step length tau0 that you are given, also above 1.",
    battery=[
        Subject("backtracking", refused, lambda _: Number(), sizes=(0, 1, 40, 200), tolerance=EXACT)
    ],
)
def it_needs_no_tuning(t):
    """On five functions the loss never rises, in at most twice the steps of the best fixed tau."""
    for name, (*functions, x0) in five_functions().items():
        f, grad = on_points(len(x0), *functions)
        x, tau, goal, most = x0, 1.0, goal_of(name, f, x0), 2 * FIXED_STEPS[name]
        for _ in range(most):
            d = -grad(x)
            tau = float(t.call("backtracking", Patient(f), grad, x, d, 2.0 * tau, returns=Number()))
            t.require(f(x + tau * d) <= f(x), f"{name}: a step has raised the loss")
            x = x + tau * d
            if f(x) <= goal:
                break
        t.require(f(x) <= goal, f"{name}: not there after {most} steps")


# <<< hidden
