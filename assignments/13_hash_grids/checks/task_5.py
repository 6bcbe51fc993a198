"""Task 13.5, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for

from .common import EXACT

check = checks_for(calls=("adam_rows",), tolerance=EXACT)
NAMES = ("table", "m", "v")


def stepped(t, *given):
    """(table, m, v) after a step of the submission."""
    part = Array(given[0].shape)
    spec = Items(part, part, part, names=NAMES)
    return t.call("adam_rows", *given, returns=spec)


def some_rows(t, count, features=2, share=0.5):
    """Derivatives (count, features), zero in some rows; in others only one of them is zero."""
    d = t.rng.uniform(0.2, 1.0, (count, features)) * t.rng.choice([-1.0, 1.0], (count, features))
    d[t.rng.random(count) > share] = 0.0
    d[0], d[1], d[2] = 0.0, 0.5, 0.5
    d[2, 0] = 0.0
    return d


@check(
    "13.5.first",
    points=1,
    hint="handout, equation (13): both means are divided by 1 - beta^k",
    sole="a closed form: the first step has the length of the learning rate",
)
def the_first_step_has_one_length(t):
    """The first step of a row has the length of the learning rate, however small its derivative."""
    table, d = t.rng.uniform(-1.0, 1.0, (9, 2)), some_rows(t, 9)
    for size in (1.0, 1e-6, 1e-11):
        zero = np.zeros((9, 2))
        got, _, _ = stepped(t, table, size * d, zero, zero, 1, 0.1)
        t.close(
            f"the step for derivatives of size {size:g}",
            got - table,
            -0.1 * size * d / (np.abs(size * d) + 1e-15),
            reveal=True,
            hint="handout, equation (13): eps is 1e-15, and is added outside of the root",
        )


@check(
    "13.5.untouched",
    points=3,
    hint="handout, equation (14): a row all of whose derivatives are 0 keeps table, m and v",
    sole="bit for bit, what must not move",
)
def unused_rows_stay(t):
    """Rows without a derivative stay as they are, to the last bit, moments included."""
    shape = (12, 3)
    start = [
        t.rng.uniform(low, high, shape) for low, high in ((-1.0, 1.0), (-0.1, 0.1), (0.1, 0.2))
    ]
    d = some_rows(t, 12, 3)
    still = ~d.any(axis=1)
    after = stepped(t, start[0], d, *start[1:], 7, 0.1)
    for name, before, got in zip(NAMES, start, after, strict=True):
        t.require(bool((got[still] == before[still]).all()), f"{name}: an unused row has changed")
        moved = (got[~still] != before[~still]).all(axis=1)
        t.require(
            bool(moved.all()),
            f"{name}: a row with a derivative stays as it was",
            hint="a row counts as used if any of its derivatives is not 0, and then moves whole",
        )
    kept = t.call("adapters.kept_by_adam", start[0], d, *start[1:], 7, 0.1, returns=Array((4,)))
    for name, same in zip(("table", "d_table", "m", "v"), kept, strict=True):
        t.require(
            bool(same),
            f"adam_rows has changed the array {name} that it was given",
            hint="change a copy: m = m.copy()",
        )


@check(
    "13.5.trace",
    points=2,
    hint="handout, equation (13): first the means, then the step; k is the given number",
    sole="several steps, by hand",
)
def a_trace_by_hand(t):
    """Three steps of one row, as computed by hand with scalars; the second step passes it over."""
    state = [np.array([[1.0], [2.0]]), np.zeros((2, 1)), np.zeros((2, 1))]
    x, mean, square = 1.0, 0.0, 0.0
    for k, d in ((1, 0.5), (2, 0.0), (3, -0.25)):
        state = stepped(t, state[0], np.array([[d], [1.0]]), *state[1:], k, 0.01)
        if d:
            mean, square = 0.9 * mean + 0.1 * d, 0.99 * square + 0.01 * d * d
            scale = np.sqrt(square / (1 - 0.99**k)) + 1e-15
            x -= 0.01 * mean / (1 - 0.9**k) / scale
        for name, got, right in zip(NAMES, state, (x, mean, square), strict=True):
            t.close(f"{name} after step {k}", got[0], np.array([right]), reveal=True)


@check(
    "13.5.leaves",
    points=1,
    hint="`finetune` is right once your function is",
    sole="leaves of section 1, trained with your function",
)
def leaves_learn_what_was_measured(t):
    """Fine-tuned leaves approach the mean of the values measured in them; the others stay."""
    leaf, start = np.array([[0, 0, 1, 1], [0, 0, 1, 1], [2, 3, 4, 4], [5, 6, 4, 4]]), 7
    start = t.rng.uniform(0.0, 1.0, (7, 2))
    points = t.rng.uniform(0.0, 0.5, (60, 2)) + np.array([[0.0, 0.0], [0.0, 0.5]]).repeat(30, 0)
    target = start[:1] + t.rng.uniform(0.1, 0.5, (60, 2))
    got = t.call("finetune", leaf, start, points, target, 80, 0.02, returns=Array((7, 2)))
    t.require(bool((got[2:] == start[2:]).all()), "a leaf without any point in it has changed")
    for k in range(2):
        mean = target[30 * k : 30 * k + 30].mean(axis=0)
        near = np.abs(got[k] - mean).max()
        t.require(near < 0.05, f"leaf {k} is {near:.3g} from the mean of its points")
