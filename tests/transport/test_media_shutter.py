"""A camera that moves, also into a medium, while its shutter is open."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd.transport import BOUNDARY, Environment, PathOptions, PathTracer, Scene, Shutter
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box
from photograd_course.gradcheck import check_gradient

from tests.transport.media_scenes import INK, fog_box, pencil, smoke, with_interior
from tests.transport.test_adjoint import proof

SIGMA = np.array(INK.sigma_t)
OPTIONS = PathOptions(max_depth=4, roulette_from=2, sampler="independent")


def into_ink() -> Scene:
    """A box of ink, 1 m deep; the camera flies from 1 m before it to its middle, looking ahead."""
    ink = with_interior(box("ink", [0, 0, 0], [1, 1, 1], BOUNDARY), "ink")
    camera, inside = pencil((0, 0, 1.5), (0, 0, 0)), pencil((0, 0, 0), (0, 0, -1))
    return Scene(
        "into",
        (ink,),
        {},
        camera,
        Environment.constant(1.0),
        media={"ink": INK},
        shutter=Shutter(inside.world_from_camera),
    )


def test_a_camera_that_dives_into_a_medium() -> None:
    # Two thirds of the time it is outside and looks through 1 m; then through 1 m down to 1/2 m.
    found = PathTracer(into_ink(), dtype=np.float64).render(spp=4096, seed=1)
    inside = (np.exp(-SIGMA / 2) - np.exp(-SIGMA)) / (SIGMA / 2)
    expected = (2 * np.exp(-SIGMA) + inside) / 3
    # Even samples of one number; a camera that stayed outside would see 3 % less, or more.
    np.testing.assert_allclose(found.mean[0, 0], expected, rtol=1e-4)
    assert (np.abs(expected / np.exp(-SIGMA) - 1) > 0.02).all()


def test_every_sample_has_its_own_moment() -> None:
    tracer = PathTracer(into_ink(), dtype=np.float64)
    lengths = []
    for sample in range(64):
        (vertex,) = tracer.path(0, sample, seed=1)
        lengths.append(sum(step[2] for step in vertex["events"]))
    outside = np.isclose(lengths, 1.0)
    assert 0.55 < outside.mean() < 0.75
    assert np.ptp(np.array(lengths)[~outside]) > 0.4


@pytest.mark.parametrize("grid", [False, True])
def test_a_picture_is_the_mean_of_still_ones(grid: bool) -> None:
    scene = fog_box(smoke(), size=4) if grid else fog_box(size=4)
    end = camera_at([0.5, 0.8, 0.6], [0.2, 0.3, 0.0], 40.0, 4, 4)  # in the fog
    moving = replace(scene, shutter=Shutter(end.world_from_camera))
    blurred = PathTracer(moving).render(spp=2048, seed=1, options=OPTIONS)
    count = 32
    mean, variance = np.zeros((4, 4, 3)), np.zeros((4, 4, 3))
    tracer = PathTracer(scene)
    start = scene.camera.world_from_camera
    for number in range(count):
        s = (number + 0.5) / count
        pose = np.eye(4)
        pose[:3, 3] = (1 - s) * start[:3, 3] + s * end.world_from_camera[:3, 3]
        part = turned(start[:3, :3], end.world_from_camera[:3, :3], s)
        pose[:3, :3] = part
        camera = replace(scene.camera, world_from_camera=pose)
        one = tracer.render(spp=64, seed=100 + number, options=OPTIONS, camera=camera)
        mean += one.mean / count
        variance += (one.standard_error / count) ** 2
    error = np.sqrt(variance + blurred.standard_error**2)
    gap = blurred.mean - mean
    # False alarm: 6e-5 for the whole, and 3e-5 for the worst of 48 numbers at 5 errors.
    assert abs(gap.sum()) < 4 * np.sqrt((error**2).sum())
    assert np.abs(gap / error).max() < 5
    still = tracer.render(spp=1024, seed=2, options=OPTIONS)
    assert np.abs((still.mean - mean) / error).max() > 10


def turned(a: np.ndarray, b: np.ndarray, share: float) -> np.ndarray:
    """A part of the rotation from a to b, by the powers of its eigenvalues."""
    values, vectors = np.linalg.eig(b @ a.T)
    part = (vectors @ np.diag(np.exp(share * np.log(values))) @ np.linalg.inv(vectors)).real
    return np.asarray(part @ a)


def test_derivatives_walk_the_same_paths() -> None:
    scene = fog_box(smoke(), size=4)
    end = camera_at([0.5, 0.8, 0.6], [0.2, 0.3, 0.0], 40.0, 4, 4)
    moving = replace(scene, shutter=Shutter(end.world_from_camera))
    function, backward, start = proof(moving, OPTIONS)
    black = ("materials.black.albedo",)
    report = check_gradient(
        function, backward, start, seed=2, coordinates=2, directions=1, may_be_zero=black
    )
    assert report, str(report)
