"""Numbers in the figures are the numbers that were given or can be recomputed."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from photograd_course.errors import RangeError, ShapeError
from photograd_course.viz import FitCurves, comparison_strips, fit_curves, style
from photograd_course.viz.curves import running_mean


def test_running_mean_matches_a_loop_and_keeps_a_constant() -> None:
    values = np.random.default_rng(1).normal(size=450)
    smooth = running_mean(values)
    half = 4  # 450 // 100
    for i in (0, 1, 200, 449):
        # 1e-13: cumulative sums of 450 numbers of size 1 in double.
        assert smooth[i] == pytest.approx(values[max(i - half, 0) : i + half + 1].mean(), abs=1e-13)
    assert running_mean(np.full(300, 2.5)) == pytest.approx(np.full(300, 2.5), abs=1e-13)
    assert running_mean(np.array([4.0])).tolist() == [4.0]


def test_curves_draw_loss_psnr_and_markers_at_their_steps() -> None:
    figure = fit_curves(
        FitCurves([1, 2, 4], [1.0, 0.1, 0.01], [0.0, 10.0, 20.0], [2, 4], [9.5, 18.25], {2: "64³"})
    )
    loss, psnr = figure.axes
    assert loss.get_yscale() == "log"
    assert loss.lines[0].get_xydata().tolist() == [[1, 1.0], [2, 0.1], [4, 0.01]]
    markers = next(line for line in psnr.lines if line.get_label() == "held-out views")
    assert markers.get_xydata().tolist() == [[2, 9.5], [4, 18.25]]
    words = {text.get_text() for axes in figure.axes for text in axes.texts}
    assert {"64³", "18.25"} <= words


@pytest.mark.parametrize(
    ("curves", "kind", "argument"),
    [
        (FitCurves([], []), ShapeError, "steps"),
        (FitCurves([1, 2], [1.0]), ShapeError, "loss"),
        (FitCurves([1, 2], [1.0, 0.0]), RangeError, "loss"),
        (FitCurves([1, 2], [1.0, np.inf]), RangeError, "loss"),
        (FitCurves([2, 1], [1.0, 1.0]), RangeError, "steps"),
        (FitCurves([1, 2], [1.0, 1.0], [3.0]), ShapeError, "psnr"),
        (FitCurves([1, 2], [1.0, 1.0], None, [1], []), ShapeError, "test_psnr"),
    ],
)
def test_bad_curves_are_refused(curves: FitCurves, kind: type[Exception], argument: str) -> None:
    with pytest.raises(kind, match=f"fit_curves: {argument}: expected"):
        fit_curves(curves)


def test_strips_print_the_psnr_of_what_they_show() -> None:
    truth = np.full((6, 8, 3), 0.5)
    figure = comparison_strips([truth, truth], [truth + 0.1, truth], names=["a", "b"])
    below = [axes.get_xlabel() for axes in figure.axes if axes.get_xlabel()]
    assert below == ["20.00 dB", "identical"]  # -10 log10(0.1^2) = 20
    given = comparison_strips([truth], [truth + 0.1], psnr=[19.5])
    assert "19.50 dB" in {axes.get_xlabel() for axes in given.axes}


def test_strips_show_truth_render_and_error() -> None:
    truth, render = np.full((4, 4, 3), 0.25), np.full((4, 4, 3), 0.25)
    render[1, 2] = (0.25, 0.55, 0.25)
    figure = comparison_strips([truth], [render], error_limit=0.2)
    shown = {axes.get_ylabel(): axes.images[0].get_array() for axes in figure.axes[:3]}
    assert np.array_equal(shown["truth"], truth)
    assert np.array_equal(shown["render"], render)
    expected = np.zeros((4, 4))
    expected[1, 2] = 0.1  # 0.3 in one of three channels
    assert np.abs(np.asarray(shown["error"]) - expected).max() < 1e-15


def test_strips_show_no_error_where_there_is_no_photograph() -> None:
    truth, render = np.full((20, 20, 3), 1.0), np.full((20, 20, 3), 0.9)
    valid = np.ones((20, 20), np.bool_)
    valid[:8] = False
    render[~valid] = 0.0  # against a truth that was filled with white: an error of 1
    figure = comparison_strips([truth], [render], valid=[valid])
    shown = {axes.get_ylabel(): axes.images[0] for axes in figure.axes[:3]}
    error = shown["error"].get_array()
    assert np.array_equal(np.ma.getmaskarray(error), ~valid)
    assert np.abs(error.compressed() - 0.1).max() < 1e-15
    assert shown["error"].get_clim() == (0.0, 0.1)  # the scale is that of valid pixels
    gray = np.array(to_rgb(style.MISSING))
    assert np.abs(shown["error"].to_rgba(error)[0, 0, :3] - gray).max() < 1e-6
    assert (shown["truth"].get_array()[~valid] == gray).all()
    assert np.array_equal(shown["truth"].get_array()[valid], truth[valid])
    assert np.array_equal(shown["render"].get_array(), render)
    assert {axes.get_xlabel() for axes in figure.axes} >= {"20.00 dB"}


def test_strips_refuse_pairs_that_do_not_match() -> None:
    image = np.zeros((4, 4, 3))
    with pytest.raises(ShapeError, match="renders: expected 1 images, got 2"):
        comparison_strips([image], [image, image])
    with pytest.raises(ShapeError, match=r"renders\[0\]: expected shape"):
        comparison_strips([image], [np.zeros((4, 5, 3))])
    with pytest.raises(ShapeError, match="names: expected 1 entries"):
        comparison_strips([image], [image], names=["a", "b"])
    with pytest.raises(RangeError, match=r"truths\[0\]: expected display values in \[0, 1\]"):
        comparison_strips([image - 0.1], [image])
    with pytest.raises(ShapeError, match=r"valid\[0\]: expected shape \(4, 4\)"):
        comparison_strips([image], [image], valid=[np.ones((4, 5), np.bool_)])
    with pytest.raises(RangeError, match=r"valid\[0\]: expected a valid pixel, got none"):
        comparison_strips([image], [image], valid=[np.zeros((4, 4), np.bool_)])
