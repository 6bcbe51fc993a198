"""What a notebook shows of captures, models, pictures and gradients, without Matplotlib."""

from __future__ import annotations

import base64
import io
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._notebook import EDGE, as_html, png, sheet, signed_colors, smaller
from photograd.capture.view import View
from photograd.fields import DenseGrid
from photograd.fitting import Fit, options_for
from photograd.fitting.evaluate import evaluate
from photograd.fitting.group_gradients import group_gradients
from photograd.fitting.view_gradients import ViewGradients
from photograd.fitting.voxel_gradients import DensityGradient
from photograd.textures.recovery import RecoveredTexture
from photograd.transport.accumulation import Accumulation
from PIL import Image

from tests.fit import scene
from tests.fit.mesh_scene import truth

SOURCE = re.compile(r"src='data:image/png;base64,([^']+)'")


def pixels(data: bytes) -> Any:
    """(H, W, 3) in 0 to 1 of a PNG file, which is bounded."""
    image = np.asarray(Image.open(io.BytesIO(data)))
    assert image.ndim == 3
    assert max(image.shape[:2]) <= 4 * EDGE
    return image / 255


def picture(text: str) -> Any:
    """The one picture of a text."""
    (found,) = SOURCE.findall(text)
    assert len(text) < 1_000_000
    return pixels(base64.b64decode(found))


