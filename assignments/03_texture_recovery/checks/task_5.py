"""Task 03.5, public checks."""

import numpy as np
from photograd_course.grading import Array, CheckFailed, Items, Tolerance, agree, checks_for
from photograd_course.grading.adjoint_gate import matrix_of

from .common import CHAINED, loss_and_grad, sample

FIRST_STEP = Tolerance(
    1e-3, "40 iterations on gathered samples leave 1e-15, the nearest wrong one (step_whole) 0.053"
)


def recovered(shape, n):
    """Result of `recover_texture`."""
    parts = (Array(tuple(shape)), Array((n + 1,)), Array(tuple(shape[:2]), "bool"))
    return Items(*parts, names=("T", "losses", "unseen"))


def recover(t, T0, uv, target, n):
    """`recover_texture`; what comes back in another form is told about the form."""
    try:
        return t.call("recover_texture", T0, uv, target, n, returns=recovered(T0.shape, n))
    except CheckFailed as failure:
        advice = "three values: T, losses (of T0, of T after each step: n + 1), unseen (bool)"
        failure.details.setdefault("advice", advice)
        raise


EARLIER = ("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad", "largest_curvature")

check = checks_for(calls=("recover_texture",), needs=EARLIER)


@check(
    "03.5.step",
    points=3,
    tolerance=FIRST_STEP,
    hint="handout, equations (14) and (15)",
    sole="tests the first step only",
)
def the_first_step(t):
    """One step goes against the gradient, by 0.95 of the largest stable step."""
    shape = (5, 4, 2)
    uv, T0 = t.rng.uniform(0.0, 1.0, (150, 2)) ** 2, t.rng.uniform(0.0, 1.0, shape)
    target = t.rng.uniform(0.0, 1.0, (150, 2))
    T, losses, _ = recover(t, T0, uv, target, 1)
    before, d_T = loss_and_grad(t, T0, uv, target)
    after, _ = loss_and_grad(t, T, uv, target)
    curvature = np.linalg.norm(matrix_of(t, "bilinear_sample", shape[:2], uv), 2) ** 2 * 2 / 150
    t.close("step times gradient", T0 - T, 0.95 * 2 / curvature * d_T)
    t.close("losses", losses, [before, after], CHAINED)


@check(
    "03.5.chain",
    points=2,
    tolerance=CHAINED,
    hint="the same step from first to last; losses of T0 to T",
    sole="counts steps and losses, whatever the step's length",
)
def steps_can_be_chained(t):
    """Seven steps are three steps and then four more, and their losses fall."""
    shape = (3, 5, 1)
    uv, T0 = t.rng.uniform(0.0, 1.0, (90, 2)), t.rng.uniform(0.0, 1.0, shape)
    target = t.rng.uniform(0.0, 1.0, (90, 1))
    seven = recover(t, T0, uv, target, 7)
    three = recover(t, T0, uv, target, 3)
    four = recover(t, three[0], uv, target, 4)
    none = recover(t, T0, uv, target, 0)
    t.close("T after 0 steps", none[0], T0)
    t.close("T after 3 + 4 steps", four[0], seven[0])
    t.close("losses", np.concatenate([three[1][:3], four[1]]), seven[1])
    t.require(bool((np.diff(seven[1]) < 0).all()), "the loss must fall with each step")


@check(
    "03.5.start",
    points=1,
    hint="often T0 itself is written into, or given back: copy it first",
    sole="what students can run; hidden checks find its mistakes as well",
)
def the_start_is_left_alone(t):
    """A second fit from the same array T0 finds what the first one found."""
    shape = (4, 3, 2)
    uv, T0 = t.rng.uniform(0.0, 1.0, (60, 2)), t.rng.uniform(0.0, 1.0, shape)
    target = t.rng.uniform(0.0, 1.0, (60, 2))
    once = recover(t, T0, uv, target, 2)
    again = t.call("adapters.recover_again", T0, uv, target, 2, returns=recovered(shape, 2))
    t.require(agree(again, once), "a second fit from the same T0 ends elsewhere")


@check(
    "03.5.unseen",
    points=2,
    hint="which texels does any sample give weight? that does not depend on values",
    sole="tests what no measurement reaches",
)
def unseen_texels_stay(t):
    """Texels without any sample keep their value to the last bit, and are reported."""
    shape = (6, 5, 2)
    uv, T0 = t.rng.uniform(0.0, 0.55, (40, 2)), t.rng.uniform(0.0, 1.0, shape)
    fits = sample(t, T0, uv)
    nowhere = ~matrix_of(t, "bilinear_sample", shape[:2], uv).any(axis=0).reshape(shape[:2])
    for target in (t.rng.uniform(0.0, 1.0, (40, 2)), fits):
        T, _, unseen = recover(t, T0, uv, target, 3)
        t.require(bool((T[nowhere] == T0[nowhere]).all()), "a texel without samples has changed")
        t.require(
            bool((unseen == nowhere).all()),
            f"unseen: {int(unseen.sum())} texels marked, {int(nowhere.sum())} expected, "
            f"{int((unseen != nowhere).sum())} differ",
        )
