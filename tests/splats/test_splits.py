"""Splitting: what two parts have in common with the whole, and what that costs a picture."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.density import logits, opacities, rotation_matrices
from photograd.splats.model import GaussianScene
from photograd_course.metrics import psnr
from photograd_course.row_map import FRESH

from tests.splats.test_density import ALWAYS, change_in_db, cloud, picture, press, scene


def fitted_quality(change: Callable[[GaussianScene], None], control: Any) -> float:
    """How many dB a change costs a picture that a fit has brought to 30 dB."""
    field = scene(cloud(1500, size=0.03), control)
    before = picture(field)
    noise = np.random.default_rng(3).normal(size=before.shape)
    truth = before + 10 ** (-30 / 20) * noise  # the scene explains it to 30 dB
    change(field)
    return psnr(before, truth) - psnr(picture(field), truth)


def test_splitting_half_of_all_and_pruning_cost_less_than_half_a_decibel() -> None:
    control = CloneSplitPrune(budget=5000, schedule=ALWAYS, small=0.0, large=9.0)

    def split(field: GaussianScene) -> None:
        press(field, np.arange(0, 1500, 2))  # more at once than at any event of a fit
        field.refine(5, {})
        assert len(field.params["means"]) == 1500 + 750

    assert fitted_quality(split, control) < 0.4  # measured: 0.26

    def prune(field: GaussianScene) -> None:
        field.params["opacity_logits"][::10] = logits(np.array(0.004))
        before = picture(field)
        field.refine(5, {})
        assert len(field.params["means"]) == 1350
        assert psnr(picture(field), before) > 45

    fitted_quality(prune, CloneSplitPrune(budget=5000, schedule=ALWAYS, large=9.0))


def test_split_parts_have_the_mean_the_covariance_and_the_coverage_of_the_whole() -> None:
    one = cloud(1, seed=2)
    control = CloneSplitPrune(budget=9, schedule=ALWAYS, small=0.0, large=9.0, fading=0.0)
    field = scene(one, control)
    press(field, np.array([0]))
    quality, rows = change_in_db(field)
    assert (rows.source == FRESH).all()
    longest = int(one.log_scales[0].argmax())
    shrink = one.log_scales - field.params["log_scales"]
    np.testing.assert_allclose(shrink, np.log(1.6) * np.tile(np.eye(3)[longest], (2, 1)))
    offset = field.params["means"] - one.means
    np.testing.assert_allclose(offset[0], -offset[1], atol=1e-15)
    assert np.linalg.norm(offset[0]) > 0.01
    covariance = [
        (turn * np.exp(2 * scales)) @ turn.T
        for turn, scales in zip(
            rotation_matrices(np.concatenate([one.quats, field.params["quats"]])),
            np.concatenate([one.log_scales, field.params["log_scales"]]),
            strict=True,
        )
    ]
    mixture = np.mean(covariance[1:], axis=0) + np.outer(offset[0], offset[0])
    np.testing.assert_allclose(mixture, covariance[0], rtol=1e-12, atol=1e-15)
    whole = 1 / (1 + np.exp(-one.opacity_logits))
    # Half as much each, on an axis shorter by 1.6.
    np.testing.assert_allclose(opacities(field.params), np.repeat(0.8 * whole, 2), rtol=1e-6)
    assert quality > 40  # dB of the picture; measured: 51
