"""Right answers of the generated questions; `reference` is the solution."""

import math

import numpy as np


def last_point(reference, curvature, reach, start, steps):
    """Where a run on f(x) = curvature / 2 (x - 1)^2 ends."""
    points, _, _ = reference.gd_1d(
        lambda x: 0.5 * curvature * (x - 1.0) ** 2,
        lambda x: curvature * (x - 1.0),
        start,
        reach / curvature,
        int(steps),
    )
    return float(points[-1])


def first_broken_step(reference, tau, beta2):
    """The first step of Adam without the second bias correction; eps is too small to matter."""
    del reference
    return tau / math.sqrt(1.0 - beta2)


def largest_stable_step(reference, a, b, c):
    """2 / lambda_max of the Hessian [[a, b], [b, c]]."""
    del reference
    return 2.0 / float(np.linalg.eigvalsh(np.array([[a, b], [b, c]]))[-1])


def distance_down_the_plane(reference, beta, tau, slope):
    """Distance of `momentum` after 20 steps for a linear function."""
    points = reference.momentum(lambda _: np.array([slope]), np.zeros(1), tau, beta, 20)
    distance = float(-points[-1, 0])
    lengths = math.fsum(tau * slope * (1.0 - beta**k) / (1.0 - beta) for k in range(1, 21))
    if not math.isclose(distance, lengths, rel_tol=1e-9):
        raise ValueError("the solution disagrees with Eq. (14)")
    return distance
