"""Task 15.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, agree, checks_for

from .common import EXACT, SCENE, spread

check = checks_for(calls=("densify",), needs=("covariance",), tolerance=EXACT)


def denser(t, scene, grad2d, seed, max_count, count, adapter="densify"):
    """Result of `densify`, as a dict and the sources."""
    parts = [Array((count, *scene[name].shape[1:])) for name in SCENE]
    got = t.call(
        f"adapters.{adapter}",
        scene,
        grad2d,
        seed,
        max_count,
        returns=Items(*parts, Array((count,)), names=(*SCENE, "source")),
    )
    return dict(zip(SCENE, got[:5], strict=True)), got[5]


def eight(rng):
    """Faint or not, small or large, above the threshold or not: (scene, pressure)."""
    scene = {
        "means": rng.normal(size=(8, 3)),
        "quats": rng.normal(size=(8, 4)),
        "log_scales": np.log(0.03) + rng.uniform(-0.2, 0.2, (8, 3)),
        "opacity_logits": rng.uniform(-1.0, 3.0, 8),
        "colors": rng.uniform(0.0, 1.0, (8, 3)),
    }
    # Row 2: the longest scale is above SMALL = 0.06, the mean of the three below.
    scene["log_scales"][[2, 3, 7], rng.integers(0, 3, 3)] += [1.0, 2.0, 2.0]
    scene["opacity_logits"][[0, 4]] = -5.0
    return scene, np.array([0.9, 3, 5, 1, 0, 8, 1.9, 4]) / 1000


@check(
    "15.6.rows",
    points=2,
    hint="handout, section 6: first those that stay, then clones, then parts twice; work on copies",
    sole="asks which rows there are, and nothing of their values",
)
def who_stays_and_who_is_new(t):
    """Pruned ones go, small chosen ones are cloned, large chosen ones split, in a fixed order."""
    scene, grad2d = eight(t.rng)
    got, source = denser(t, scene, grad2d, 1, 100, 10)
    rows = [1, 3, 5, 6, 1, 5, 2, 7, 2, 7]
    t.close("colors", got["colors"], scene["colors"][rows], reveal=True)
    t.close("quats", got["quats"], scene["quats"][rows])
    t.close("source", source, [1, 3, 5, 6, -1, -1, -1, -1, -1, -1], reveal=True)
    again = denser(t, scene, grad2d, 1, 100, 10, adapter="densify_again")
    t.require(
        agree(again, (got, source)), "called again with the same arrays it gives another answer"
    )


@check(
    "15.6.values",
    points=2,
    hint="handout, equations (19) and (20). log-scales: minus log(SHRINK); means: B times the "
    "random numbers, B of the original; parts keep its opacity",
    sole="tests the values of new rows",
)
def clones_keep_the_middle_and_parts_are_drawn(t):
    """Two clones cover as one did; parts are smaller by 1.6, at points drawn from the whole."""
    scene, grad2d = eight(t.rng)
    seed = int(t.rng.integers(1 << 20))
    got, _ = denser(t, scene, grad2d, seed, 100, 10)
    rows, new = [1, 3, 5, 6, 1, 5, 2, 7, 2, 7], [6, 7, 8, 9]
    through = 1 / (1 + np.exp(got["opacity_logits"]))
    before = 1 / (1 + np.exp(scene["opacity_logits"][rows]))
    both = through.copy()
    both[[0, 2]] = through[[0, 2]] * through[[4, 5]]
    both[[4, 5]] = both[[0, 2]]
    t.close(
        "what rows let through (original and clone together; parts keep their opacity)",
        both,
        before,
        reveal=True,
    )
    t.close("opacity of a clone", through[[4, 5]], through[[0, 2]])
    scales = scene["log_scales"][rows]
    scales[new] -= np.log(1.6)
    t.close("log_scales", got["log_scales"], scales, reveal=True)
    t.close("means of the others", got["means"][:6], scene["means"][rows[:6]])
    whole = spread(t, scene["quats"][[2, 7, 2, 7]], scene["log_scales"][[2, 7, 2, 7]])
    off = got["means"][6:] - scene["means"][[2, 7, 2, 7]]
    draws = [
        np.linalg.solve(np.linalg.cholesky(each), d) for each, d in zip(whole, off, strict=True)
    ]
    expected = np.random.default_rng(seed).standard_normal((4, 3))
    t.close("points of parts, in standard deviations", np.stack(draws), expected, reveal=True)


@check(
    "15.6.most",
    points=1,
    hint="each chosen one makes one more; the highest statistics go first. Faint ones leave "
    "first: room is `max_count` minus the number that stay",
    sole="tests the budget only",
)
def never_more_than_most(t):
    """With room for two more, the two of the highest statistics are chosen; without, none."""
    scene, grad2d = eight(t.rng)
    got, source = denser(t, scene, grad2d, 1, 8, 8)
    t.close("colors", got["colors"], scene["colors"][[1, 3, 5, 6, 7, 5, 2, 2]], reveal=True)
    t.close("source", source, [1, 3, 5, 6, 7, -1, -1, -1], reveal=True)
    got, source = denser(t, scene, grad2d, 1, 5, 6)
    t.close("source without room", source, [1, 2, 3, 5, 6, 7], reveal=True)
    t.close(
        "logits without room", got["opacity_logits"], scene["opacity_logits"][[1, 2, 3, 5, 6, 7]]
    )
