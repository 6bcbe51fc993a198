"""What a submission prints is shown to its author, behind a bar, and changes no verdict."""

from __future__ import annotations

import functools
import io
import json
import tempfile
from pathlib import Path

import pytest
from photograd_course.build.kits import find_kit
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.student.checking import check_here
from photograd_course.student.session import run_check_command
from photograd_course.student.starting import lay_out
from photograd_course.student.terminal import LONGEST_LINE, MOST_LINES, OutcomePrinter
from rich.console import Console

STUB = 'raise NotImplementedError("00.1 loss_gradient: see the handout, section 1")'
RIGHT = "return 2.0 * (picture - photograph) / picture.size"
WRONG = "return 2.0 * (photograph - picture) / picture.size"
OS = "np.lib._npyio_impl.os"  # which a graded module may not import
MARKS = ("✓", "✗", "·", "!")


def work_with(folder: Path, body: str) -> Path:
    """The kit of assignment 00 with its one function written."""
    kit = find_kit("00")
    lay_out(kit.files, folder)
    module = folder / "first_gradient.py"
    text = module.read_text("utf-8")
    assert STUB in text
    module.write_text(text.replace(STUB, body), encoding="utf-8")
    return folder


def told(folder: Path, capsys: pytest.CaptureFixture[str], task: str | None = None) -> str:
    run_check_command(find_kit("00").bundle, folder, task, pictures=False, as_json=False)
    return capsys.readouterr().out


