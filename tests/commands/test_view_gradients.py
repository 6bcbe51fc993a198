"""The layer of gradients of `photograd view`: quantity and colors of `photograd gradients`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.commands.view_drawing import Shown, refined, shown_field, viewed_file
from photograd.commands.view_gradients import (
    GradientLayer,
    arrows,
    box_interval,
    projected,
    scale_bar,
    signed_colors,
    signed_picture,
    splatted,
    strongest_along,
)
from photograd.commands.view_panel import absent_gradient
from photograd.fields import HashGrid, MeshSurface
from photograd.fitting.data import TrainingViews
from photograd.fitting.drawing import Picture, draw_field
from photograd.fitting.photograph_gradient import (
    PhotographGradient,
    photograph_gradient,
    vertex_gradient,
)
from photograd.fitting.view_gradients import loss_and_grad
from photograd.geometry.icosphere import icosphere
from photograd.representation import ImageBatch, RenderOptions
from photograd.splats.files import write_gaussians
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import Gaussians, SplatOptions
from photograd_course.viz import signed_projection, style
from photograd_course.viz.scale import signed_scale

from tests.splat import oracle

pytestmark = pytest.mark.usefixtures("core")
BOX = np.array([[-1.0, -1, -1], [1, 1, 1]])


def view_of(camera: Camera, color: float = 0.2) -> View:
    pixels = np.full((camera.height, camera.width, 4), color, np.float32)
    pixels[..., 3] = 1
    return View("one", camera, pixels)


def test_along_an_axis_it_is_the_projection_of_the_figures() -> None:
    values = np.random.default_rng(0).normal(size=(6, 5, 4))
    active = np.ones(values.shape, bool)
    active[2, 3] = False
    values[2, 3] = 0
    x, y = np.meshgrid(np.arange(6), np.arange(5), indexing="ij")
    centers = BOX[0, :2] + (np.stack([x, y], -1).reshape(-1, 2) + 0.5) * [2 / 6, 2 / 5]
    origins = np.concatenate([centers, np.full((30, 1), -4.0)], axis=1)
    directions = np.tile([0.0, 0, 1], (30, 1))
    found, met, entered = strongest_along(origins, directions, values, active, BOX)
    np.testing.assert_array_equal(found.reshape(6, 5), signed_projection(values, 2))
    assert entered.all()
    assert np.flatnonzero(~met).tolist() == [2 * 5 + 3]
    away, _, entered = strongest_along(origins, -directions, values, active, BOX)
    assert not away.any()
    assert not entered.any()


def test_rays_enter_a_box_and_leave_it() -> None:
    origins = np.array([[-3.0, 0, 0], [0, 0, 0], [-3, 2, 0]])
    start, end = box_interval(origins, np.tile([1.0, 0, 0], (3, 1)), BOX)
    assert start.tolist()[:2] == [2, 0]
    assert end.tolist()[:2] == [4, 1]
    assert not end[2] > start[2]


def test_voxels_want_matter_where_the_balls_are(capture_folder: Path, model_folder: Path) -> None:
    viewed = viewed_file(model_folder)
    capture = load_capture(capture_folder)
    found = photograph_gradient(viewed.steps[0].field(), None, capture.train[0])  # type: ignore[misc]
    assert found.kind == "voxels"
    assert found.limit == signed_scale("test", [found.values], None, quantile=1 - 2 / 392).limit
    fine = photograph_gradient(viewed.steps[40].field(), None, capture.train[0])  # type: ignore[misc]
    assert fine.limit == signed_scale("test", [fine.values], None).limit  # as the figures have it
    outlier = replace(found, values=found.values.copy())
    outlier.values[0, 0, 0] = 1e6
    assert outlier.limit < 1.6 * found.limit  # one voxel does not own the scale
    picture = signed_picture(found, viewed.steps[0])(capture.train[0].camera)
    alpha = capture.train[0].rgba()[..., 3]
    blue = picture.color[..., 2] > picture.color[..., 0] + 0.02
    red = picture.color[..., 0] > picture.color[..., 2] + 0.02
    assert blue[alpha > 0.99].mean() > 0.95
    assert red[alpha == 0].sum() > blue[alpha == 0].sum()


def gaussians(count: int) -> GaussianScene:
    return GaussianScene(oracle.cloud(count, 1), extent=1.0, policy=SplatOptions(alpha_min=0.0))


def test_splatted_values_are_blended_like_colors() -> None:
    scene = gaussians(30)
    (camera,) = orbit_cameras(scene.box, 1, size=20)
    values = np.random.default_rng(1).uniform(-3, 3, 30)
    found = splatted(scene, values, 3.0, camera)
    plain = Gaussians(**{**scene.gaussians.arrays(), "sh": np.zeros((30, 1, 3))})
    # The weights of one Gaussian after the other: the sum of weight times value.
    total = np.zeros(found.shape)
    for row in range(30):
        only = np.zeros(30)
        only[row] = values[row]
        total += splatted(GaussianScene(plain, extent=1.0, policy=scene.policy), only, 3.0, camera)
    np.testing.assert_allclose(found, total, atol=1e-9)
    assert np.abs(found).max() > 0.3
    np.testing.assert_allclose(splatted(scene, 9 * values, 3.0, camera).max(), 3, atol=3.0)


def test_gaussians_show_the_derivative_of_their_opacity() -> None:
    scene = gaussians(40)
    (camera,) = orbit_cameras(scene.box, 1, size=24)
    view = view_of(camera)
    found = photograph_gradient(scene, None, view)
    loss, groups, *_ = loss_and_grad(scene, TrainingViews([view]).views[0], 0.2)
    assert found.loss == loss
    np.testing.assert_array_equal(found.values, groups["opacity_logits"])
    assert np.abs(found.values).max() > 0


def ball() -> MeshSurface:
    sphere = icosphere(4)
    return MeshSurface.of_mesh(0.5 * sphere.vertices, sphere.faces)


def test_vertices_move_as_finite_differences_say() -> None:
    field = ball().unsmoothed()
    (camera,) = orbit_cameras(BOX, 1, size=40)
    photograph = TrainingViews([view_of(camera)]).views[0]
    white = np.ones(3)
    loss, d_vertices = vertex_gradient(field, photograph, white, 0.0)
    outputs, context = field.render(ImageBatch(camera), seed=0, step=0, options=RenderOptions())
    assert outputs.opacity is not None
    from photograd.fitting.loss import picture_loss, picture_loss_backward

    again = picture_loss(outputs, photograph, white, ssim_weight=0.0)
    gradients = field.render_backward(context, picture_loss_backward(again)[0])
    assert loss == again.value
    np.testing.assert_allclose(d_vertices, gradients["differential"], atol=1e-12)
    assert np.abs(d_vertices).max() > 1e-4


def test_arrows_go_downhill_and_one_outlier_does_not_own_their_length() -> None:
    field = ball()
    d_vertices = 0.3 * field.vertices
    d_vertices[5] *= 1000
    starts, ends, outward = arrows(field, d_vertices)
    assert not outward.any()
    assert ((ends - starts) * starts).sum(axis=1).max() < 0
    lengths = np.linalg.norm(ends - starts, axis=1)
    diagonal = np.linalg.norm(field.box[1] - field.box[0])
    assert lengths.max() == pytest.approx(1.5 * 0.09 * diagonal)
    assert np.median(lengths) == pytest.approx(0.09 * diagonal, rel=0.01)
    (camera,) = orbit_cameras(BOX, 1, size=64)
    found = PhotographGradient("surface", np.zeros(1), 0.0, camera, groups={"vertices": d_vertices})
    picture = signed_picture(found, shown_field(field, None))(camera)
    orange = (picture.color[..., 0] - picture.color[..., 2]) > 0.4
    assert 20 < orange.sum() < 2000


def test_other_fields_show_the_pixels_of_the_photograph() -> None:
    field = HashGrid.example(seed=0, dtype=np.float32)
    camera, other = orbit_cameras(field.box, 2, size=32)
    view = view_of(camera)
    found = photograph_gradient(field, None, view)
    assert found.kind == "pixels"
    same, missing = projected(found, draw_field(field, None, camera), camera, field)
    np.testing.assert_array_equal(same, found.values)
    assert not missing.any()
    turned, missing = projected(found, draw_field(field, None, other), other, field)
    assert missing.any()
    assert not turned[missing].any()


def test_colors_are_those_of_the_figures() -> None:
    none = np.zeros((1, 3), bool)
    found = signed_colors(np.array([[-2.0, 0, 2.0]]), 2.0, none)
    table = style.signed_color_map()(style.symmetric_scale(2.0)(np.array([-2.0, 0, 2.0])))
    np.testing.assert_allclose(found[0], table[:, :3])
    assert found[0, 1].tolist() == [1, 1, 1]
    assert found[0, 0, 2] > found[0, 0, 0]
    bar = scale_bar()
    assert bar.shape == (16, 256, 3)
    assert bar[0, 0, 2] > bar[0, 0, 0]
    assert bar[0, -1, 0] > bar[0, -1, 2]


def test_a_gradient_is_found_once_and_coarse_pictures_come_first(
    capture_folder: Path, model_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewed = viewed_file(model_folder)
    views = load_capture(capture_folder).train
    said: list[str] = []
    layer = GradientLayer(said.append)
    asked: list[str] = []
    import photograd.fitting.photograph_gradient as module

    whole = module.photograph_gradient

    def counted(field: Any, background: Any, view: View) -> PhotographGradient:
        asked.append(view.name)
        return whole(field, background, view, rays=512)

    monkeypatch.setattr(module, "photograph_gradient", counted)
    (camera,) = orbit_cameras(viewed.box, 1, size=(64, 48))
    first = list(layer.pictures(viewed.last, views[0], camera))
    assert [None if p is None else p.color.shape for p in first[:2]] == [None, (6, 8, 3)]
    assert first[-1] is not None
    assert first[-1].color.shape == (24, 32, 3)
    again = list(layer.pictures(viewed.last, views[0], camera))
    assert again[0] is not None
    second = list(layer.pictures(viewed.last, views[1], camera))
    assert second[0] is not None  # of the gradient at hand
    assert second[1] is None
    assert asked == [views[0].name, views[1].name]
    assert views[0].name in said[0]
    assert views[1].name in said[-1]


def test_without_photographs_the_layer_is_absent_and_says_why(tmp_path: Path) -> None:
    write_gaussians(tmp_path / "a.ply", oracle.cloud(40, 1).astype(np.float32))
    viewed = viewed_file(tmp_path / "a.ply")
    assert "--capture" in absent_gradient(viewed, False)
    assert absent_gradient(viewed, True) == ""
    blank = Picture(np.zeros((1, 1, 3)), np.zeros((1, 1)), np.zeros((1, 1)))
    scene = replace(viewed, last=Shown(refined(lambda _: blank)))
    assert "scene" in absent_gradient(scene, True)


def test_gaussians_of_a_file_are_differentiated_in_its_frame(tmp_path: Path) -> None:
    cloud = oracle.cloud(40, 1).astype(np.float32)
    write_gaussians(tmp_path / "a.ply", cloud)
    viewed = viewed_file(tmp_path / "a.ply")
    (camera,) = orbit_cameras(viewed.box, 1, size=24)
    found = GradientLayer().of(viewed.last, view_of(camera))
    assert found is not None
    turned = viewed.last.camera(camera)
    np.testing.assert_allclose(turned.position, camera.position * [1, -1, -1], atol=1e-12)
    np.testing.assert_allclose(found.camera.position, turned.position)
    shown = signed_picture(found, viewed.last)(camera)
    assert np.ptp(shown.color) > 0.1