@pytest.mark.parametrize("shape", [(700, 30), (30, 700), (513, 512), (1, 2000), (4, 5)])
def test_a_smaller_image_keeps_the_mean_of_its_parts(shape: tuple[int, int]) -> None:
    image = np.random.default_rng(1).random((*shape, 3))
    small = smaller(image)
    assert max(small.shape[:2]) <= EDGE
    factor = -(-max(shape) // EDGE)
    np.testing.assert_allclose(small[0, 0], image[:factor, :factor].mean((0, 1)))
    if factor == 1:
        assert small is image


def test_colors_say_the_sign() -> None:
    colors = signed_colors(np.array([[-1.0, 0.0, 1.0, np.nan]]))
    assert colors[0, 0, 2] > colors[0, 0, 0] + 0.3
    assert colors[0, 2, 0] > colors[0, 2, 2] + 0.3
    np.testing.assert_array_equal(colors[0, [1, 3]], 1)
    np.testing.assert_array_equal(signed_colors(np.zeros((2, 2))), 1)
    assert signed_colors(np.eye(200)).min() < 0.3  # less than one of 200 is not 0


def test_a_sheet_is_filled_row_by_row_on_white() -> None:
    found = sheet([np.zeros((3, 4, 3)), np.zeros((2, 4, 3)), np.zeros((3, 4, 3))], 2, 100)
    assert found.shape == (10, 12, 3)
    assert found[:3, :4].max() == 0
    assert found[2, 8:].min() == 1
    assert found[7:, 8:].min() == 1


def test_text_is_escaped_and_what_is_not_finite_is_black() -> None:
    text = as_html("<b>", {"<script>": "&"}, None)
    assert "<script>" not in text
    assert "&lt;script&gt;" in text
    assert "<img" not in text
    assert pixels(png(np.full((2, 2, 3), np.nan))).max() == 0


def test_a_capture_shows_some_photographs(tmp_path: Path) -> None:
    capture = scene.capture()
    text = capture._repr_html_()
    assert "12 to learn from, 4 held out" in text
    assert picture(text).std() > 0.05
    missing = replace(capture.train[0], image=tmp_path / "gone.png")
    text = replace(capture, train=(missing, *capture.train[1:]))._repr_html_()
    assert "gone.png" in text
    assert not SOURCE.search(text)


def test_a_view_is_a_small_photograph_over_white() -> None:
    view = scene.capture().train[0]
    camera = replace(view.camera, width=600, height=400)
    large = View("large", camera, np.full((400, 600, 4), [0.5, 0.25, 0.0, 0.5], np.float32))
    found = pixels(large._repr_png_())
    assert max(found.shape) <= EDGE
    np.testing.assert_allclose(found, np.broadcast_to([0.75, 0.625, 0.5], found.shape), atol=3e-3)
    linear = pixels(replace(large, color_space="linear")._repr_png_())
    np.testing.assert_allclose(linear[0, 0], [0.868, 0.769, 0.5], atol=4e-3)


def test_a_model_and_a_fit_are_drawn() -> None:
    capture = scene.capture()
    job = Fit.start(capture, scene.options(resolution=8, steps=9))
    job.step()
    text = job._repr_html_()
    assert "1 of 9" in text
    assert "dense_grid" in text
    assert picture(text).shape == (128, 128, 3)
    assert picture(scene.as_model(scene.truth())._repr_html_()).std() > 0.05
    assert "24 x 24 x 3" in truth()._repr_html_()
    splats = Fit.start(capture, options_for("gaussians", gaussians=40, steps=4))
    assert picture(splats._repr_html_()).shape[2] == 3


def test_a_model_that_cannot_be_drawn_says_why() -> None:
    field = DenseGrid.empty(scene.BOX, 8)
    field.params["values"][2, 2, 2, 3] = np.nan
    text = scene.as_model(field)._repr_html_()
    assert "finite" in text
    assert not SOURCE.search(text)


def test_scores_show_the_worst_views() -> None:
    found = evaluate(scene.as_model(scene.truth()), scene.capture().test)
    text = found._repr_html_()
    assert "PSNR" in text
    assert "test_3" in text
    assert picture(text).std() > 0.05
    height, width, _ = pixels(found.views[0]._repr_png_()).shape
    assert width > 2 * height


def test_a_path_traced_picture_is_shown_in_display_values() -> None:
    sums = Accumulation.empty(2, 3)
    assert sums._repr_png_() is None
    sums.radiance += 2 * 0.5
    sums.count = 2
    data = sums._repr_png_()
    assert data is not None
    np.testing.assert_allclose(pixels(data), 0.7354, atol=3e-3)


def test_gradients_are_drawn_with_their_sign() -> None:
    d_sigma_t = np.zeros((5, 7, 3))
    d_sigma_t[0, 6, 1], d_sigma_t[4, 0, 2] = -1, 1
    found = pixels(DensityGradient(d_sigma_t, d_sigma_t == 0, 0.1)._repr_png_())
    assert found.shape == (7, 5, 3)
    assert found[0, 0, 2] > found[0, 0, 0]  # y = 6 is on top, x = 0 at the left, and blue
    assert found[6, 4, 0] > found[6, 4, 2]
    job = Fit.start(scene.capture(), scene.options(resolution=8))
    model = replace(scene.as_model(scene.truth()), options=job.options)
    gradient = group_gradients(model, job.model, scene.capture(), seed=1, max_rays=200)
    assert pixels(gradient._repr_png_()).shape == (24, 52, 3)


def test_gradients_of_gaussians_are_drawn_where_they_are_seen() -> None:
    found = ViewGradients(
        picture=np.full((6, 8, 3), 0.5),
        pixels=np.array([[1.5, 0.5], [6.5, 4.5], [np.nan, 0.0], [80.0, 2.0], [3.5, 3.5]]),
        spread=np.zeros((5, 2, 2)),
        screen=np.zeros((5, 2)),
        visible=np.array([True, True, False, True, False]),
        d_logit=np.array([-1.0, 1.0, 5.0, 5.0, 5.0]),
        grad2d=np.zeros(5),
        loss=0.1,
    )
    drawn = pixels(found._repr_png_())
    assert drawn.shape == (6, 20, 3)
    signed = drawn[:, 12:]
    assert signed[0, 1, 2] > signed[0, 1, 0]  # blue: more opacity lowers the loss
    assert signed[4, 6, 0] > signed[4, 6, 2]
    assert (signed < 1).any(axis=2).sum() == 2


@pytest.mark.parametrize("channels", [1, 2, 3, 5])
def test_a_recovered_texture_marks_unseen_texels(channels: int) -> None:
    texture = np.full((3, 4, channels), 0.25)
    unseen = np.zeros((3, 4), np.bool_)
    unseen[1, 2] = True
    drawn = pixels(RecoveredTexture(texture, np.ones(2), unseen, 1.0)._repr_png_())
    assert drawn.shape == (3, 12, 3)
    np.testing.assert_allclose(drawn[:, :4], 0.25, atol=3e-3)
    assert ((drawn[:, 8:] < 1).any(axis=2) == unseen).all()


def test_matplotlib_is_not_imported() -> None:
    code = (
        "import sys; from tests.fit import scene; from photograd.fitting import Fit\n"
        "job = Fit.start(scene.capture(), scene.options(resolution=8))\n"
        "assert scene.capture()._repr_html_() and job._repr_html_()\n"
        "assert scene.capture().train[0]._repr_png_()\n"
        "assert 'matplotlib' not in sys.modules"
    )
    root = Path(__file__).resolve().parents[2]
    subprocess.run([sys.executable, "-c", code], cwd=root, check=True, timeout=120)
