"""The command as instructors type it: JSON, exit codes, isolation that is not good enough."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from photograd_course.build.seal import bundle_files, seal_bundle
from photograd_course.cli import run


@pytest.fixture
def submission(tmp_path: Path, solution: str) -> Path:
    folder = tmp_path / "Ada"
    folder.mkdir()
    (folder / "toy.py").write_text(solution)
    return folder


def grade(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, dict[str, Any], str]:
    code = run(["course", "grade", "90", *map(str, words), "--json"])
    out, err = capsys.readouterr()
    return code, json.loads(out.splitlines()[-1]) if out else {}, err


@pytest.fixture
def patient(toy: Path, tmp_path: Path) -> Path:
    """The toy with more time: to measure the price of an adjoint is slow beside other programs."""
    folder = tmp_path / "patient" / toy.name
    shutil.copytree(toy, folder)
    manifest = folder / "assignment.toml"
    text, limits = manifest.read_text(), "limits = { seconds = 6, cpu_seconds = 4 }"
    assert limits in text
    manifest.write_text(text.replace(limits, "limits = { seconds = 60, cpu_seconds = 20 }"))
    return folder


def test_one_submission(
    submission: Path, patient: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, result, said = grade(capsys, submission, "--bundle", patient, "--mode", "E")
    assert code == 0
    assert (result["score"], result["max_score"], result["student"]) == (15, 21, "Ada")
    assert {"id", "status", "points", "max"} <= set(result["checks"][0])
    assert "indicative" in said
    assert "15 of 21 points" in said


def test_a_mode_below_the_minimum_is_for_staff_and_no_zero(
    submission: Path, toy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    strict = tmp_path / "strict" / "90_toy"
    shutil.copytree(toy, strict)
    manifest = strict / "assignment.toml"
    manifest.write_text(manifest.read_text().replace('minimum_mode = "E"', 'minimum_mode = "C"'))
    code, result, said = grade(capsys, submission, "--bundle", strict, "--mode", "E")
    assert code == 3
    assert result["score"] is None
    assert {each["status"] for each in result["checks"]} == {"error-ours"}
    assert "weaker than the required C" in said
    code, result, said = grade(
        capsys,
        submission.parent / "Ada",
        "--bundle",
        strict,
        "--mode",
        "E",
        "--out",
        tmp_path / "out",
    )
    assert code == 3
    assert result["needs_staff"] == ["Ada"]
    assert result["grades"][0]["score"] is None


def test_a_short_secret_is_refused(
    submission: Path, toy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    secret = tmp_path / "secret"
    secret.write_text("short")
    code, _, said = grade(
        capsys, submission, "--bundle", toy, "--secret-file", secret, "--mode", "E"
    )
    assert code == 1
    assert "at least 16 characters" in said


@pytest.mark.parametrize(
    ("words", "says"), [(("nowhere",), "nothing"), (("{}", "--mode", "F"), "one of A, B, C, D, E")]
)
def test_wrong_calls(
    words: tuple[str, ...],
    says: str,
    submission: Path,
    toy: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    code, _, said = grade(capsys, *(w.format(submission) for w in words), "--bundle", toy)
    assert code == 1
    assert says in said


def test_a_sealed_bundle_opens_with_its_secret_only(
    submission: Path, patient: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    secret, other = tmp_path / "secret.txt", tmp_path / "other.txt"
    secret.write_text("a secret of the whole course\n")
    other.write_text("a secret of another course\n")
    sealed = tmp_path / "hidden.zip"
    sealed.write_bytes(seal_bundle(bundle_files(patient, {}), secret.read_bytes().strip()))
    words = (submission, "--bundle", sealed, "--mode", "E", "--secret-file")
    code, result, said = grade(capsys, *words, secret)
    assert (code, result["score"], result["max_score"]) == (0, 15, 21), said
    code, _, said = grade(capsys, *words, other)
    assert code == 1
    assert "seal of this course's secret" in said


def test_a_kit_is_no_bundle(
    submission: Path, toy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kit = tmp_path / "kit" / "90_toy"
    shutil.copytree(toy, kit)
    (kit / "toy.py").unlink()
    code, _, said = grade(capsys, submission, "--bundle", kit)
    assert code == 1
    assert "a bundle with the solution" in said
