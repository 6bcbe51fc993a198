"""A capture from a tiny ray caster: what comes out, and what the loader reads back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from photograd.capture import Camera, load_capture, write_blender_capture
from photograd.scenes import SceneDescription, SkyDescription, SunDescription, bounds_of
from photograd.scenes.capture import capture_scene, content_radius, display_image, view_seed
from photograd.scenes.parts import paint
from photograd.scenes.shapes import sphere
from photograd_course.errors import RangeError, ShapeError

Array = npt.NDArray[np.float64]

RADIUS = 0.4
CENTER = np.array([0.1, 0.2, -0.1])
UP = np.array([0.0, 1.0, 0.0])


def ball_scene() -> SceneDescription:
    meshes = (sphere(RADIUS).moved((0.1, 0.2, -0.1)).painted(paint("red")),)
    sun, sky = SunDescription(UP, UP, 0.05), SkyDescription(UP, UP, UP)
    return SceneDescription("ball", meshes, sun, sky, bounds_of(meshes))


def cast(camera: Camera, spp: int, seed: int) -> tuple[Array, Array]:
    """A ball lit from above with radiance 0..2 by its normal; `spp` jittered samples a pixel."""
    random = np.random.default_rng(seed)
    count = camera.width * camera.height
    radiance, alpha = np.zeros((count, 3)), np.zeros(count)
    for _ in range(spp):
        column, row = np.arange(count) % camera.width, np.arange(count) // camera.width
        x = (column + random.random(count) - camera.cx) / camera.fx
        y = (row + random.random(count) - camera.cy) / camera.fy
        rays = np.stack([x, y, np.ones(count)], axis=-1) @ camera.world_from_camera[:3, :3].T
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        offset = CENTER - camera.position
        along = rays @ offset
        gap = RADIUS**2 - (offset @ offset - along**2)
        points = camera.position + rays * (along - np.sqrt(gap.clip(min=0.0)))[:, None]
        light = 1.0 + (points - CENTER)[:, 1] / RADIUS
        radiance += (gap > 0.0)[:, None] * light[:, None] * np.array([1.0, 0.5, 0.1]) / spp
        alpha += (gap > 0.0) / spp
    # Sums of 1 / spp may end a rounding error above 1.
    shape = (camera.height, camera.width)
    return radiance.reshape(*shape, 3), np.minimum(alpha, 1.0).reshape(shape)


def test_a_capture_and_its_way_through_the_loader(tmp_path: Path) -> None:
    scene = ball_scene()
    calls: list[tuple[int, int]] = []
    splits = capture_scene(
        scene,
        cast,
        views=5,
        test_views=2,
        size=24,
        seed=3,
        spp=4,
        on_view=lambda done, total: calls.append((done, total)),
    )
    assert calls == [(k, 7) for k in range(1, 8)]
    assert [len(splits[name]) for name in ("train", "test")] == [5, 2]
    write_blender_capture(tmp_path / "ball", splits, aabb=scene.bounds)
    shown = load_capture(tmp_path / "ball")
    linear = load_capture(tmp_path / "ball", color_space="linear")
    assert shown.bounds is not None
    np.testing.assert_allclose(shown.bounds, scene.bounds, atol=1e-12)
    for index, (_, camera, image, radiance) in enumerate(splits["train"]):
        assert radiance is not None
        assert image.dtype == radiance.dtype == np.float32
        pose = shown.train[index].camera.world_from_camera
        np.testing.assert_allclose(pose, camera.world_from_camera, atol=1e-12)
        # 8 bits: half a step of 1/255.
        np.testing.assert_allclose(shown.train[index].rgba(), image, atol=0.5 / 255 + 1e-6)
        read = linear.train[index].rgba()
        np.testing.assert_allclose(read[..., :3] * read[..., 3:], radiance[..., :3], atol=1e-6)


def test_the_ball_fills_the_picture() -> None:
    """A ball of 90 % of the width covers pi/4 0.9^2 = 0.636 of a square picture."""
    assert content_radius(ball_scene()) == pytest.approx(RADIUS, rel=1e-6)
    frames = capture_scene(ball_scene(), cast, views=3, test_views=0, size=48, seed=0, spp=4)
    for _, _, image, _ in frames["train"]:
        assert image[..., 3].mean() == pytest.approx(np.pi / 4 * 0.81, abs=0.01)
        assert image[..., 3].max() == 1.0
        assert (image[0, :, 3] == 0.0).all()


def test_display_encoding_by_hand() -> None:
    """Half covered, premultiplied 0.1: straight 0.2, encoded 0.4845; 3 is clipped; empty is 0."""
    linear = np.array([[[0.1, 0.0, 3.0, 0.5], [0.0, 0.0, 0.0, 0.0]]], dtype=np.float32)
    encoded = 1.055 * 0.2 ** (1 / 2.4) - 0.055
    expected = [[[encoded, 0.0, 1.0, 0.5], [0.0] * 4]]
    np.testing.assert_allclose(display_image(linear), expected, atol=1e-6)


def test_the_same_seed_gives_the_same_bits_and_views_have_their_own() -> None:
    options = {"views": 2, "test_views": 1, "size": 12, "spp": 2}
    first, again, other = (
        capture_scene(ball_scene(), cast, seed=seed, **options) for seed in (5, 5, 6)
    )
    for split in ("train", "test"):
        for one, two in zip(first[split], again[split], strict=True):
            np.testing.assert_array_equal(one[2], two[2])
            np.testing.assert_array_equal(one[3], two[3])
    assert np.abs(first["train"][0][2] - other["train"][0][2]).max() > 0.0
    seeds = {view_seed(5, split, index) for split in ("train", "test") for index in range(50)}
    assert len(seeds) == 100


def test_a_density_counts_with_its_whole_box() -> None:
    scene = ball_scene()
    cloudy = SceneDescription(
        "cloudy", scene.meshes, scene.sun, scene.sky, scene.bounds, lambda points: points[:, 0]
    )
    expected = 0.5 * np.linalg.norm(scene.bounds[1] - scene.bounds[0])
    assert content_radius(cloudy) == pytest.approx(expected)


def test_what_a_renderer_may_not_return() -> None:
    def broken(color: float, opacity: float, row: int = 12) -> None:
        def render(camera: Camera, spp: int, seed: int) -> tuple[Array, Array]:
            del spp, seed
            radiance = np.full((row, camera.width, 3), 0.5)
            alpha = np.ones((row, camera.width))
            radiance[3, 4, 1], alpha[3, 4] = color, opacity
            return radiance, alpha

        capture_scene(ball_scene(), render, views=1, test_views=0, size=12, seed=0, spp=1)

    for color, opacity in ((np.nan, 1.0), (-0.1, 1.0), (0.5, 1.1), (0.5, np.inf)):
        with pytest.raises(RangeError, match=r"train 'r_000'.*at pixel \(3, 4\)"):
            broken(color, opacity)
    with pytest.raises(ShapeError, match=r"radiance: expected shape \(12, 12, 3\)"):
        broken(0.5, 1.0, row=11)
    with pytest.raises(RangeError, match="spp"):
        capture_scene(ball_scene(), cast, views=1, test_views=0, size=12, seed=0, spp=0)