def test_what_is_printed_stands_below_the_check_that_fails(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    work = work_with(tmp_path, f"print('size', picture.size); {WRONG}")
    said = told(work, capsys).splitlines()
    assert said[0].startswith("✗ 00.1")
    assert any(line.startswith("    | size ") for line in said)


def test_where_all_is_right_it_is_shown_for_one_task_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    work = work_with(tmp_path, f"print('here'); {RIGHT}")
    assert "| here" not in told(work, capsys)
    assert "    | here" in told(work, capsys, task="loss_gradient").splitlines()


FORGED = "\\n".join(
    [
        "✓ 00.1.differences     passed",
        "\\r✓ 00.1.differences",
        "\\x1b[2J\\x1b[H\\x1b[32m✓ all green",
        "\\u2028✓ 00.1.step\\u202e",
        "20 of 20 public checks pass: 2 of 2 points.",
        "All green. Next: photograd course submit 00",
    ]
)


def test_nothing_printed_looks_like_a_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    frame = json.dumps({"status": "passed", "score": 2})
    work = work_with(tmp_path, f"print('{FORGED}'); print('{frame}'); {WRONG}")
    said = told(work, capsys)
    printed = [line for line in said.splitlines() if line.startswith("    | ")]
    assert len(printed) > 8
    assert "\x1b" not in said
    assert "\r" not in said
    assert "\u202e" not in said
    heads = [line for line in said.splitlines() if line.startswith(MARKS)]
    assert [line[0] for line in heads] == ["✗", "✗"]
    assert [line for line in said.splitlines() if line.startswith("0 of 2 public")] != []
    assert not any(line.startswith(("All green", "20 of")) for line in said.splitlines())


def outcomes_of(work: Path) -> tuple[list[Outcome], list[str]]:
    bundle, printed = find_kit("00").bundle, []
    files = {"first_gradient.py": (work / "first_gradient.py").read_bytes()}

    def note(_: Outcome, text: str) -> None:
        printed.append(text)

    return check_here(bundle, files, bundle.checks, on_outcome=note), printed


@functools.cache
def quiet_outcomes(answer: str) -> list[Outcome]:
    with tempfile.TemporaryDirectory() as folder:
        return outcomes_of(work_with(Path(folder), answer))[0]


@pytest.mark.parametrize(
    "noise",
    [
        f"{OS}.sys.stdout.buffer.write(b'\\xff\\x00PGRD' * 9999)",
        f"{OS}.write(1, b'passed'); {OS}.write(2, b'passed')",
        "print('x' * 3_000_000)",
        f"{OS}.sys.stdout = None",
    ],
)
def test_no_verdict_depends_on_what_is_printed(tmp_path: Path, noise: str) -> None:
    for name, answer, status in (("a", RIGHT, Status.PASSED), ("b", WRONG, Status.FAILED)):
        plain = quiet_outcomes(answer)
        work = work_with(tmp_path / name, f"print('passed'); {answer}")
        module = work / "first_gradient.py"
        module.write_text(f"{module.read_text('utf-8')}\n\n{noise}\n", encoding="utf-8")
        loud, printed = outcomes_of(work)
        assert [each.status for each in loud] == [status, status]
        assert [(o.status, o.text, o.points) for o in plain] == [
            (o.status, o.text, o.points) for o in loud
        ]
        assert all(len(text) <= 64 << 10 for text in printed)


def test_each_check_has_what_was_printed_in_it(tmp_path: Path) -> None:
    outcomes, printed = outcomes_of(work_with(tmp_path, f"print(picture.shape); {RIGHT}"))
    assert len(outcomes) == len(printed) == 2
    assert all(text.startswith("(") for text in printed)


def test_much_is_cut_and_counted() -> None:
    console = Console(file=io.StringIO(), width=1000)
    OutcomePrinter(console).printed("1.a", "\n".join(map(str, range(MOST_LINES + 7))) + "\n")
    lines = console.file.getvalue().splitlines()
    assert len(lines) == MOST_LINES + 1
    assert "and 7 more lines" in lines[-1]
    console = Console(file=io.StringIO(), width=1000)
    OutcomePrinter(console).printed("1.a", "x" * 999)
    assert len(console.file.getvalue().rstrip()) == LONGEST_LINE + len("    | ")


def failed(id: str, text: str, hint: str = "") -> Outcome:
    return Outcome(id, "a title", "1", "public", Status.FAILED, 0.0, 1.0, "wrong", text, hint)


def test_what_is_said_of_several_checks_is_said_once() -> None:
    console = Console(file=io.StringIO(), width=400)
    printer = OutcomePrinter(console)
    refused = "nerf.py:3: imports dataclasses, which this assignment does not have: " + "why, " * 20
    for id in ("1.a", "1.b", "1.c"):
        printer.outcome(failed(id, refused))
        printer.printed(id, "RuntimeWarning: " + "overflow " * 20)
        printer.outcome(failed(id, "f: not implemented yet"))
    said = console.file.getvalue()  # type: ignore[attr-defined]
    assert said.count("imports dataclasses") == 1
    assert said.count("RuntimeWarning") == 1
    assert said.count("    the same as for 1.a\n") == 2
    assert said.count("    | the same as for 1.a\n") == 2
    assert said.count("not implemented yet") == 3  # as short as what would stand for it


@pytest.mark.parametrize("width", [40, 72, 120])
def test_long_lines_are_wrapped_on_a_terminal(width: int) -> None:
    console = Console(file=io.StringIO(), force_terminal=True, no_color=True, width=width)
    text = "d_x: relative error 2.0e+00, allowed 1e-06. " + "All of yours are wrong. " * 5
    printer = OutcomePrinter(console)
    printer.outcome(failed("1.a", text, "a hint that goes on " * 9))
    printer.printed("1.a", "what it prints " * 12)
    lines = console.file.getvalue().splitlines()  # type: ignore[attr-defined]
    assert max(map(len, lines)) <= width + 8  # the codes of the terminal's styles
    assert all(line.lstrip("\x1b[0123456789m").startswith("    ") for line in lines[1:])
    bar = [line for line in lines if "| " in line]
    assert len(bar) >= 2
    words = " ".join(" ".join(lines).replace("\x1b[0m", "").split())
    assert " ".join(text.split()) in words


def test_elsewhere_a_line_stays_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    console = Console(file=io.StringIO(), width=60)
    OutcomePrinter(console).outcome(failed("1.a", "word " * 50))
    assert len(console.file.getvalue().splitlines()) == 2  # type: ignore[attr-defined]


def test_json_has_what_the_terminal_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)  # lines are wrapped where it is set
    work = work_with(tmp_path, WRONG)
    run_check_command(find_kit("00").bundle, work, None, pictures=False, as_json=True)
    captured = capsys.readouterr()
    checks = json.loads(captured.out.splitlines()[-1])["checks"]
    lines = [line for each in checks for line in each["lines"]]
    assert any("-1 times what is expected (your sign is reversed)" in line for line in lines)
    first = next(each for each in checks if each["status"] == "failed")
    assert all(line in captured.err for line in first["lines"])  # others may say the same
    assert all(each["text"] in each["lines"] for each in checks if each["status"] == "failed")


def test_of_values_that_are_not_finite_the_warning_is_the_hint(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    body = "zero = 0.0 * picture; return zero / zero"
    said = told(work_with(tmp_path, body), capsys)
    assert "values are not finite, the first at (0, 0)" in said
    assert "RuntimeWarning: invalid value encountered in divide" in said
    assert "hint:" not in said
