"""Task 10.5, public checks."""

from dataclasses import dataclass

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance, agree, checks_for
from photograd_course.grading.failures import CheckFailed, StudentFailure

from .common import EARLIER, FAITHFUL, looking, lump, same_voxels

CHAINED = Tolerance(1e-7, "right ones differ by 1e-12, wrong ones by 1e-3 or more")
STEPS = (*EARLIER, "sample_sparse_adjoint")

check = checks_for(calls=("fit_sparse",), needs=STEPS)


@dataclass(frozen=True)
class Fit:
    """Result of `fit_sparse` after so many steps; its voxels cannot be counted beforehand."""

    steps: int

    def require(self, value, where):
        """Raise CheckFailed unless `value` is one."""
        if not isinstance(value, list) or len(value) != 3:
            raise CheckFailed(f"{where}: expected a tuple of 3: voxels, values, losses")
        Array((None, 3), "i8").require(value[0], f"{where}, voxels")
        Array((len(value[0]), 4)).require(value[1], f"{where}, values")
        Array((self.steps,)).require(value[2], f"{where}, losses")


def fitted(t, *given, function="fit_sparse"):
    """`fit_sparse` of n, voxels, values, rays, target, rounds, steps and more."""
    return t.call(function, *given, returns=Fit(given[5] * given[6]))


def small_case(t, n=8, views=3, size=5):
    """n, voxels, values, rays, target."""
    voxels, values = lump(t, n, 0.6)
    rays = looking(t, views, size)
    order = t.rng.permutation(len(voxels))
    return n, voxels[order], values[order], rays, t.rng.uniform(0.0, 1.0, (rays.shape[1], 3))


BETWEEN = "often the list is made anew after the last round: between two rounds only, see (14)"


def require_same_list(t, got, voxels):
    t.require(
        np.array_equal(got, voxels),
        "one round must leave the list of voxels as it is",
        hint=BETWEEN,
    )


def rates():
    return np.array([0.05, 0.05, 0.05, 0.4])


@check(
    "10.5.first",
    points=2,
    tolerance=CHAINED,
    hint="handout, equation (13): one Adam for all four channels, then sigma clamped to 0",
    sole="tests the first steps only",
)
def the_first_steps(t):
    """Adam's first step has the length RATES against the gradient; no sigma goes below 0."""
    n, voxels, values, rays, target = small_case(t)
    values[::2, 3] /= 20
    values[1::2, 2], target[:, 2] = values[1::2, 2] / 20, 0.0  # some color falls below 0
    parts = Items(Number(), Array(values.shape), names=("loss", "d_values"))
    loss, d = t.call("adapters.gradient", n, voxels, values, rays, target, returns=parts)
    got = fitted(t, n, voxels, values, rays, target, 1, 1, 0.5, 0)
    moved = values - rates() * d / (np.abs(d) + 1e-10)
    for part in (moved[:, :3], moved[:, 3]):
        t.require(bool((part < 0).any() and (part > 0).any()), "the test case is not informative")
    moved[:, 3] = np.maximum(moved[:, 3], 0)
    require_same_list(t, got[0], voxels)
    t.close("values", got[1], moved)
    hint = "record the loss that comes with each derivative, that of the values before the step"
    t.close("losses", got[2], np.array([loss]), hint=hint)
    loss, second = t.call("adapters.gradient", n, voxels, got[1], rays, target, returns=parts)
    m = (0.09 * d + 0.1 * second) / (1 - 0.9**2)
    v = (0.0099 * d**2 + 0.01 * second**2) / (1 - 0.99**2)
    then = fitted(t, n, voxels, values, rays, target, 1, 2, 0.5, 0)
    moved = got[1] - rates() * m / (np.sqrt(v) + 1e-10)
    moved[:, 3] = np.maximum(moved[:, 3], 0)
    t.close("values after two steps", then[1], moved)


