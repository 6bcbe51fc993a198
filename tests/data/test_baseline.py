"""Captures whose cameras stand too close together for depth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.capture.baseline import MIN_BASELINE_RATIO, baseline_ratio, baseline_warning
from photograd.capture.camera import Camera
from photograd.capture.view import View
from photograd.fitting.loop import Fit
from tests.fit import scene

from support.capture_files import look_at, orbit

BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def views(*positions: tuple[float, float, float]) -> list[View]:
    nothing = np.zeros((2, 2, 4), np.float32)
    found = []
    for k, position in enumerate(positions):
        pose = np.eye(4)
        pose[:3, 3] = position
        found.append(View(f"v{k}", Camera(2, 2, 2.0, 2.0, 1.0, 1.0, pose), nothing))
    return found


@pytest.mark.parametrize(
    ("positions", "expected"),
    [
        ([(0, 0, -4)], 0.0),
        ([(0, 0, -4), (0, 0, -4)], 0.0),
        ([(0, 0, -3), (0, 0, -9)], 0.0),  # along one line of sight
        ([(0, 0, -4), (0.2, 0, -4)], 0.05),
        ([(0, 0, -4), (1.0, 0, -4), (-1.0, 0, -4)], 0.485),
        ([(0, 0, -4), (0, 0, 4)], 2.0),
        ([(0.01, 0, 0), (-0.01, 0, 0)], 0.02 / np.sqrt(3)),  # turns inside of the box
        ([(0, 0, 0), (0, 0, 0)], 0.0),
    ],
)
def test_baseline_over_distance(
    positions: list[tuple[float, float, float]], expected: float
) -> None:
    assert baseline_ratio(views(*positions), BOX) == pytest.approx(expected, rel=1e-2)


def test_the_warning_has_the_number_and_ends_at_the_threshold() -> None:
    assert baseline_warning(views((0, 0, -4), (0.41, 0, -4)), BOX) is None
    said = baseline_warning(views((0, 0, -4), (0.2, 0, -4)), BOX)
    assert said is not None
    expected = f"of 0.05 times their distance from the scene, below {MIN_BASELINE_RATIO:g}:"
    assert expected in said
    around = [View(f"o{k}", c, np.zeros((20, 24, 4), np.float32)) for k, c in enumerate(orbit(9))]
    assert baseline_warning(around, BOX) is None


def test_a_fit_of_views_from_one_direction_warns() -> None:
    capture = scene.capture()
    narrow = []
    for k, view in enumerate(capture.train[:3]):
        pose = look_at(np.array([0.02 * k, 0.0, -3.0]), np.zeros(3))
        narrow.append(replace(view, camera=replace(view.camera, world_from_camera=pose)))
    with pytest.warns(UserWarning, match=r"a baseline of 0\.013 times .*: depth is uncertain"):
        Fit.start(replace(capture, train=tuple(narrow)), scene.options(resolution=8))
    Fit.start(capture, scene.options(resolution=8))  # no warning


def test_the_command_says_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from photograd_course.cli.entry import run

    words = ["fit", str(scene.write(tmp_path / "one", train=1, test=0)), "--out"]
    words += [str(tmp_path / "model"), "--steps", "2", "--resolution", "8", "--rays", "16"]
    assert run(words) == 0
    assert "warning: the training cameras have a baseline of 0 times" in capsys.readouterr().err
