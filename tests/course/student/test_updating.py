"""A copy of an earlier file beside its origin: what differs, which is newer, how to update it."""

from __future__ import annotations

import re

import pytest
from photograd_course.student.record import RECORD_NAME
from photograd_course.student.source_code import OUTSIDE, changed_code, unwritten

from .small_course import Semester

TOY = "91_twice/toy.py"
ORIGIN = "90_toy/toy.py"
LINE = re.compile(r"toy\.py here.*?( beside it\)| has the older one)")
UPDATE = "'photograd course start 91 --update'"


@pytest.fixture
def started(semester: Semester) -> Semester:
    """91 was started with a finished 90 beside it, and is finished."""
    semester.put(ORIGIN, semester.solution("90_toy"))
    semester.course("start", "91")
    semester.put("91_twice/twice.py", semester.solution("91_twice"))
    answers = semester.text("91_twice/answers.toml")
    semester.put("91_twice/answers.toml", answers.replace('.p1" = ""', '.p1" = "a"'))
    return semester


def edit(semester: Semester, path: str, old: str = "np.sum(", new: str = "1 * np.sum(") -> str:
    """Change the code of weighted_sum, or another function, in a file."""
    text = semester.text(path)
    assert old in text
    semester.put(path, text.replace(old, new))
    return semester.text(path)


def noted(semester: Semester) -> str:
    """What `check` and `submit` say alike of the copy; nothing where it is as its origin."""
    said = [
        semester.course("check", "91", "--dir", "91_twice", "--no-pictures"),
        semester.course("submit", "91", "--dir", "91_twice"),
    ]
    lines = {found[0] if (found := LINE.search(text)) else "" for text in said}
    assert len(lines) == 1, said
    return lines.pop()


def test_equal_code_is_not_mentioned(started: Semester) -> None:
    assert noted(started) == ""
    text = started.text(ORIGIN).replace("import numpy", "# mine\nimport numpy")
    started.put(ORIGIN, text.replace('"""The value s', '"""Another docstring: s'))
    assert noted(started) == ""
    said = started.course("start", "91", "91_twice", "--update")
    assert said == f"toy.py: the same code as {started.home}/{ORIGIN}"


def test_a_correction_in_the_origin_is_offered_and_taken(started: Semester) -> None:
    before = started.text(TOY)
    done = edit(started, ORIGIN)
    said = noted(started)
    assert f"differs from {started.home}/{ORIGIN} in weighted_sum;" in said
    assert "since it was taken along, you have changed weighted_sum there" in said
    assert UPDATE in said
    said = started.course("start", "91", "91_twice", "--update")
    assert "what was here is kept as toy.kept-1.py" in said
    assert started.text(TOY) == done
    assert started.text("91_twice/toy.kept-1.py") == before
    assert noted(started) == ""
    edit(started, ORIGIN, "1 * np.sum(", "2 * np.sum(")
    started.course("start", "91", "91_twice", "--update")
    assert started.text("91_twice/toy.kept-2.py") == done


def test_what_was_changed_in_the_copy_alone_stays(started: Semester) -> None:
    mine = edit(started, TOY, "d_s * falling,", "1 * d_s * falling,")
    said = noted(started)
    assert "in weighted_sum_backward; since it was taken along, you have changed" in said
    assert (
        "weighted_sum_backward here. The one here is used; the folder of 90 has the older" in said
    )
    assert UPDATE not in said
    said = started.course("start", "91", "91_twice", "--update")
    assert "toy.py: stays, for it has what " in said
    assert started.text(TOY) == mine


def test_where_both_were_changed_each_side_is_named_and_both_are_kept(started: Semester) -> None:
    mine = edit(started, TOY, "d_s * falling,", "1 * d_s * falling,")
    theirs = edit(started, ORIGIN)
    said = noted(started)
    assert "you have changed weighted_sum_backward here and weighted_sum there" in said
    started.course("start", "91", "91_twice", "--update")
    assert started.text(TOY) == theirs
    assert started.text("91_twice/toy.kept-1.py") == mine


@pytest.mark.parametrize("damage", [None, "", "[]", "{", '{"taken": 3}', '{"taken": {"toy": 1}}'])
def test_without_a_record_nothing_is_guessed(started: Semester, damage: str | None) -> None:
    edit(started, ORIGIN)
    record = started.home / "91_twice" / RECORD_NAME
    if damage is None:
        record.unlink()
    else:
        record.write_text(damage, encoding="utf-8")
    said = noted(started)
    assert "which is newer cannot be told from them" in said
    assert UPDATE in said


