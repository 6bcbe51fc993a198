"""Task 11.5, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import EXACT
from ..task_5 import lit


def among(t, n):
    """Arguments of `probe_irradiance`, for n points."""
    return (
        t.rng.uniform(-1, 1, (2, 3, 1, 9, 2)),
        t.rng.uniform(-0.5, 3, (n, 3)),
        unit_vectors(t.rng, n),
    )


@hidden_check(
    "11.5.hidden",
    points=2,
    calls=("probe_irradiance",),
    needs=("sh_basis",),
    tolerance=EXACT,
    sole="the same mistakes at unseen probes",
    battery=[Subject("probe_irradiance", among, lambda n: Array((n, 2)), rows=(1, 2))],
)
def irradiance_among_random_probes(t):
    """Irradiance is right among random probes, for each degree, one probe wide grids included."""
    for degree, shape in (
        (0, (2, 2, 2)),
        (2, (3, 1, 4)),
        (3, (1, 5, 2)),
        (4, (2, 3, 3)),
        (1, (12, 9, 7)),
    ):
        probes = t.rng.uniform(-1.0, 1.0, (*shape, (degree + 1) ** 2, 2))
        p, n = t.rng.uniform(-0.5, 4.0, (12, 3)), unit_vectors(t.rng, 12)
        right = t.reference.probe_irradiance(probes, p, n)
        t.close(f"irradiance, degree {degree}", lit(t, probes, p, n), right)
