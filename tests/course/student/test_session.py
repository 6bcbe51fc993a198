"""What a student is told around the checks of one task, and the pictures of wrong arrays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.image import imread
from photograd_course.cli.course.start import _next_steps
from photograd_course.grading import Check, Trial, check
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.student.pictures import draw_failure
from photograd_course.student.session import earlier_functions


def made(task: str, calls: tuple[str, ...], needs: tuple[str, ...] = ()) -> Check:
    def body(t: Trial) -> None:
        """Something holds."""

    found: Check = check(f"{task}.x", task=task, points=1, calls=calls, needs=needs)(body)
    return found


def test_one_task_alone_names_what_it_builds_upon() -> None:
    first, second = made("1.1", ("f",)), made("1.2", ("g",), ("f",))
    assert earlier_functions([first]) == []
    assert earlier_functions([second]) == ["f"]
    assert earlier_functions([first, second]) == []


def test_predictions_come_before_reading() -> None:
    steps = _next_steps("08", "m", Path("mine"), predicts=True)
    assert [step.split()[0] for step in steps[:3]] == ["cd", "photograd", "read"]
    assert "predict 08" in steps[1]
    assert not any("predict" in s for s in _next_steps("00", "m", Path("mine"), predicts=False))


def test_a_long_title_and_both_kinds_of_arrays_are_drawn(tmp_path: Path) -> None:
    for number, shape in enumerate([(7,), (3, 4)]):
        right = np.arange(float(np.prod(shape))).reshape(shape)
        outcome = Outcome(
            id=f"1.{number}", task="1", title="a title that goes on " * 12, points=0.0, max=1.0,
            visibility="public", status=Status.FAILED, arrays=(right + 1.0, right),
        )  # fmt: skip
        path = draw_failure(outcome, tmp_path)
        assert path is not None
        picture = imread(path)[..., :3]
        assert picture.min() < 0.5  # something is drawn
        # The title keeps away from both sides.
        assert (picture[:30, :3] == 1.0).all()
        assert (picture[:30, -3:] == 1.0).all()
