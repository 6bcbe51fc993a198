"""Task 10.3, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..task_3 import EXACT, back, some_samples


def gathered(t, n):
    """Arguments of `sample_sparse_adjoint`, for n samples."""
    return 5, *some_samples(t, 5, n), t.rng.uniform(-1, 1, (n, 3))


@hidden_check(
    "10.3.hidden",
    points=3,
    calls=("sample_sparse_adjoint",),
    tolerance=EXACT,
    sole="the same mistakes at unseen samples",
    battery=[Subject("sample_sparse_adjoint", gathered, lambda _: Array((5, 3)))],
)
def the_adjoint_at_random_samples(t):
    """The adjoint is right for random samples, many of one voxel and none of another."""
    for count, samples, channels in ((7, 30, 4), (1, 5, 1), (90, 40, 3), (2000, 40, 60)):
        row, weight = some_samples(t, count, samples)
        g = t.rng.uniform(-1, 1, (samples, channels))
        right = t.reference.sample_sparse_adjoint(count, row, weight, g)
        t.close("d_values", back(t, count, row, weight, g), right)
