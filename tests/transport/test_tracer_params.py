"""Parameters of a tracer keep the names and shapes of its scene."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.transport import PathTracer, builtin_scene

pytestmark = pytest.mark.usefixtures("core")

NAME = "materials.white.albedo"


@pytest.fixture
def tracer() -> PathTracer:
    return PathTracer(builtin_scene("cornell-box", 4))


def test_a_misspelled_name_is_refused(tracer: PathTracer) -> None:
    tracer.params["materials.white.albeddo"] = tracer.params[NAME]
    with pytest.raises(RangeError, match=rf"albeddo' \(did you mean '{NAME}'\?\)"):
        tracer.render(spp=1, seed=0)


def test_a_missing_name_is_refused(tracer: PathTracer) -> None:
    del tracer.params[NAME]
    with pytest.raises(RangeError, match=rf"params\['{NAME}'\]: expected an array, got none"):
        tracer.render(spp=1, seed=0)


def test_another_shape_is_refused(tracer: PathTracer) -> None:
    tracer.params[NAME] = np.float32(0.5)
    with pytest.raises(ShapeError, match=rf"params\['{NAME}'\]: expected shape \(3,\), got \(\)"):
        tracer.render(spp=1, seed=0)


def test_a_surface_may_begin_to_emit(tracer: PathTracer) -> None:
    before = tracer.render(spp=1, seed=0).mean
    name = next(name for name in tracer._emissions if name not in tracer.params)
    tracer.params[name] = np.full(3, 5, np.float32)
    assert tracer.render(spp=1, seed=0).mean.sum() > before.sum()
