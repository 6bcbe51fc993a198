"""Assignment 03 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.drawing import draw as draw_question
from PIL import Image

from course.assignments.support import ASSIGNMENTS, AssignmentTests, judge, source

FOLDER = ASSIGNMENTS / "03_texture_recovery"
T = np.array([[1.0, 2.0, 4.0], [3.0, 7.0, 5.0]])[:, :, None]
UV = np.array([[0.4, 0.4], [0.9, 0.55], [0.4, 0.4]])
PRINTED = 6e-7  # the handout rounds to six decimals


class TestTextureRecovery(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


def test_check_values_of_samples_and_adjoint(solution) -> None:
    corners = np.array([[0.0, 0.0], [1.0, 1.0]])
    samples = solution.bilinear_sample(T, np.concatenate([UV, corners]))[:, 0]
    np.testing.assert_allclose(samples, [2.93, 4.6, 2.93, 1.0, 5.0], rtol=1e-14)
    back = solution.bilinear_sample_adjoint((2, 3), UV, np.array([[1.0], [2.0], [-3.0]]))
    np.testing.assert_allclose(
        back[:, :, 0], [[-0.42, -0.98, 0.8], [-0.18, -0.42, 1.2]], rtol=1e-13
    )


def test_check_values_of_the_warm_up(solution) -> None:
    """One row of texels is the one-dimensional case."""
    row, places = np.array([2.0, 4.0, 8.0])[None, :, None], np.array([0.4, 0.4, 0.05])
    uv = np.stack([places, np.full(3, 0.5)], axis=1)
    np.testing.assert_allclose(solution.bilinear_sample(row, uv)[:, 0], [3.4, 3.4, 2.0], rtol=1e-14)
    back = solution.bilinear_sample_adjoint((1, 3), uv, np.array([[1.0], [-3.0], [2.0]]))
    np.testing.assert_allclose(back[0, :, 0], [1.4, -1.4, 0.0], atol=1e-14)


def test_check_values_of_loss_curvature_and_recovery(solution) -> None:
    target = np.array([[2.0], [5.0], [3.0]])
    loss, d_T = solution.loss_and_grad(T, UV, target)
    assert abs(loss - 0.343267) < PRINTED
    rows = [[0.1204, 0.280933, -0.106667], [0.0516, 0.1204, -0.16]]
    np.testing.assert_allclose(d_T[:, :, 0], rows, atol=PRINTED)
    rounds = [solution.largest_curvature((2, 3), UV, n) for n in (0, 1, 2, 100)]
    np.testing.assert_allclose(rounds, [1 / 3, 0.420140, 0.429428, 0.448533], atol=PRINTED)
    after, losses, _ = solution.recover_texture(T, UV, target, 1)
    rows = [[0.489982, 0.809958, 4.451843], [2.781421, 6.489982, 5.677765]]
    np.testing.assert_allclose(after[:, :, 0], rows, atol=PRINTED)
    np.testing.assert_allclose(losses, [0.343267, 0.278218], atol=PRINTED)
    assert losses[1] > solution.recover_texture(T, UV, target, 400)[1][-1] >= 0.5 / 3 - 1e-12


def test_check_values_of_mips_and_of_the_menu(solution) -> None:
    rows = np.array([[1.0, 2.0, 4.0, 5.0], [3.0, 7.0, 5.0, 7.0]])[:, :, None]
    levels = solution.build_mips(rows)
    assert levels[1].ravel().tolist() == [3.25, 5.25]
    middle = [solution.bilinear_sample(level, np.array([[0.5, 0.5]]))[0, 0] for level in levels]
    assert middle == [4.5, 4.25, 4.25]  # and 4.375 half-way
    assert abs(np.log2(max(12, 5)) - 3.585) < 5e-4


def test_exchanged_weights_are_as_far_off_as_the_diagnosis_says(solution) -> None:
    rng = np.random.default_rng(0)
    texture, uv = rng.random((32, 32, 1)), rng.random((20_000, 2))
    right = solution.bilinear_sample(texture, uv)
    wrong = solution.bilinear_sample(texture.swapaxes(0, 1), uv[:, ::-1])
    np.testing.assert_allclose(wrong, right, atol=1e-14)  # swapping both changes nothing
    x, y = (np.clip(32 * uv[:, k] - 0.5, 0, 31) for k in (0, 1))
    mirrored = np.stack([np.floor(x) + y - np.floor(y), np.floor(y) + x - np.floor(x)], axis=1)
    wrong = solution.bilinear_sample(texture, (mirrored + 0.5) / 32)  # fractions exchanged
    assert abs(-10 * np.log10(np.mean((wrong - right) ** 2)) - 15.2) < 0.2


def test_predictions_come_true(solution) -> None:
    rng = np.random.default_rng(5)
    uv = rng.random((20_000, 2))
    longest = [2 / solution.largest_curvature((n, n), uv, 80) for n in (8, 16)]
    # 3.70 to 3.92 over four seeds: chance makes some of the smaller texels busier.
    assert 3.4 < longest[1] / longest[0] < 4.3
    truth, uv = rng.random((6, 5, 1)), rng.random((900, 2))
    target = solution.bilinear_sample(truth, uv)
    bound = 2 / solution.largest_curvature((6, 5), uv, 300)
    texture, worst = np.full(truth.shape, 0.5), 0.0
    for share, steps in ((1.05, 120), (0.5, 400)):
        for _ in range(steps):
            texture = texture - share * bound * solution.loss_and_grad(texture, uv, target)[1]
        worst = max(worst, float(np.abs(texture).max()))
    assert worst > 1000
    assert np.abs(texture - truth).max() < 1e-6


def judged(old: str, new: str, *ids: str) -> dict[str, tuple[str, str]]:
    """What public checks say, (text, hint) by id, of the solution with one place changed."""
    text = source(FOLDER)
    assert text.count(old) == 1
    tasks = {id.rpartition(".")[0] for id in ids}
    outcomes = judge(FOLDER, text.replace(old, new), tasks=tasks)
    told = {each.id: (each.text, each.hint) for each in outcomes}
    return {id: told[id] for id in ids}


def test_hints_name_what_is_wrong_and_nothing_else() -> None:
    late = "    losses[n] = loss_and_grad(T, uv, target)[0]\n"
    said = judged(late, "    losses = losses[:n]\n", "03.5.step", "03.5.unseen")
    assert all("n + 1" in hint for _, hint in said.values())
    summed = ("fine = (fine[:, 0::2] + fine[:, 1::2]) / 2", "fine = fine[:, 0::2] + fine[:, 1::2]")
    text, _ = judged(*summed, "03.6.mean")["03.6.mean"]
    assert "mean of level 1" in text
    assert "2 times what is expected" in text
    typed = (
        "        fine = levels[-1]\n",
        "        fine = levels[-1]\n"
        "        if min(fine.shape[:2]) == 1:\n"
        "            raise IndexError('row 1 of one row')\n",
    )
    text, _ = judged(*typed, "03.6.mean")["03.6.mean"]
    assert "2 x 16: where one side is a single texel already" in text
    early = ("while levels[-1].shape[:2] != (1, 1):", "while len(levels[-1]) > 1:")
    text, hint = judged(*early, "03.6.mean")["03.6.mean"]
    assert "average the two along the other" in hint


def test_generated_questions_have_the_answers_that_their_reasons_give() -> None:
    bundle = read_folder(FOLDER)
    keys, text = bundle.keys, source(FOLDER)
    assert keys is not None
    assert keys.sample_of_a_plane(bundle.reference, 2, 6, 0.31, 0.55) == pytest.approx(
        2 * (5 * 0.55 - 0.5) + 6 * (7 * 0.31 - 0.5)
    )
    assert keys.sample_of_a_plane(bundle.reference, 3, 4, 0.98, 0.04) == pytest.approx(24.0)
    assert keys.curvature_of_two_spots(bundle.reference, 7, 2) == pytest.approx(
        2 / 9 * (7**5 + 2**5) / (7**4 + 2**4)
    )
    assert keys.texel_after_steps(bundle.reference, 5, 3) == pytest.approx(5 * -(0.9**3))
    for question in bundle.questions:
        if question.kind == "generated":
            drawn = draw_question(question, "somebody", text)
            assert "{" not in drawn.text
            assert " 1 times" not in drawn.text
            assert np.isfinite(
                getattr(keys, str(question.answer))(bundle.reference, **drawn.values)
            )


@pytest.mark.parametrize(
    ("rows", "columns", "options", "said"),
    [
        (30, 40, (), "16 x 12, measured 3072 times"),
        (4, 40, (), "16 x 2, measured 512 times"),
        (40, 5, (), "2 x 16, measured 512 times"),
        (30, 40, ("--fine", "3", "--samples", "2"), "16 x 12, measured 384 times"),
    ],
)
def test_the_exploration_runs_and_says_what_it_did(
    tmp_path: Path, rows: int, columns: int, options: tuple[str, ...], said: str
) -> None:
    engine = ASSIGNMENTS / "02_backpropagation" / "engine.py"
    for path in (FOLDER / "explore.py", FOLDER / "texture_recovery.py", engine):
        (tmp_path / path.name).write_bytes(path.read_bytes())

    values = np.random.default_rng(0).integers(0, 256, (rows, columns, 3), dtype=np.uint8)
    Image.fromarray(values).save(tmp_path / "mine.png")
    order = [sys.executable, "explore.py", "--image", "mine.png", "--size", "16", "--steps", "9"]
    order += ["--figure", "0"]
    order.extend(options)
    ran = subprocess.run(order, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert f"image: mine.png, {said}" in ran.stdout
    assert "core" in ran.stdout
    assert float(ran.stdout.partition("its gradient is ")[2].partition(" ")[0]) < 1e-12
    assert "the smallest eigenvalue is 1/" in ran.stdout
    assert (tmp_path / "recovered.png").stat().st_size > 5_000
