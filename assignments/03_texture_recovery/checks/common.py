"""Helpers for the checks of several tasks."""

from photograd_course.grading import Array, Items, Number, Tolerance
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


def sample(t, T, uv):
    """Samples (N, C) of the texture T (H, W, C) at uv (N, 2)."""
    return t.call("bilinear_sample", T, uv, returns=Array((len(uv), T.shape[2])))


def scatter(t, shape, uv, g):
    """The adjoint of `sample`: the gradient (H, W, C) of a texture (H, W) from those of samples."""
    returns = Array((*shape, g.shape[1]))
    return t.call("bilinear_sample_adjoint", shape, uv, g, returns=returns)


def loss_and_grad(t, T, uv, target):
    """The loss, and its gradient with respect to T."""
    returns = Items(Number(), Array(T.shape), names=("L", "d_T"))
    return t.call("loss_and_grad", T, uv, target, returns=returns)
