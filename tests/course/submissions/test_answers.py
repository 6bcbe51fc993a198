"""Points for answers: keys stay here, locks count, bad files cost their own points."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.assignment.drawing import draw
from photograd_course.student.predictions import digest
from photograd_course.submissions.answers import Answered, read_answers, score_answers
from photograd_course.submissions.submission import Submission

SOURCE = "x = 1\n"


def lock(letter: str = "a", assignment: str = "90") -> bytes:
    made = {"90.p1": letter}
    when = "2026-01-01T00:00:00+00:00"
    return json.dumps(
        {
            "assignment": assignment,
            "answers": made,
            "locked_at": when,
            "sha256": digest(assignment, made),
        }
    ).encode()


def scored(
    bundle: Bundle, answers: str, locked: bytes | None = None, source: str = SOURCE
) -> dict[str, Answered]:
    files = {"toy.py": source.encode(), "answers.toml": answers.encode()}
    if locked is not None:
        files["predictions.lock.json"] = locked
    results, _, _ = score_answers(bundle, Submission(files))
    assert [result.id for result in results] == [question.id for question in bundle.questions]
    assert all(result.points in (0.0, result.max) for result in results)
    return {result.id: result for result in results}


def generated_key(bundle: Bundle, student: str, source: str = SOURCE) -> float:
    (question,) = [q for q in bundle.questions if q.kind == "generated"]
    return 2 * draw(question, student, source).values["w"]


def test_all_right(bundle: Bundle) -> None:
    key = generated_key(bundle, "Ada")
    text = 'student = "Ada"\n[answers]\n"90.p1" = "A"\n"90.d1" = " B "\n"90.c1" = 12.5\n'
    text += f'"90.g1" = {key}\n'
    assert sum(answer.points for answer in scored(bundle, text, lock()).values()) == 6.0


def test_ids_without_quotes_are_understood(bundle: Bundle) -> None:
    assert scored(bundle, '[answers]\n90.d1 = "b"\n')["90.d1"].points == 2.0


def test_nothing_answered(bundle: Bundle) -> None:
    assert sum(a.points for a in scored(bundle, "").values()) == 0.0


@pytest.mark.parametrize(
    ("locked", "answer", "points"),
    [
        (lock("a"), '"90.p1" = "a"', 1.0),
        (lock("b"), '"90.p1" = "b"', 1.0),  # whatever was predicted
        (lock("a"), "", 1.0),
        (lock("a"), '"90.p1" = "b"', 0.0),  # changed afterwards
        (lock("c"), '"90.p1" = "c"', 0.0),  # no such option
        (None, '"90.p1" = "a"', 0.0),
        (lock("a", "91"), '"90.p1" = "a"', 0.0),
        (lock("a").replace(b'"a"', b'"b"'), '"90.p1" = "b"', 0.0),  # edited
        (b"[]", '"90.p1" = "a"', 0.0),
        (b"[" * 100_000, '"90.p1" = "a"', 0.0),
    ],
)
def test_predictions(bundle: Bundle, locked: bytes | None, answer: str, points: float) -> None:
    assert scored(bundle, f"[answers]\n{answer}\n", locked)["90.p1"].points == points


@pytest.mark.parametrize("answer", ['"a"', '"bb"', '"two"', "2", "true", '["b"]', '"d"', '""'])
def test_wrong_choices(bundle: Bundle, answer: str) -> None:
    result = scored(bundle, f'[answers]\n"90.d1" = {answer}\n')["90.d1"]
    assert (result.points, result.status) == (0.0, "failed")


@pytest.mark.parametrize(
    ("answer", "points"),
    [
        ("12.5", 1),
        ("12.6", 1),
        ('"12.5"', 1),
        ("12.7", 0),
        ("nan", 0),
        ("inf", 0),
        ('"nan"', 0),
        ("true", 0),
        ("[12.5]", 0),
        ('"twelve"', 0),
        ("-12.5", 0),
        ("0", 0),
    ],
)
def test_numbers(bundle: Bundle, answer: str, points: float) -> None:
    assert scored(bundle, f'[answers]\n"90.c1" = {answer}\n')["90.c1"].points == points


def test_generated_questions_follow_student_and_code(bundle: Bundle) -> None:
    students = [f"student {k}" for k in range(12)]
    keys = {student: generated_key(bundle, student) for student in students}
    assert len(set(keys.values())) == 3
    for student, key in keys.items():
        text = f'student = "{student}"\n[answers]\n"90.g1" = {key}\n'
        assert scored(bundle, text)["90.g1"].points == 2.0
    other = generated_key(bundle, "Ada", "y = 2\n")
    text = f'student = "Ada"\n[answers]\n"90.g1" = {other}\n'
    assert scored(bundle, text, source="y = 2\n# a remark\n")["90.g1"].points == 2.0


def test_our_own_key_failing_is_ours(bundle: Bundle) -> None:
    class Keys:
        @staticmethod
        def doubled(*_args: object, **_values: object) -> float:
            return math.nan

    broken = Bundle(**{**bundle.__dict__, "keys": Keys})
    result = scored(broken, '[answers]\n"90.g1" = 4\n')["90.g1"]
    assert (result.status, result.points) == ("error-ours", 0.0)


@pytest.mark.parametrize(
    "data", [b"[answers", b"answers = 3", b"\xff", b"a = " + b"[" * 50_000, b"x = " + b"9" * 5000]
)
def test_files_that_are_no_answers(data: bytes) -> None:
    student, answers, warnings = read_answers(data)
    assert (student, answers) == ("", {})
    assert len(warnings) == 1


def test_no_result_tells_the_key(bundle: Bundle) -> None:
    results = scored(bundle, '[answers]\n"90.d1" = "a"\n"90.c1" = 99\n"90.g1" = 99\n')
    assert {results[k].text for k in ("90.c1", "90.g1")} == {
        "not within 1e-02 of the right value, relatively",
        "not within 1e-03 of the right value, relatively",
    }
    assert results["90.d1"].text == "not right"


def explained(bundle: Bundle) -> Bundle:
    """With an answer to the prediction, and reasons for all."""
    said = {"because": "It halves.\nTwice.", "where": "section 2, Figure 1"}
    made = [
        replace(q, answer="b", **said)
        if q.kind == "prediction"
        else replace(q, because="So it is.")
        for q in bundle.questions
    ]
    return replace(bundle, questions=tuple(made))


def test_a_locked_prediction_is_answered(bundle: Bundle) -> None:
    known = explained(bundle)
    (prediction,) = [q for q in known.questions if q.kind == "prediction"]
    wrong = scored(known, "", lock("a"))["90.p1"]
    assert wrong.points == wrong.max
    assert f"it turned out otherwise: b) {prediction.options[1]}. It halves. Twice" in wrong.text
    assert wrong.text.endswith("see section 2, Figure 1")
    right = scored(known, "", lock("b"))["90.p1"]
    assert right.text.startswith("predicted and locked; right. It halves")
    # One that is not locked could still be made.
    assert "halves" not in scored(known, "")["90.p1"].text
    assert "halves" not in scored(known, '[answers]\n"90.p1" = "a"\n', lock("b"))["90.p1"].text


def test_other_questions_are_answered_after_the_due_date_alone(bundle: Bundle) -> None:
    known = explained(bundle)
    text = '[answers]\n"90.d1" = "a"\n'
    assert "So it is" not in " ".join(a.text for a in scored(known, text, lock()).values())
    closed = scored(replace(known, closed=True), text, lock())
    assert closed["90.d1"].text == "not right. So it is"
    assert closed["90.d1"].points == 0.0
    assert closed["90.p1"].text.count("It halves") == 1