def test_a_stub_on_either_side_is_named_and_never_wins(started: Semester) -> None:
    done = started.text(ORIGIN)
    started.put(TOY, started.stub("90_toy"))
    (started.home / "91_twice" / RECORD_NAME).unlink()
    said = started.course("check", "91", "--dir", "91_twice", "--no-pictures", code=1)
    assert "; here weighted_sum, weighted_sum_backward, descend are not written. To take" in said
    started.put(ORIGIN, started.stub("90_toy"))
    started.put(TOY, done)
    assert "; there weighted_sum, weighted_sum_backward, descend are not written" in noted(started)
    said = started.course("start", "91", "91_twice", "--update")
    assert "toy.py: stays, for in " in said
    assert started.text(TOY) == done


def test_a_stub_is_replaced_without_a_copy(semester: Semester) -> None:
    semester.course("start", "91")
    semester.put(ORIGIN, semester.solution("90_toy"))
    said = semester.course("start", "91", "--update")  # in the folder above, as by start
    assert said == f"toy.py: taken from {semester.home}/{ORIGIN}"
    assert semester.text(TOY) == semester.solution("90_toy")
    assert not list((semester.home / "91_twice").glob("*kept*"))


def test_another_copy_does_not_replace_equal_work(started: Semester) -> None:
    (started.home / ORIGIN).unlink()
    mine = started.text(TOY)
    started.put("92_thrice/thrice.py", started.solution("92_thrice"))
    started.put("92_thrice/toy.py", mine.replace("np.sum(", "1 * np.sum("))
    assert "is only another copy" in started.course("start", "91", "91_twice", "--update")
    assert started.text(TOY) == mine


def test_inside_of_the_folder_and_with_a_file_that_is_gone(
    started: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(started.home / "91_twice")
    (started.home / TOY).unlink()
    said = started.course("start", "91", "--update")
    assert f"toy.py: taken from {started.home}/{ORIGIN}" in said
    (started.home / ORIGIN).unlink()
    said = started.course("start", "91", "--update")
    assert "no copy in a folder beside this one; put your file of assignment 90 here" in said
    monkeypatch.chdir(started.home)
    started.course("start", "90", "toy")
    assert "brings no file" in started.course("start", "90", "toy", "--update")


def test_the_folder_of_a_later_assignment_is_not_that_of_an_earlier(
    started: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(started.home / "91_twice")
    before = started.files()
    for words in (("check",), ("submit",), ("predict",), ("questions",), ("check", "--dir", ".")):
        said = started.course(words[0], "90", *words[1:], code=1)
        assert (
            "expected the folder of assignment 90, got that of 91, whose toy.py is a copy" in said
        )
    assert started.files() == before


def test_what_differs_is_named_by_function() -> None:
    base = (
        "import os\nX = 1\n\n\nclass Value:\n    '''Text.'''\n    size = 1\n\n"
        "    def exp(self):\n        return 1\n\n\ndef f(a):\n    '''Text.'''\n    return a\n"
    )
    assert changed_code(base, base.replace("'''Text.'''", "'''Another.'''") + "# end\n") == []
    assert changed_code(base, base.replace("return a", "return  (a)")) == []
    assert changed_code(base, base.replace("return a", "return -a")) == ["f"]
    assert changed_code(base, base.replace("return 1", "return 2")) == ["Value.exp"]
    assert changed_code(base, base.replace("X = 1", "X = 2")) == [OUTSIDE]
    assert changed_code(base, base.replace("size = 1", "size = 2")) == [OUTSIDE]
    assert changed_code(base, base + "def g():\n    pass\n") == ["g"]
    assert changed_code(base, "def f(:\n") == [OUTSIDE]
    assert changed_code("def f(:\n", "def f(:\r\n") == []
    assert changed_code("\0", "\0") == []


def test_stubs_are_found_by_their_text_where_nothing_else_can_be_read() -> None:
    stub = '    raise NotImplementedError("90.1 weighted_sum: see the handout, section 1")\n'
    assert unwritten(f"def weighted_sum(w, x):\n{stub}\ndef g(:\n") == ["weighted_sum"]
    inner = f"def weighted_sum(w, x):\n    for _ in w:\n    {stub}    return 1\n"
    assert unwritten(inner) == ["weighted_sum"]
    assert unwritten("f = lambda: 3\n", ["f"]) == []
    assert unwritten("from other import f\n", ["f"]) == []
    assert unwritten("class V:\n    __mul__ = g\n", ["V.__mul__", "V.exp"]) == ["V.exp"]