def next_start(t, n, voxels, values, rays, threshold, grow):
    """(voxels, values, kept) that a round after these begins with; kept: those there before."""
    parts = Items(Array((None, 3), "i8"), Array((None,), "i8"), names=("voxels", "rows"))
    following, rows = t.call(
        "adapters.next_start", n, voxels, values, rays, threshold, grow, returns=parts
    )
    t.require(
        len(rows) == len(following) and bool((rows < len(voxels)).all()),
        "find_rows gives rows that no voxel has",
    )
    kept = rows >= 0
    t.require(
        0 < kept.sum() < len(voxels),
        f"after a round {kept.sum()} of {len(voxels)} voxels stay; some should go, not all",
        hint="are the values right? 10.5.first looks at them",
    )
    start = np.tile(np.array([0.5, 0.5, 0.5, 0.1]), (len(following), 1))
    start[kept] = values[rows[kept]]
    return following, start, kept


def two_rounds(t, *given):
    """`fitted`, where two rounds without steps have passed before."""
    try:
        return fitted(t, *given)
    except StudentFailure as failure:
        if failure.reason != "raised":
            raise
        advice = "often Adam or samples of the first round are taken, which are of other voxels"
        details = {"advice": advice, "exception": failure.private}  # which public checks may show
        if failure.line is not None:
            details["line"] = list(failure.line)
        text = f"{failure.text}; two rounds without steps passed"
        raise CheckFailed(text, details) from None


@check(
    "10.5.chain",
    points=4,
    tolerance=CHAINED,
    hint="handout, equations (14) and (15): between rounds prune, grow, carry over (for voxels "
    "that are pruned and grow again, too), and start Adam anew",
    sole="carries values over from one list of voxels to the next",
)
def rounds_can_be_chained(t):
    """Two rounds are one round, a new list with the old values in it, and one round more."""
    n, voxels, values, rays, target = small_case(t)
    for threshold, grow in ((0.05, 1), (0.02, 0)):
        one = fitted(t, n, voxels, values, rays, target, 1, 2, threshold, grow)
        require_same_list(t, one[0], voxels)
        # Without steps nothing happens but (14) and (15).
        following, start, kept = next_start(t, n, voxels, values, rays, threshold, grow)
        carried = fitted(t, n, voxels, values, rays, target, 2, 0, threshold, grow)
        same_voxels(t, "voxels after a round without steps", n, carried[0], following)
        hint = "often values stand with other voxels: look up their rows in a table of the old ones"
        t.close("values carried over", carried[1][kept], start[kept], FAITHFUL, hint=hint)
        if not kept.all():
            hint = "handout, equation (15): new voxels begin as START"
            t.close("values of new voxels", carried[1][~kept], start[~kept], FAITHFUL, hint=hint)
        following, start, kept = next_start(t, n, voxels, one[1], rays, threshold, grow)
        both = two_rounds(t, n, voxels, values, rays, target, 2, 2, threshold, grow)
        hint = "take the shares of the newest values, those after the last step of the round"
        same_voxels(t, "voxels of the second round", n, both[0], following, hint)
        two = fitted(t, n, following, start, rays, target, 1, 2, threshold, grow)
        t.close("losses", both[2], np.concatenate([one[2], two[2]]))
        t.close("values", both[1], two[1])
    none = fitted(t, n, voxels, values, rays, target, 2, 0, threshold, grow)
    t.require(len(none[2]) == 0, "without steps there are no losses")


@check(
    "10.5.start",
    points=1,
    hint="often an array of the start is written into, or given back: copy it first",
    sole="what students can run; a hidden check finds its mistake as well",
)
def the_start_is_left_alone(t):
    """A second fit from the same arrays finds what the first one found."""
    given = (*small_case(t), 2, 2, 0.01, 1)
    same = agree(fitted(t, *given, function="adapters.fit_again"), fitted(t, *given))
    t.require(same, "a second fit from the same start ends elsewhere")
