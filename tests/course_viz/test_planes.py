"""No view is mirrored, and zero is white: read back from the pixels of the written file."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd_course.errors import RangeError, ShapeError
from photograd_course.viz import projection_steps, signed_projections, signed_slices, style
from photograd_course.viz.style import save_figure
from PIL import Image

CUBE = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def pixels(figure: Figure, folder: Path) -> NDArray[Any]:
    path = save_figure(figure, folder / "figure.png")
    return np.asarray(Image.open(io.BytesIO(path.read_bytes())).convert("RGB")).astype(int)


def panel_pixels(figure: Figure, number: int, image: NDArray[Any]) -> NDArray[Any]:
    """The pixels inside one axes, without its frame."""
    height, width = image.shape[:2]
    box = figure.axes[number].get_position()
    rows = slice(round((1 - box.y1) * height) + 3, round((1 - box.y0) * height) - 3)
    columns = slice(round(box.x0 * width) + 3, round(box.x1 * width) - 3)
    return image[rows, columns]


def center_of(marked: NDArray[np.bool_]) -> tuple[float, float]:
    """(right, down) of the marked pixels, each from -1 to 1."""
    assert marked.any()
    rows, columns = np.nonzero(marked)
    height, width = marked.shape
    return 2 * columns.mean() / width - 1, 2 * rows.mean() / height - 1


@pytest.mark.parametrize("draw", [signed_projections, signed_slices])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_voxel_appears_where_an_eye_outside_would_see_it(
    tmp_path: Path, draw: Any, sign: float
) -> None:
    """A voxel right of, above and in front of the middle: x > 0, y > 0, z > 0."""
    values = np.zeros((9, 9, 9))
    values[7, 6, 8] = sign  # centers x = 0.667, y = 0.444, z = 0.889
    keywords = {"at": (0.667, 0.444, 0.889)} if draw is signed_slices else {}
    figure = draw(values, CUBE, **keywords)
    image = pixels(figure, tmp_path)
    expected = {0: (0.667, -0.444), 1: (-0.889, -0.444), 2: (0.667, 0.889)}  # front, side, top
    for number, (right, down) in expected.items():
        panel = panel_pixels(figure, number, image)
        red, green, blue = np.moveaxis(panel, 2, 0)
        colored = (red - blue) * sign > 30  # red for positive, blue for negative
        colored &= abs(red - green) + abs(green - blue) > 40  # not the gray guide lines
        found = center_of(colored)
        # A voxel is 0.22 wide; frame and guide lines shift its center by less than a sixth of it.
        assert found == pytest.approx((right, down), abs=0.035)


def test_zero_is_exactly_white(tmp_path: Path) -> None:
    values = np.zeros((8, 8, 8))
    values[0, 0, 0], values[7, 7, 7] = -1.0, 0.5
    figure = signed_projections(values, CUBE)
    image = pixels(figure, tmp_path)
    panel = panel_pixels(figure, 0, image)
    middle = panel[panel.shape[0] // 3 : panel.shape[0] // 2, panel.shape[1] // 3 :]
    assert (middle[:, : middle.shape[1] // 2] == 255).all()
    assert not (panel == 255).all()


def test_equal_magnitudes_of_both_signs_are_equally_strong(tmp_path: Path) -> None:
    values = np.zeros((4, 4, 4))
    values[:2], values[2:] = -0.25, 0.25
    figure = signed_projections(values, CUBE, limit=1.0)
    panel = panel_pixels(figure, 0, pixels(figure, tmp_path))
    quarter = panel.shape[1] // 4
    negative, positive = (panel[panel.shape[0] // 2, c] for c in (quarter, 3 * quarter))
    assert negative[2] > negative[0] + 10  # blue
    assert positive[0] > positive[2] + 10  # red
    # ColorBrewer's two halves are matched in lightness; 12 of 255 is the mismatch of the published
    # colors themselves (209/229/240 against 253/219/199 on their third step).
    assert abs(negative.mean() - positive.mean()) < 12


def test_axes_carry_meters_of_the_box() -> None:
    bounds = np.array([[0.0, 10.0, 100.0], [3.0, 12.0, 101.0]])
    figure = signed_slices(np.ones((3, 4, 5)), bounds)
    front, side, top = figure.axes[:3]
    assert (front.get_xlim(), front.get_ylim()) == ((0.0, 3.0), (10.0, 12.0))
    assert (side.get_xlim(), side.get_ylim()) == ((101.0, 100.0), (10.0, 12.0))
    assert (top.get_xlim(), top.get_ylim()) == ((0.0, 3.0), (101.0, 100.0))
    assert [axes.get_xlabel() for axes in (front, side, top)] == ["x [m]", "z [m]", "x [m]"]
    assert [axes.get_ylabel() for axes in (front, side, top)] == ["y [m]", "y [m]", "z [m]"]
    scales = [
        axes.get_position().width * figure.get_size_inches()[0] / abs(np.diff(axes.get_xlim())[0])
        for axes in (front, side, top)
    ]
    assert scales == pytest.approx([scales[0]] * 3)  # one meter is equally long in all views


def test_steps_come_in_order_and_state_their_own_scales(field: Any) -> None:
    fields = {500: field.values * 1e-2, 0: field.values, 50: field.values * 0.1}
    figure = projection_steps(fields, field.bounds, common_scale=False, unit="m")
    titles = [axes.get_title() for axes in figure.axes[:3]]
    assert [title.split("\n")[0] for title in titles] == ["step 0", "step 50", "step 500"]
    assert "10^{-3}" in titles[0]
    assert "10^{-5}" in titles[2]
    common = projection_steps(fields, field.bounds)
    limits = {axes.images[0].get_clim() for axes in common.axes[:3]}
    assert len(limits) == 1


@pytest.mark.parametrize("draw", [signed_projections, signed_slices])
def test_voxels_that_do_not_exist_are_gray(draw: Any) -> None:
    values = np.ones((4, 4, 4))
    active = np.zeros((4, 4, 4), np.bool_)
    active[1, 3, 3] = active[2, 2, 2] = True  # the slices cut the second
    values[~active] = 0.0
    figure = draw(values, CUBE, active=active)
    shown = [axes.images[0] for axes in figure.axes[:3]]
    count = 1 if draw is signed_slices else 2
    assert [int((~np.ma.getmaskarray(image.get_array())).sum()) for image in shown] == [count] * 3
    for image in shown:
        assert image.cmap(np.ma.masked_all(1))[0][:3] == pytest.approx(to_rgb(style.MISSING))
    whole = draw(values, CUBE)
    assert not any(np.ma.getmaskarray(axes.images[0].get_array()).any() for axes in whole.axes[:3])
    with pytest.raises(ShapeError, match="active: expected shape"):
        draw(values, CUBE, active=active[1:])


def test_steps_show_which_voxels_existed() -> None:
    fields = {0: np.ones((2, 2, 2)), 5: np.ones((4, 4, 4))}
    active = {0: np.ones((2, 2, 2), np.bool_), 5: np.zeros((4, 4, 4), np.bool_)}
    active[5][1, 2, 3] = True
    figure = projection_steps(fields, CUBE, active=active)
    masks = [np.ma.getmaskarray(axes.images[0].get_array()) for axes in figure.axes[:2]]
    assert not masks[0].any()
    assert np.argwhere(~masks[1]).tolist() == [[2, 1]]  # rows are y, columns x
    with pytest.raises(RangeError, match="active: expected a mask for step 5, got none"):
        projection_steps(fields, CUBE, active={0: active[0]})
