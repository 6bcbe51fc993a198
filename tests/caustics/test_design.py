"""Designs: from transport and from a plane, their derivative, resuming, and what cannot be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.caustics import CausticDesign, CausticOptions, Lens, design_caustic
from photograd.caustics.loss import PyramidLoss
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.lights import ConstantLight, DirectionalLight
from photograd.transport import IrradianceSensor, Material, PathTracer, Scene, trace_light
from photograd.transport.builtin import camera_at
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.caustics.test_lens import SUN
from tests.caustics.test_transport_start import plate, spots, wall


@pytest.mark.parametrize("start", ["transport", "plane"])
def test_the_caustic_is_the_picture(start: Any) -> None:
    """Steps and rays for seconds; docs/caustics.md has the figures of 64 x 64."""
    options = CausticOptions(start=start, steps=90 if start == "plane" else 25)
    found = design_caustic(plate(), SUN, wall(), spots(), options)
    light = found.caustic
    assert found.correlation > 0.97
    assert found.finished
    assert light.received == pytest.approx(light.emitted * 0.96**2, rel=0.01)
    assert light.trapped == 0
    assert found.history[-1, 1] < 0.7 * found.history[0, 1]


def test_two_lenses_in_a_row() -> None:
    first = plate(33, 33)
    second = Lens([-0.05, 0.2, 0.05], first.edge_x, first.edge_y, 0.02, first.heights, 1.5)
    job = CausticDesign([first, second], SUN, wall(), spots(), CausticOptions(steps=12))
    start = job.lenses_now()
    found = job.run()
    light = found.caustic
    assert light.received == pytest.approx(light.emitted * 0.96**4, rel=0.01)
    assert all(
        np.ptp(a.heights - b.heights) > 1e-6 for a, b in zip(found.lenses, start, strict=True)
    )
    assert found.correlation > 0.95
    assert found.history[-1, 1] < found.history[0, 1]


def test_the_light_tracer_sees_the_picture() -> None:
    """Particles of the path tracer through the finished lens, with all reflections."""
    found = design_caustic(plate(), SUN, wall(), spots(), CausticOptions(steps=25))
    glass = Material("glass", {"eta": 1.5, "tint": [1, 1, 1]})
    camera = camera_at([0.0, 0.1, 1.0], [0, 0.1, 0], 30, 4, 4)
    shapes = (found.lenses[0].shape("lens", "glass"),)
    tracer = PathTracer(Scene("lens", shapes, {"glass": glass}, camera, lights=(SUN,)))
    traced = trace_light(tracer, wall(), 1 << 18, seed=1).mean[..., 0]
    inner = traced[3:-3, 3:-3]  # around the lens, light reaches the border directly
    assert np.corrcoef(inner.ravel(), spots()[3:-3, 3:-3].ravel())[0, 1] > 0.95
    assert inner.mean() == pytest.approx(found.caustic.irradiance[3:-3, 3:-3].mean(), rel=0.02)


def test_the_derivative_of_a_design() -> None:
    """Free differences of the loss: rays that change triangles are there, and too few to matter."""
    job = CausticDesign(plate(17, 17), SUN, wall(16), spots(16), CausticOptions(steps=1))
    rng = np.random.default_rng(0)
    job.x["heights.0"] = 0.003 * rng.normal(size=(17, 17))
    _, gradients = job.loss_and_gradients(0)
    for seed in range(3):
        way = np.random.default_rng(seed).normal(size=(17, 17))
        place, losses, h = job.x["heights.0"], [], 1e-5
        for sign in (1, -1):
            job.x["heights.0"] = place + sign * h * way
            losses.append(job.loss_and_gradients(0)[0])
        job.x["heights.0"] = place
        along = float((gradients["heights.0"] * way).sum())
        assert along == pytest.approx((losses[0] - losses[1]) / (2 * h), rel=1e-3)


def test_the_loss_of_a_pyramid() -> None:
    rng = np.random.default_rng(1)
    target = rng.uniform(size=(9, 12))
    loss = PyramidLoss(target)
    assert loss.loss(target) == 0
    report = check_gradient(
        lambda p: np.array(loss.loss(p["power"])),
        lambda p, d: {"power": d * loss.loss_backward(p["power"])},
        {"power": rng.uniform(size=(9, 12))},
        seed=1,
    )
    assert report, str(report)


def test_a_resumed_design_ends_with_the_same_bits(tmp_path: Path) -> None:
    options = CausticOptions(steps=4, seed=3)
    arguments = (plate(17, 17), SUN, wall(16), spots(16), options)
    whole = CausticDesign(*arguments).run()
    stopped = CausticDesign(*arguments)
    stopped.run(tmp_path, should_stop=lambda: stopped.step_number == 2)
    resumed = CausticDesign(*arguments)
    resumed.load(tmp_path)
    assert resumed.step_number == 2
    np.testing.assert_array_equal(resumed.run().lenses[0].heights, whole.lenses[0].heights)
    other = CausticDesign(*arguments[:3], spots(16).T, options)
    with pytest.raises(RangeError, match="design of the checkpoint"):
        other.load(tmp_path)


def test_lenses_that_trap_all_light() -> None:
    """A prism of 60 degrees, beyond the critical angle of 42."""
    steep = np.tile(0.035 * np.linspace(0, 1, 5), (9, 1))
    lens = Lens([-0.01, 0.1, 0.05], [0.02, 0, 0], [0, 0, -0.1], 0.02, steep, 1.5)
    with pytest.raises(Error, match="total reflection of all light"):
        CausticDesign(lens, SUN, wall(), spots(), CausticOptions(start="plane"))


def test_what_cannot_be_designed() -> None:
    for dark in (0.0, 1e-320):
        with pytest.raises(RangeError, match=r"CausticDesign: target: .*a picture with light"):
            CausticDesign(plate(), SUN, wall(), np.full((32, 32), dark))
    for shape in ((2, 2), (2, 9), (9, 2)):  # a lens, but too few heights to transport light
        with pytest.raises(ShapeError, match=r"transport_lens: lens: expected at least 3 heights"):
            CausticDesign(plate(*shape), SUN, wall(), spots())
        start = CausticOptions(start="plane", steps=1)
        assert CausticDesign(plate(*shape), SUN, wall(), spots(), start).run().finished
    with pytest.raises(ShapeError, match="target"):
        CausticDesign(plate(), SUN, wall(), np.ones((8, 8)))
    with pytest.raises(RangeError, match=r"target: .*finite"):
        CausticDesign(plate(), SUN, wall(), np.full((32, 32), np.inf))
    with pytest.raises(DtypeError, match="PointLight"):
        CausticDesign(plate(), ConstantLight([1.0] * 3), wall(), spots())  # type: ignore[arg-type]
    with pytest.raises(RangeError, match="a dark one"):
        CausticDesign(plate(), DirectionalLight([0, -1, 0], [0.0] * 3), wall(), spots())
    aside = IrradianceSensor([5.0, 0.4, 0.05], [-0.1, 0, 0], [0, 0, -0.1], 8, 8)
    with pytest.raises(Error, match=r"receiver: .*light on it"):
        CausticDesign(plate(), SUN, aside, np.ones((8, 8)), CausticOptions(start="plane"))
    with pytest.raises(RangeError, match="start"):
        CausticOptions(start="sphere")  # type: ignore[arg-type]


@same_bits("caustic design")
def heights_and_light() -> list[Any]:
    options = CausticOptions(steps=2, seed=1)
    found = CausticDesign(plate(17, 17), SUN, wall(16), spots(16), options).run()
    return [found.lenses[0].heights, found.caustic.irradiance]
