"""Pictures without their background: premultiplied radiance, and the samples that alpha counts."""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, ShapeError
from photograd.transport import Accumulation, Material, Medium, PathOptions, PathTracer, Scene

from tests.transport.media_scenes import fog_box
from tests.transport.scenes import GRAY, stage
from tests.transport.test_textures import wall

SPP = 16
OPTIONS = PathOptions(max_depth=3)
SCENES: dict[str, Callable[[], Scene]] = {
    "stage": lambda: stage(GRAY, sky=0.5),
    "card": lambda: wall(Material("lambert", {"albedo": [0.3, 0.4, 0.5], "alpha": 0.4}), {}),
    "fog": lambda: fog_box(Medium([0.3] * 3, [0.8] * 3)),
}


def without_background(tracer: PathTracer) -> tuple[Accumulation, Any]:
    sums, hits = Accumulation.empty(8, 8), np.zeros((8, 8))
    for _ in range(2):  # the counts are added up like the sums
        tracer.add_samples(sums, SPP // 2, seed=1, options=OPTIONS, hits=hits)
    return sums, hits


@pytest.mark.parametrize("name", SCENES)
def test_only_samples_that_see_the_background_lose_it(name: str) -> None:
    tracer = PathTracer(SCENES[name](), dtype=np.float64)
    part, hits = without_background(tracer)
    assert part.count == SPP
    assert (hits > 0).any()
    assert (hits < SPP).any()
    # The samples that are missing, one by one, are those that meet nothing on their way.
    lost, missed = np.zeros((8, 8, 3)), np.zeros((8, 8))
    for pixel, sample in np.ndindex(64, SPP):
        path = tracer.path(pixel, sample, seed=1, options=OPTIONS)
        passed = list(takewhile(lambda vertex: vertex["is_null"], path))
        first = path[len(passed)]
        if first["shape"] == -1:
            weight = np.prod([vertex["opacity_weight"] for vertex in passed])
            missed[divmod(pixel, 8)] += 1
            lost[divmod(pixel, 8)] += weight * np.asarray(first["Le"])
    np.testing.assert_array_equal(hits + missed, SPP)
    whole = tracer.render(spp=SPP, seed=1, options=OPTIONS)
    if name != "fog":  # which the background is seen through
        np.testing.assert_allclose(part.radiance + lost, whole.radiance, rtol=1e-12)
    assert (part.radiance[hits == 0] == 0).all()
    assert (part.radiance <= whole.radiance + 1e-12).all()


def test_counts_have_the_size_of_the_picture() -> None:
    tracer = PathTracer(stage(GRAY))
    for hits, error in ((np.zeros((8, 7)), ShapeError), (np.zeros((8, 8), np.float32), DtypeError)):
        with pytest.raises(error, match="trace_paths: hits: expected"):
            tracer.add_samples(Accumulation.empty(8, 8), 1, seed=1, hits=hits)
