"""Task 10.3, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    is_the_transpose,
    require_zero_for_zero,
)

# Evidence: worst of the solution and the alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(1e-11, "right ones differ by 1e-15, wrong ones by 1e-2 or more")

check = checks_for(calls=("sample_sparse_adjoint",), tolerance=EXACT)
GATE = Tolerance(1e-6, "finite differences leave 1e-9, wrong ones are off by 1e-2 or more")


def some_samples(t, count, samples, missing=0.3):
    """(row, weight), both (8, samples), with voxels that are missing; the last row is read too."""
    row = t.rng.integers(0, count, (8, samples))
    row[t.rng.random(row.shape) < missing] = -1
    row[0, 0], row[1, 0] = count - 1, -1
    weight = t.rng.uniform(0.0, 1.0, (8, samples))
    return row, weight / weight.sum(axis=0)


def back(t, count, row, weight, g):
    return t.call(
        "sample_sparse_adjoint", count, row, weight, g, returns=Array((count, *g.shape[1:]))
    )


@check(
    "10.3.transpose",
    points=4,
    hint="handout, equation (10): the same weights as in the forward pass, from sample to voxel",
    sole="the definition of an adjoint",
)
def the_adjoint_is_the_transpose(t):
    """<S x, g> = <x, S* g> for any values x and any g; rows that occur twice are summed."""
    # The weights of a sample sum to 1: a voxel that is all eight corners gets the whole g.
    g = np.repeat(t.rng.uniform(0.5, 0.9, (5, 1)), 2, axis=1)
    weight = t.rng.uniform(0.1, 1.0, (8, 5))
    weight /= weight.sum(axis=0)
    got, whole = back(t, 3, np.ones((8, 5), np.int64), weight, g)[1, 0], g[:, 0].sum()
    t.require(
        got > 0.999 * whole,
        f"a voxel that five samples read, with weights that sum to 1, gets {got:.6g}; "
        f"the samples have {whole:.6g}",
        hint="often: `d[row] += ...`, which keeps only the last contribution to a row that occurs "
        "twice; use `np.add.at`",
    )
    for count, samples, channels in ((6, 9, 4), (40, 15, 1), (1, 3, 2)):
        row, weight = some_samples(t, count, samples)
        x, g = t.rng.uniform(-1, 1, (count, channels)), t.rng.uniform(-1, 1, (samples, channels))
        d_values = back(t, count, row, weight, g)
        forth = t.call("sample_sparse", x, row, weight, returns=Array((samples, channels)))
        is_the_transpose(t, "<x, S* g>", x, forth, g, d_values)
    require_zero_for_zero(t, {"values": back(t, count, row, weight, 0 * g)})


@check(
    "10.3.missing",
    points=4,
    hint="row -1 means that there is no voxel; as an index it means the last one",
    sole="what a voxel that does not exist gets, and who must not get it instead",
)
def a_missing_voxel_gets_nothing(t):
    """What belongs to absent voxels goes nowhere: other voxels get what they got before."""
    count, samples = 5, 8
    row, weight = some_samples(t, count, samples, 0.0)
    row[1, 0] = 0
    g = t.rng.uniform(0.5, 1.5, (samples, 2))
    whole = back(t, count, row, weight, g)
    less = back(t, count, np.where(row == 2, -1, row), weight, g)
    t.require(not less[2].any(), "a voxel that no sample reads must get 0")
    keep = np.array([0, 1, 3, 4])
    t.close("d_values without voxel 2", less[keep], back(t, count, row, weight, g)[keep])
    none = back(t, count, np.full((8, samples), -1), weight, g)
    t.require(not none.any(), "no sample reads a voxel: all derivatives must be 0")
    t.require(bool(whole.any()), "d_values is zero although samples read voxels")
    empty = back(t, 0, np.full((8, 2), -1), weight[:, :2], g[:2])
    t.require(empty.shape == (0, 2), "without any voxel there is no derivative")


@check(
    "10.3.picture",
    points=4,
    tolerance=GATE,
    hint="loss_and_grad is right once your function is the transpose of sample_sparse",
    sole="the derivative of a picture, by finite differences",
)
def the_picture_agrees_with_differences(t):
    """Moving one value of one voxel moves the loss as the derivative through your function says."""
    wanted = t.rng.random((6, 7)) < 0.6
    wanted[0] = True
    row, weight = some_samples(t, 9, int(wanted.sum()))
    samples = (wanted, t.rng.uniform(0.1, 0.3, 6), row, weight)
    values, target = t.rng.uniform(0.3, 1.0, (9, 4)), t.rng.uniform(0.0, 1.0, (6, 3))
    answer = Items(Number(), Array((9, 4)), names=("loss", "d_values"))
    got = t.call("loss_and_grad", values, samples, target, returns=answer)

    def forward(p):
        both = np.concatenate([p["color"], p["sigma"][:, None]], axis=1)
        return t.call("loss_and_grad", both, samples, target, returns=answer)[0]

    point = {"color": values[:, :3], "sigma": values[:, 3]}
    slopes = {"color": got[1][:, :3], "sigma": got[1][:, 3]}
    agrees_with_finite_differences(t, slopes, forward, point, np.asarray(1.0), GATE)
