"""Questions and answers on a student's machine: what is said before it is too late."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.questions import Question
from photograd_course.errors import IoError
from photograd_course.student.asking import write_answers
from photograd_course.student.folder import WorkFolder
from photograd_course.student.predictions import prediction_letters, write_lock
from photograd_course.student.sheet import (
    SHOWN_NAME,
    notes_before_submission,
    question_sheet,
    remember_shown,
)
from photograd_course.submissions.answers import read_answers

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
CODE = "def weighted_sum(w, x):\n    total = 0.0\n    return total  # the end\n"
QUESTIONS = (
    Question("90.p1", "prediction", 2, "Up or down?", ("up", "down")),
    Question("90.d1", "diagnosis", 3, "Which line?", ("first", "second", "third")),
    Question(
        "90.g1",
        "generated",
        5,
        "You wrote {quote}: f({a})?",
        draw={"a": tuple(float(k) for k in range(2, 60))},
        quote="weighted_sum",
    ),
)
ANSWERS = 'student = "Ada"  # name\n\n[answers]\n"90.p1" = ""\n"90.d1" = ""\n"90.g1" = ""\n'


@pytest.fixture
def bundle() -> Bundle:
    return replace(read_folder(TOY), questions=QUESTIONS)


@pytest.fixture
def work(tmp_path: Path, bundle: Bundle) -> WorkFolder:
    (tmp_path / "toy.py").write_text(CODE, encoding="utf-8")
    (tmp_path / "answers.toml").write_text(ANSWERS, encoding="utf-8")
    return WorkFolder(tmp_path, bundle.manifest)


def answer(work: WorkFolder, **answers: str) -> None:
    write_answers(
        work.path / "answers.toml", {f"90.{name}": text for name, text in answers.items()}
    )


def test_answers_are_written_in_place_and_the_rest_stays(work: WorkFolder) -> None:
    answer(work, d1="b")
    text = (work.path / "answers.toml").read_text("utf-8")
    assert text == ANSWERS.replace('"90.d1" = ""', '"90.d1" = "b"')
    assert work.answers() == ("Ada", {"90.p1": "", "90.d1": "b", "90.g1": ""})


def test_a_comment_behind_an_answer_stays(work: WorkFolder) -> None:
    path = work.path / "answers.toml"
    form = '  # diagnosis: a letter, a to c; don\'t "guess"'
    for value, comment in (('""', form), ("'a # b'", form), ("3 ", "# 2"), ('"x"', "")):
        path.write_text(f'[answers]\n"90.d1" = {value}{comment}\n', encoding="utf-8")
        answer(work, d1="b")
        kept = (" " if value == "3 " else "") + comment
        assert path.read_text("utf-8") == f'[answers]\n"90.d1" = "b"{kept}\n'


@pytest.mark.parametrize(
    ("before", "after"),
    [
        # Single quotes, and a table behind the answers.
        ("[answers]\n'90.d1' = ''\n", "[answers]\n'90.d1' = \"b\"\n"),
        ("[answers]\n[notes]\nx = 1\n", '[answers]\n"90.d1" = "b"\n[notes]\nx = 1\n'),
        ("[answers]\n90.d1 = 'a' # why\n", '[answers]\n90.d1 = "b" # why\n'),
        ("[answers]\n90.x = 1\n", '[answers]\n90.x = 1\n"90.d1" = "b"\n'),
        ("[answers.90]\nd1 = 'a'\n", '[answers.90]\nd1 = "b"\n'),
        ('answers = {"90.d1" = ""}\n', 'answers = {"90.d1" = "b"}\n'),
        ('[answers]\r\n"90.d1" = ""\r\n', '[answers]\r\n"90.d1" = "b"\r\n'),
        (
            '[answers]\n"90.p1" = """\n"90.d1" = 3"""\n',
            '[answers]\n"90.p1" = """\n"90.d1" = 3"""\n"90.d1" = "b"\n',
        ),
        ("student = 'Ada'\n", 'student = \'Ada\'\n\n[answers]\n"90.d1" = "b"\n'),
        ("", '[answers]\n"90.d1" = "b"\n'),
    ],
)
def test_any_toml_keeps_what_it_holds(work: WorkFolder, before: str, after: str) -> None:
    path = work.path / "answers.toml"
    path.write_bytes(before.encode())
    kept = dict(work.answers()[1])
    answer(work, d1="b")
    assert path.read_bytes().decode() == after
    assert work.answers()[1] == {**kept, "90.d1": "b"}
    assert read_answers(path.read_bytes())[1] == work.answers()[1]


@pytest.mark.parametrize("text", ["[answers", "answers = 3\n", "[answers]\n'90' = 1\n'90' = 2\n"])
def test_a_file_that_cannot_be_kept_is_left_alone(work: WorkFolder, text: str) -> None:
    path = work.path / "answers.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(
        IoError, match=r"predict: answers\.toml: expected (TOML|a table \[answers\]), got "
    ):
        answer(work, d1="b")
    assert path.read_text("utf-8") == text


def test_everything_open_is_named(bundle: Bundle, work: WorkFolder) -> None:
    remember_shown(bundle, work)
    (note,) = notes_before_submission(bundle, work)
    assert "90.p1, 90.d1, 90.g1" in note


def test_nothing_is_said_when_all_is_well(bundle: Bundle, work: WorkFolder) -> None:
    remember_shown(bundle, work)
    answer(work, p1="A", d1="c", g1="-1.5e-3")
    assert notes_before_submission(bundle, work) == []


@pytest.mark.parametrize(
    ("name", "text"), [("d1", "d"), ("d1", "ab"), ("g1", "7/5"), ("g1", "nan")]
)
def test_an_answer_of_the_wrong_form_is_named(
    bundle: Bundle, work: WorkFolder, name: str, text: str
) -> None:
    remember_shown(bundle, work)
    answer(work, **({"p1": "a", "d1": "a", "g1": "1"} | {name: text}))
    (note,) = notes_before_submission(bundle, work)
    assert note.startswith(f"90.{name}: write")
    assert any("<- write" in line for line in question_sheet(bundle, work))


def test_a_missing_name_is_said_and_draws_no_numbers(bundle: Bundle, work: WorkFolder) -> None:
    path = work.path / "answers.toml"
    path.write_text(path.read_text("utf-8").replace("Ada", ""), encoding="utf-8")
    assert any("student is empty" in note for note in notes_before_submission(bundle, work))
    sheet = question_sheet(bundle, work)
    assert sheet[:2] == [
        "Write your name into answers.toml first: it draws the numbers.",
        "Not shown until then: 90.g1.",
    ]
    assert {"Up or down?", "Which line?"} <= set(sheet)
    assert not any("f(" in line for line in sheet)
    remember_shown(bundle, work)
    assert not (work.path / SHOWN_NAME).exists()
    path.write_text(ANSWERS, encoding="utf-8")
    assert any("You wrote" in line for line in question_sheet(bundle, work))
    remember_shown(bundle, work)
    assert (work.path / SHOWN_NAME).exists()


def test_numbers_that_have_changed_since_are_said(bundle: Bundle, work: WorkFolder) -> None:
    answer(work, p1="a", d1="a", g1="1")
    assert any("90.g1 have changed" in note for note in notes_before_submission(bundle, work))
    remember_shown(bundle, work)
    assert notes_before_submission(bundle, work) == []
    module = work.path / "toy.py"
    module.write_text(CODE.replace("the end", "another comment"), encoding="utf-8")
    assert notes_before_submission(bundle, work) == []
    module.write_text(CODE.replace("0.0", "1.0"), encoding="utf-8")
    assert any("90.g1 have changed" in note for note in notes_before_submission(bundle, work))


def test_a_locked_prediction_stands(bundle: Bundle, work: WorkFolder) -> None:
    answer(work, p1="a", d1="a", g1="1")
    made, lacking = prediction_letters(bundle.questions, work.answers()[1])
    assert (made, lacking) == ({"90.p1": "a"}, [])
    write_lock(work.path, "90", made)
    remember_shown(bundle, work)
    assert notes_before_submission(bundle, work) == []
    answer(work, p1="b")
    (note,) = notes_before_submission(bundle, work)
    assert "locked as a" in note
    assert "  locked: a" in question_sheet(bundle, work)
    write_lock(work.path, "90", {"90.p1": "b"})  # a lock that is there stays
    assert "  locked: a" in question_sheet(bundle, work)


def test_a_sheet_quotes_the_submission_and_draws_its_numbers(
    bundle: Bundle, work: WorkFolder
) -> None:
    sheet = "\n".join(question_sheet(bundle, work))
    assert "You wrote return total  # the end: f(" in sheet
    assert "{" not in sheet
    assert "change when the code does" in sheet
