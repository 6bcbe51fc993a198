"""Every descent of the package that is interrupted: its result so far, and no bit lost."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.caustics import CausticDesign, CausticOptions
from photograd.fields import ImagePolicy
from photograd.fitting import ImageFitOptions, fit_image
from photograd.textures import recover
from photograd.transport import PathTracer
from photograd.transport.builtin import cornell_box
from photograd.transport.inverse import InverseRendering, RecoveryOptions
from photograd.vector import VectorFitOptions, fit_curves

from tests.caustics.test_design import SUN, plate, spots, wall

Stop = Callable[[], bool]
RNG = np.random.default_rng(1)
PICTURE = RNG.random((16, 16, 3))
POINTS, COLORS = RNG.random((50, 2)), RNG.random((50, 3))
ROOM = cornell_box(6)
PHOTOGRAPH = PathTracer(ROOM).render(spp=4, seed=1).mean


def curves(folder: Path | None, stop: Stop, *, resume: bool) -> Any:
    options = VectorFitOptions(steps=6)
    return fit_curves(PICTURE, 4, options, folder=folder, resume=resume, should_stop=stop)


def image(folder: Path | None, stop: Stop, *, resume: bool) -> Any:
    policy = ImagePolicy(levels=2, coarsest=4, finest=8, log2_rows=8, width=16, depth=1)
    options, colors = ImageFitOptions(steps=6, points=64), PICTURE.astype(np.float32)
    return fit_image(colors, policy, options, folder=folder, resume=resume, should_stop=stop)


def texture(folder: Path | None, stop: Stop, *, resume: bool) -> Any:
    return recover(POINTS, COLORS, (4, 4), steps=6, folder=folder, resume=resume, should_stop=stop)


def materials(folder: Path | None, stop: Stop, *, resume: bool) -> Any:
    names = ["materials.red.albedo", "emission.lamp"]
    job = InverseRendering(ROOM, PHOTOGRAPH, names, RecoveryOptions(steps=6, spp=1))
    if resume and folder is not None:
        job.load(folder)
    return job.run(folder, should_stop=stop)


def caustic(folder: Path | None, stop: Stop, *, resume: bool) -> Any:
    job = CausticDesign(plate(9, 9), SUN, wall(8), spots(8), CausticOptions(steps=6, rays=1))
    if resume and folder is not None:
        job.load(folder)
    return job.run(folder, should_stop=stop)


def bits(value: Any) -> Any:
    """Arrays and numbers of a result as bytes, without its seconds."""
    if isinstance(value, np.ndarray):
        return value.tobytes()
    if isinstance(value, dict):
        return {name: bits(each) for name, each in value.items()}
    if isinstance(value, tuple):
        return tuple(map(bits, value))
    if hasattr(value, "__dict__") and type(value).__module__.startswith("photograd"):
        return {name: bits(each) for name, each in vars(value).items() if name != "seconds"}
    return value if isinstance(value, int | float | str) else None


def raises_at(count: int, kind: type[BaseException]) -> Stop:
    left = iter(range(count))

    def stop() -> bool:
        if next(left, None) is None:
            raise kind("stop here")
        return False

    return stop


@pytest.mark.parametrize("kind", [KeyboardInterrupt, RuntimeError])
@pytest.mark.parametrize("run", [curves, image, texture, materials, caustic])
def test_a_callback_that_raises(run: Any, kind: type[BaseException], tmp_path: Path) -> None:
    whole = run(None, lambda: False, resume=False)
    with pytest.raises(kind) as caught:
        run(None, raises_at(4, kind), resume=False)
    partial = caught.value.partial_result  # type: ignore[attr-defined]
    assert type(partial) is type(whole)
    losses = partial.losses if hasattr(partial, "losses") else partial.history
    assert len(losses) == 4
    with pytest.raises(kind) as caught:
        run(tmp_path, raises_at(3, kind), resume=False)
    again = run(tmp_path, lambda: False, resume=True)
    assert bits(again) == bits(whole)
