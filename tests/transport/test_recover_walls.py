"""What the caption of docs/images/recover_walls.png says."""

from __future__ import annotations

import sys

from photograd.transport import PathTracer

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import recover_walls as walls


def test_the_right_wall_blames_the_left_one() -> None:
    scene = walls.room(20)
    target = PathTracer(scene).render(spp=256, seed=1, options=walls.PATH).mean
    _, pull = walls.pull_on_red(scene, target, 256)
    left, right = (walls.sees_wall(scene, x) for x in (-1.0, 1.0))
    assert min(left.sum(), right.sum()) > 10
    assert pull[left].sum() < 0 < pull[right].sum()
    assert (pull[left] < 0).mean() > 0.8
    assert (pull[right] > 0).mean() > 0.8
