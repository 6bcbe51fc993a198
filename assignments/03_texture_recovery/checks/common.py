"""Helpers for the checks of several tasks."""

from photograd_course.grading import Tolerance
from photograd_course.grading.generators import cell_centers

# Evidence: worst of the solution and three alternatives over several seeds, against the nearest of
# 55 named wrong solutions.
EXACT = Tolerance(
    1e-12, "right ones differ by at most 1.3e-15, the nearest wrong one (adjoint_wrap) by 0.024"
)
CHAINED = Tolerance(
    1e-10, "right ones differ by at most 5e-16, the nearest wrong one (steps_shrink) by 0.019"
)


def centers(shape):
    """Centers (u, v) of the texels of a texture (H, W), row by row: (H W, 2)."""
    return cell_centers(shape)[:, ::-1]
