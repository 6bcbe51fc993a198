"""Sixty submissions, of which some hang, some crash and some are no submissions.

The grader may open few files, so that one left open for each submission would end it.
"""

from __future__ import annotations

import csv
import io
import resource
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

HANDED_IN = 60
OPEN_FILES = 50  # fewer than submissions: two workers take some 20, and what runs at all 10
HANGING = {
    7: "while True: pass",
    50: "import time; time.sleep(1e6)",
    51: "while True: pass",
    40: "[0 for _ in iter(int, 1)]",
    59: "sum(iter(int, 1))",
}
# Native crashes, and ends that leave no answer.
CRASH = "import ctypes; ctypes.string_at(0)"
CRASHING = {
    3: CRASH,
    37: "import os; os.abort()",
    38: "import os; os._exit(0)",
    55: "import faulthandler; faulthandler._sigabrt()",
    45: CRASH,
}
MALFORMED = {20: b"no zip", 21: b"PK\x03\x04 half", 22: b""}
WRONG = range(24, 34)


def module(solution: str, number: int) -> str:
    """The submission of one student."""
    head = "    # >>> solution 90.1\n"
    assert head in solution
    if number in WRONG:
        return solution.replace("np.exp(-x)))", "np.exp(x)))")
    statement = HANGING.get(number) or CRASHING.get(number) or "pass"
    # By exec, since the imports of a module are looked at before it runs.
    return solution.replace(head, f"{head}    exec({statement!r})\n") + f"\n# student {number}\n"


def submission(solution: str, number: int) -> bytes:
    if number in MALFORMED:
        return MALFORMED[number]
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("90_toy/toy.py", module(solution, number))
    return data.getvalue()


def _with_few_files() -> None:
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (OPEN_FILES, most))


@pytest.mark.slow
def test_sixty_submissions(quick: Path, solution: str, tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    for number in range(HANDED_IN):
        (folder / f"student{number:03}.zip").write_bytes(submission(solution, number))
    command = [
        sys.executable,
        "-m",
        "photograd_course",
        "course",
        "grade",
        "90",
        str(folder),
        "--bundle",
        str(quick),
        "--mode",
        "E",
        "--jobs",
        "2",
        "--out",
        str(tmp_path / "out"),
    ]
    done = subprocess.run(
        command, check=False, capture_output=True, text=True, preexec_fn=_with_few_files
    )
    assert done.returncode == 0, done.stderr[-2000:]
    with (tmp_path / "out" / "grades.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == HANDED_IN
    bad = {*HANGING, *CRASHING, *MALFORMED, *WRONG}
    for number, row in enumerate(rows):
        assert row["student"] == f"student{number:03}"
        assert row["score"] == ("0" if number in bad else "3"), row
        assert row["status"] == ("submission refused" if number in MALFORMED else "ok")
    pages = list((tmp_path / "out" / "pages").glob("*.html"))
    assert len(pages) == HANDED_IN

    def page(number: int) -> str:
        return (tmp_path / "out" / "pages" / rows[number]["page"]).read_text(encoding="utf-8")

    assert all("no answer within 2 seconds" in page(number) for number in HANGING)
    assert all("the process ended in weighted_sum" in page(number) for number in CRASHING)
    assert all("no readable zip archive" in page(number) for number in MALFORMED)
    first = (tmp_path / "out" / "grades.csv").read_bytes()
    again = subprocess.run([*command, "--json"], check=True, capture_output=True, text=True)
    assert '"changed":[]' in again.stdout
    assert (tmp_path / "out" / "grades.csv").read_bytes() == first
