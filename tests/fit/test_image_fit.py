"""A network behind an encoding learns a picture, the same bits in one run or two."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd import errors
from photograd.fields import ImagePolicy
from photograd.fitting import ImageFitOptions, fit_image, load_neural_image
from photograd.fitting.image_fit import IMAGE_FILE
from photograd.fitting.loss import decibels
from photograd.types import Array

SMALL = ImagePolicy(levels=6, coarsest=4, finest=128, log2_rows=12, width=32, depth=1)
OPTIONS = ImageFitOptions(steps=120, points=1 << 12, seed=3)


def checks(size: int = 64) -> Array:
    """(size, size, 3) a ramp with a fine check pattern on its right half."""
    y, x = np.mgrid[:size, :size]
    ramp = np.stack([x / size, y / size, np.full((size, size), 0.4)], axis=-1)
    fine = ((x // 2 + y // 2) % 2)[..., None] * 0.4 * (x[..., None] > size // 2)
    return np.clip(ramp * 0.6 + fine, 0, 1).astype(np.float32)


def test_a_hash_grid_learns_what_a_bare_network_blurs() -> None:
    picture = checks()
    found = {
        name: fit_image(picture, policy, OPTIONS)
        for name, policy in {
            "hash": SMALL,
            "bare": replace(SMALL, encoding="frequencies", octaves=0, depth=2),
            "frequencies": replace(SMALL, encoding="frequencies", octaves=6, depth=2),
        }.items()
    }
    assert found["hash"].psnr > 33
    assert found["hash"].psnr > found["frequencies"].psnr + 10
    # The mean of the pattern is 0.2 from each of its two values: 13.98 dB for a blur.
    fine = np.s_[:, 33:]
    on_pattern = {
        name: decibels(float(np.square(f.image[fine] - picture[fine]).mean()))
        for name, f in found.items()
    }
    assert on_pattern["bare"] < 14.0 < on_pattern["frequencies"] < on_pattern["hash"]


def test_what_is_stated_about_a_fit_is_so() -> None:
    picture = checks()
    found = fit_image(picture, SMALL, OPTIONS)
    error = np.mean(np.square(found.image.astype(np.float64) - picture))
    assert found.psnr == pytest.approx(decibels(float(error)), abs=1e-6)
    assert found.size == 4 * sum(values.size for values in found.field.params.values())
    assert found.finished
    assert len(found.losses) == OPTIONS.steps
    assert found.losses[-1] < found.losses[0] / 20
    np.testing.assert_array_equal(np.clip(found.field.image(64, 64), 0, 1), found.image)


def test_an_interrupted_fit_ends_with_the_same_bits(tmp_path: Path) -> None:
    picture, seen = checks(), iter(range(100))
    whole = fit_image(picture, SMALL, OPTIONS)
    part = fit_image(picture, SMALL, OPTIONS, folder=tmp_path, should_stop=lambda: next(seen) >= 25)
    assert not part.finished
    assert len(part.losses) == 25
    rest = fit_image(picture, SMALL, OPTIONS, folder=tmp_path, resume=True)
    np.testing.assert_array_equal(rest.losses, whole.losses)
    np.testing.assert_array_equal(rest.image, whole.image)
    again = load_neural_image(tmp_path)
    for name, values in whole.field.params.items():
        np.testing.assert_array_equal(again.params[name], values)


def test_a_checkpoint_of_another_fit_is_refused(tmp_path: Path) -> None:
    fit_image(checks(), SMALL, replace(OPTIONS, steps=2), folder=tmp_path)
    with pytest.raises(errors.RangeError, match=r"a folder without image\.npz"):
        fit_image(checks(), SMALL, replace(OPTIONS, steps=2), folder=tmp_path)
    with pytest.raises(errors.RangeError, match="the picture, policy and options"):
        fit_image(checks(), SMALL, replace(OPTIONS, steps=3), folder=tmp_path, resume=True)
    with pytest.raises(errors.RangeError, match="the picture, policy and options"):
        fit_image(checks()[::-1], SMALL, replace(OPTIONS, steps=2), folder=tmp_path, resume=True)


def test_a_rate_that_explodes_names_the_layer_and_leaves_no_state(tmp_path: Path) -> None:
    wild = replace(OPTIONS, steps=40, learning_rate=1e30)
    with pytest.raises(errors.Error, match=r"network, layer 0: .*e\+30 .* learning rate"):
        fit_image(checks(), SMALL, wild, folder=tmp_path)
    assert not (tmp_path / IMAGE_FILE).exists()  # nothing was found before


@pytest.mark.parametrize(
    ("picture", "said"),
    [
        (np.zeros((4, 4), np.float32), "shape"),
        (np.full((4, 4, 3), 2.0, np.float32), r"numbers in \[0, 1\]"),
        (np.full((4, 4, 3), np.nan, np.float32), "picture"),
    ],
)
def test_a_picture_that_is_none_is_refused(picture: Array, said: str) -> None:
    with pytest.raises(errors.Error, match=f"fit_image: .*{said}"):
        fit_image(picture)


def test_sizes_that_no_network_has_are_refused() -> None:
    for wrong in ({"width": 0}, {"depth": 0}, {"levels": 0}, {"encoding": "hash"}):
        with pytest.raises(errors.RangeError, match=next(iter(wrong))):
            ImagePolicy(**wrong)  # type: ignore[arg-type]
