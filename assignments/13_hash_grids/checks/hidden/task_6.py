"""Task 13.6, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, checks_for

from ..common import layout
from ..task_6 import CHAINED, EARLIER, small_case, trained

check = checks_for(
    calls=("train_hash_grid",), needs=EARLIER, tolerance=CHAINED, visibility="hidden"
)


def spec_of(n):
    """What `train_hash_grid` returns for n steps of the small case."""
    layers = Items(Array((5, 5)), Array((6, 2)))
    return Items(Array((29, 2)), layers, Array((n,)))


@check(
    "13.6.hidden",
    points=3,
    sole="the same mistakes in unseen cases",
    battery=[Subject("train_hash_grid", small_case, spec_of, sizes=(0, 1, 6), large=150)],
)
def training_in_random_cases(t):
    """Eight steps end where they should, in the plane and in space."""
    for D in (2, 3):
        given = small_case(t, 8, D)
        got, right = trained(t, *given), t.reference.train_hash_grid(*given)
        t.close(f"table, D = {D}", got[0], right[0])
        t.close(f"losses, D = {D}", got[2], right[2])
        for mine, theirs in zip(got[1], right[1], strict=True):
            t.close("decoder", mine, theirs)


def psnr(got, right):
    return -10 * np.log10(max(float(np.mean((got - right) ** 2)), 1e-30))


@check(
    "13.6.order",
    points=6,
    seconds=60.0,
    sole="the experiment: which of the two is better, and what sharing costs",
)
def the_hash_grid_wins_and_loses_gracefully(t):
    """At equal time 1 dB above a network or more; shrunk to its size, at most 5 dB less."""
    ref, steps = t.reference, 80
    points = ref.pixels(48)
    c = complex(-0.8, 0.156) + 0.05 * complex(*t.rng.uniform(-1.0, 1.0, 2))
    target = ref.julia(points, c)

    # A step of the network takes a fourth of the time, though it uses 20 times as many numbers.
    weights, octaves = ref.start_weights((22, 64, 64, 3), t.rng), 5
    batches = t.rng.integers(0, len(points), (4 * steps, 500))
    weights, _ = ref.train_network(points, target, batches, octaves, weights, 0.006)
    plain = psnr(ref.network(weights, ref.frequencies(points, octaves)), target)

    scores = []
    for most in (2**12, 2**10):
        levels = layout([6, 12, 24, 48], 2, most)
        table = t.rng.uniform(-1e-4, 1e-4, (int(levels[-1, 1] + levels[-1, 2]), 2))
        decoder = ref.start_weights((8, 16, 3), t.rng)
        given = points, target, batches[:steps], levels, table, decoder, 0.03
        table, decoder, _ = trained(t, *given)
        scores.append(psnr(ref.network(decoder, ref.encode(points, table, levels)), target))
    size = table.size + ref.numbers_per_point(decoder)
    t.require(size <= ref.numbers_per_point(weights), "the smaller table is not small enough")
    large, small = scores
    # Ten seeds: at least 2.3 dB more, 4.2 on average; shrunk by 3.4 dB at most.
    said = f"hash grid {large:.1f} dB, network {plain:.1f} dB at equal time, shrunk {small:.1f} dB"
    t.require(large >= plain + 1.0, f"{said}: threshold 1 dB more than the network")
    t.require(small >= large - 5.0, f"{said}: threshold 5 dB less when shrunk")
