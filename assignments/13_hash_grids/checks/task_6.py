"""Task 13.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance, agree, checks_for

from .common import layout

CHAINED = Tolerance(1e-7, "right ones differ by 1e-12, wrong ones by 1e-3 or more")
EARLIER = ("hash_index", "encode", "encode_backward", "adam_rows")

check = checks_for(calls=("train_hash_grid",), needs=EARLIER, tolerance=CHAINED)


def start_of(t, levels):
    """(table, weights) at random."""
    table = t.rng.uniform(-0.5, 0.5, (int(levels[-1, 1] + levels[-1, 2]), 2))
    return table, [t.rng.uniform(-0.8, 0.8, size) for size in ((2 * len(levels) + 1, 5), (6, 2))]


def small_case(t, steps, D=2, batch=6):
    """points, target, batches, levels, table, weights, rate."""
    levels = layout([2, 5], D, 20)
    points, target = t.rng.uniform(0.0, 1.0, (15, D)), t.rng.uniform(0.0, 1.0, (15, 2))
    batches = t.rng.permuted(np.tile(np.arange(15), (steps, 1)), axis=1)[:, :batch]
    return points, target, batches, levels, *start_of(t, levels), 0.02


def trained(t, *given, function="train_hash_grid"):
    """(table, weights, losses) of the submission."""
    batches, table, weights = given[2], given[4], given[5]
    layers = Items(*(Array(w.shape) for w in weights))
    spec = Items(
        Array(table.shape), layers, Array((len(batches),)), names=("table", "weights", "losses")
    )
    return t.call(function, *given, returns=spec)


def derivatives(t, points, target, levels, table, weights):
    """(loss, d_table, d_weights) of a batch, with the submission's functions."""
    layers = Items(*(Array(w.shape) for w in weights))
    spec = Items(Number(), Array(table.shape), layers, names=("loss", "d_table", "d_weights"))
    return t.call("adapters.derivatives", points, target, levels, table, weights, returns=spec)


def adam(x, d, moments, k, rate, rows):
    """A step of Adam in some rows: (x, moments)."""
    m = np.where(rows, 0.9 * moments[0] + 0.1 * d, moments[0])
    v = np.where(rows, 0.99 * moments[1] + 0.01 * d * d, moments[1])
    length = rate * m / (1 - 0.9**k) / (np.sqrt(v / (1 - 0.99**k)) + 1e-15)
    return x - np.where(rows, length, 0.0), (m, v)


@check(
    "13.6.steps",
    points=4,
    hint="handout, equation (15): all derivatives of a step are taken at the same values, then "
    "the table and the decoder both move",
    sole="what a step is made of",
)
def each_step_is_made_of_your_functions(t):
    """Each of three steps moves the table and the decoder by Adam, from the batch's derivatives."""
    for D in (2, 3):
        given = small_case(t, 3, D)
        points, target, batches, levels, table, weights, rate = given
        state = [(0 * w, 0 * w) for w in (table, *weights)]
        losses = []
        for k, batch in enumerate(batches, 1):
            at = points[batch], target[batch], levels, table, weights
            loss, d_table, d_weights = derivatives(t, *at)
            losses.append(loss)
            used = np.asarray(d_table).any(axis=1)[:, None]
            table, state[0] = adam(table, d_table, state[0], k, rate, used)
            for i, d in enumerate(d_weights):
                weights = list(weights)
                weights[i], state[i + 1] = adam(weights[i], d, state[i + 1], k, rate, True)
            got = trained(t, *given[:2], batches[:k], *given[3:])
            t.close(f"losses of {k} steps, D = {D}", got[2], np.array(losses))
            t.close(f"table after {k} steps, D = {D}", got[0], table)
            for i, w in enumerate(weights):
                t.close(f"layer {i} of the decoder after {k} steps", got[1][i], w)


@check(
    "13.6.start",
    points=1,
    hint="often an array of the start is written into, or given back: copy it first",
    sole="what students can run; hidden checks find its mistakes as well",
)
def the_start_is_left_alone(t):
    """Training twice from the same arrays gives the same; without steps nothing changes."""
    given = small_case(t, 4)
    same = agree(trained(t, *given, function="adapters.train_again"), trained(t, *given))
    t.require(same, "a second training from the same start ends elsewhere")
    table, weights, _ = trained(t, *given[:2], given[2][:0], *given[3:])
    t.require(np.array_equal(table, given[4]), "without steps the table stays as it is")
    for mine, w in zip(weights, given[5], strict=True):
        t.require(np.array_equal(mine, w), "without steps the decoder stays as it is")


@check(
    "13.6.detail",
    points=2,
    seconds=60.0,
    hint="are encode and encode_backward right for several levels, and is every step's batch used?",
    sole="the whole: a pattern that only the fine levels can hold",
)
def a_fine_pattern_is_learned(t):
    """Waves that only the fine levels can hold are learned within 120 steps, to 20 dB."""
    levels, n = layout([4, 16, 32], 2, 2000), 48
    v, u = np.divmod(np.arange(n * n), n)
    points = (np.stack([u, v], axis=1) + 0.5) / n
    waves = np.prod(np.sin(12 * np.pi * points), axis=1)
    target = 0.5 + 0.4 * np.stack([waves, waves**2], axis=1)
    table, _ = start_of(t, levels)
    weights = [t.rng.normal(0.0, 0.6, (7, 16)), t.rng.normal(0.0, 0.4, (17, 2))]
    batches = t.rng.integers(0, n * n, (120, 400))
    losses = trained(t, points, target, batches, levels, 0.02 * table, weights, 0.05)[2]
    score = -10 * np.log10(max(float(np.mean(losses[-5:])), 1e-30))
    # Thirty seeds: 23.5 dB at worst, 31 on average; a constant has 14.
    t.require(score >= 20.0, f"{score:.1f} dB after 120 steps: threshold 20 dB")
