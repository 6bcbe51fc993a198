"""What a student is told around the checks of one task, and the pictures of wrong arrays."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pytest
import typer
from matplotlib.image import imread
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.manifest import read_manifest
from photograd_course.assignment.questions import read_questions
from photograd_course.build.kits import find_kit, list_kits
from photograd_course.cli.course.start import _next_steps
from photograd_course.errors import IoError
from photograd_course.grading import Check, Trial, check
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.student.asking import ask
from photograd_course.student.folder import WorkFolder
from photograd_course.student.next_steps import next_steps
from photograd_course.student.pictures import (
    _planes,
    draw_failure,
    magnified,
    slice_name,
    worst_index,
)
from photograd_course.student.session import earlier_functions, require_brought
from photograd_course.student.terminal import said_of
from rich.console import Console

from support.tree import ROOT


def made(task: str, calls: tuple[str, ...], needs: tuple[str, ...] = ()) -> Check:
    def body(t: Trial) -> None:
        """Something holds."""

    found: Check = check(f"{task}.x", points=1, calls=calls, needs=needs)(body)
    return found


def test_one_task_alone_names_what_it_builds_upon() -> None:
    first, second = made("1.1", ("f",)), made("1.2", ("g",), ("f",))
    assert earlier_functions([first]) == []
    assert earlier_functions([second]) == ["f"]
    assert earlier_functions([first, second]) == []


def test_a_missing_file_of_an_earlier_assignment_is_named() -> None:
    manifest = read_manifest(ROOT / "assignments" / "09_recovering_a_volume")
    require_brought(manifest, {"volume_recovery.py", "volume_rendering.py"})
    with pytest.raises(IoError, match=r"volume_rendering\.py: expected .* assignment 08 beside"):
        require_brought(manifest, {"volume_recovery.py"})


def test_a_stub_of_an_earlier_assignment_says_which_file_to_copy() -> None:
    manifest = read_manifest(ROOT / "assignments" / "07_path_tracing")
    said = said_of("04.5 gltf: see the handout, section 5", manifest)
    assert "'photograd course start 07 --update' copies your reflectance.py" in said
    assert "gltf is from assignment 04" in said
    for own in ("07.2 mis_weight: see the handout, section 2", "ValueError: 04.5 gltf"):
        assert said_of(own, manifest) == own


def test_an_input_that_ends_says_what_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    manifest = read_manifest(ROOT / "assignments" / "07_path_tracing")
    questions = [q for q in read_folder(manifest.folder).questions if q.kind == "prediction"]
    (tmp_path / "answers.toml").write_text("[answers]\n", encoding="utf-8")
    console, given = Console(file=io.StringIO()), iter("b")

    def prompt(_: str) -> str:
        for letter in given:
            return letter
        raise typer.Abort

    monkeypatch.setattr(typer, "prompt", prompt)
    with pytest.raises(typer.Abort):
        ask(questions, WorkFolder(tmp_path, manifest), console)
    assert "are saved in answers.toml; run this again" in console.file.getvalue()
    assert (tmp_path / "answers.toml").read_text("utf-8").endswith(f'"{questions[0].id}" = "b"\n')


def test_predictions_come_before_reading() -> None:
    steps = _next_steps("08", "m", Path("mine"), predicts=True)
    assert [step.split()[0] for step in steps[:3]] == ["cd", "photograd", "photograd"]
    assert "predict 08" in steps[1]
    assert "read 08" in steps[2]
    assert not any("predict" in s for s in _next_steps("00", "m", Path("mine"), predicts=False))


def test_a_long_title_and_both_kinds_of_arrays_are_drawn(tmp_path: Path) -> None:
    for number, shape in enumerate([(7,), (3, 4)]):
        right = np.arange(float(np.prod(shape))).reshape(shape)
        outcome = Outcome(
            id=f"1.{number}",
            task="1",
            title="a title that goes on " * 12,
            points=0.0,
            max=1.0,
            visibility="public",
            status=Status.FAILED,
            arrays=(right + 1.0, right),
        )
        path = draw_failure(outcome, tmp_path)
        assert path is not None
        picture = imread(path)[..., :3]
        assert picture.min() < 0.5  # something is drawn
        # The title keeps away from both sides.
        assert (picture[:30, :3] == 1.0).all()
        assert (picture[:30, -3:] == 1.0).all()


def test_the_slice_with_the_worst_entry_is_drawn_named_and_marked() -> None:
    right = np.zeros((3, 4, 2, 1))
    got = right.copy()
    got[2, 1, 1, 0] = 5.0
    got[0, 0, 0, 0] = 1.0
    worst = worst_index(got, right)
    assert worst == (2, 1, 1, 0)
    assert slice_name(got.shape, worst) == " (slice [:, :, 1, 0])"
    yours = _planes(got, right).axes[0]
    (image,) = yours.get_images()
    np.testing.assert_array_equal(np.asarray(image.get_array()), got[:, :, 1, 0])
    (frame,) = yours.patches
    assert frame.get_xy() == (0.5, 1.5)  # around row 2, column 1
    # An axis of length 1 is no slice; what is not finite is furthest off.
    assert slice_name((1, 3, 4), (0, 2, 1)) == ""
    assert slice_name((1, 3, 4, 3), (0, 2, 1, 2)) == " (slice [0, :, :, 2])"
    got[1, 0, 0, 0] = np.nan
    assert worst_index(got, right) == (1, 0, 0, 0)


def test_a_small_difference_is_seen_on_a_scale_of_its_own() -> None:
    right = np.random.default_rng(1).uniform(-1.0, 1.0, (6, 20))
    got = right.copy()
    got[2, 3] += 1e-5
    figure = _planes(got, right)
    values, _, difference = (axes.get_images()[0] for axes in figure.axes[:2] + figure.axes[3:4])
    assert values.get_clim() == (-1.0, 1.0)
    low, high = difference.get_clim()
    assert 1e-5 <= high == -low < 2e-5
    assert figure.axes[3].get_title() == f"difference, magnified × {1 / high:,.0f}"
    assert magnified(1.0, 1.5) == "difference"
    got[0, 0] = np.nan
    assert _planes(got, right).axes[3].get_images()[0].get_clim() == (low, high)


@pytest.mark.parametrize("shape", [(6, 30), (40, 4), (20, 20), (2, 60), (60, 2)])
def test_no_label_is_cut_off(shape: tuple[int, int]) -> None:
    right = np.random.default_rng(1).normal(size=shape)
    figure = _planes(1e3 * right, right)
    figure.suptitle("a title\nof two lines")
    figure.draw_without_rendering()
    inside = figure.bbox
    for axes in figure.axes:
        box = axes.get_tightbbox()
        assert box is not None
        assert inside.x0 <= box.x0
        assert box.x1 <= inside.x1
        assert inside.y0 <= box.y0
        assert box.y1 <= inside.y1


def test_after_a_submission_the_next_assignment_is_named() -> None:
    lines = next_steps(find_kit("01").bundle, "01_submission.zip")
    assert "01_submission.zip" in lines[0]
    assert "answered in the report" in lines[1]
    assert lines[2].startswith("Then: photograd course start 02   (A backpropagation engine")
    assert len(next_steps(find_kit("00").bundle, "a.zip")) == 2  # it asks for no predictions
    last = find_kit(list_kits()[-1]).bundle
    assert not any("start" in line for line in next_steps(last, "a.zip"))


def test_where_a_prediction_is_answered_is_a_place_of_the_handout() -> None:
    asked = 0
    for folder in sorted(path.parent for path in (ROOT / "assignments").glob("*/questions.toml")):
        handout = (folder / "handout.md").read_text("utf-8")
        for question in read_questions(folder):
            for kind, number in re.findall(r"(section|Figure) (\d+)", question.where):
                form = rf"^## {number}\. " if kind == "section" else rf"^\*Figure {number}\."
                assert re.search(form, handout, re.MULTILINE), (question.id, question.where)
            asked += bool(question.where)
    assert asked > 30
