"""An assignment may build upon the student's own module of an earlier one."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.build.judging import Job, Judge
from photograd_course.build.kits import bundle_of
from photograd_course.build.public import kit_files, public_files
from photograd_course.build.seal import bundle_files, open_bundle, seal_bundle
from photograd_course.errors import SceneError
from photograd_course.grading.check import Check
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.grading.runner import Setting, run_checks
from photograd_course.submissions.earlier import setting_with_earlier

from .support import TOY

MANIFEST = """
id = "91"
name = "twice"
title = "Twice the weighted sum"
module = "twice"
submission = ["twice.py", "toy.py"]
prerequisites = ["90"]
hours = 1
imports = ["numpy"]
points = { code = 2, questions = 0 }

[[tasks]]
id = "91.1"
title = "Twice"
functions = ["double"]
"""
MODULE = '''"""Builds upon assignment 90."""

from toy import weighted_sum


def double(w, x):
    """Twice the weighted sum."""
    # >>> solution 91.1
    return 2 * weighted_sum(w, x)
    # <<< solution
'''
CHECKS = '''"""Checks."""

import numpy as np
from photograd_course.grading import Number, Tolerance, check

CLOSE = Tolerance(1e-12, "exact")


@check("91.1.brought", points=1, calls=("weighted_sum",), tolerance=CLOSE)
def brought(t):
    """What you bring is right."""
    t.close("s", t.call("weighted_sum", np.ones(3), np.zeros(3), returns=Number()), 3.0)


@check("91.1.double", points=1, calls=("double",), needs=("weighted_sum",),
       tolerance=CLOSE)
def double(t):
    """It is twice."""
    t.close("s", t.call("double", np.ones(3), np.zeros(3), returns=Number()), 6.0)
'''


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An assignment 91 beside a copy of 90."""
    shutil.copytree(TOY, tmp_path / "90_toy")
    made = tmp_path / "91_twice"
    (made / "checks").mkdir(parents=True)
    texts = {"__init__": '"""Checks."""\n', "task_1": CHECKS}
    files = {f"checks/{name}.py": text for name, text in texts.items()}
    for name, text in {"assignment.toml": MANIFEST, "twice.py": MODULE, **files}.items():
        (made / name).write_text(text, encoding="utf-8")
    return made


def judged(
    bundle: Bundle, files: dict[str, bytes], setting: Callable[[Check], Setting] | None = None
) -> list[Outcome]:
    sources = bundle.hand(files).sources
    use = setting or bundle.setting
    return run_checks(bundle.checks, use, lambda given: LocalStudent(sources, given))


def test_the_solution_finds_what_it_builds_upon(folder: Path) -> None:
    bundle = read_folder(folder)
    assert bundle.reference is not None
    assert bundle.reference.double(np.ones(2), np.zeros(2)) == 4.0
    assert bundle.hand(bundle.solution_files(MODULE)).graded == ("toy", "twice")
    statuses = [each.status for each in judged(bundle, bundle.solution_files(MODULE))]
    assert statuses == [Status.PASSED] * 2
    outcomes = Judge(folder).judge(Job(MODULE)).outcomes
    assert [each["status"] for each in outcomes] == ["passed"] * 2


def test_kits_hold_stubs_and_sealed_bundles_the_solution(folder: Path) -> None:
    assert b"NotImplementedError" in kit_files(folder)["toy.py"]
    assert b"np.exp" not in kit_files(folder)["toy.py"]
    assert "toy.py" not in public_files(folder)
    assert bundle_of(public_files(folder), "91").brought == {}
    sealed = open_bundle(seal_bundle(bundle_files(folder, {}), b"secret"), b"secret")
    assert sealed.reference is not None
    assert sealed.reference.double(np.ones(2), np.zeros(2)) == 4.0


def test_a_wrong_earlier_module_costs_its_own_points_alone(folder: Path) -> None:
    bundle = read_folder(folder)
    wrong = {
        **bundle.solution_files(MODULE),
        "toy.py": b"def weighted_sum(w, x):\n    return 7.0\n",
    }
    first, second = judged(bundle, wrong)
    assert first.status is Status.FAILED
    assert second.status is Status.PASSED
    assert "reference" in second.text


PLAIN = CHECKS.replace('needs=("weighted_sum",),', "").partition("@check")[0] + (
    CHECKS[CHECKS.index('@check("91.1.double"') :].replace('needs=("weighted_sum",),', "")
)


def test_a_wrong_function_that_no_check_here_calls_costs_nothing_and_is_named(folder: Path) -> None:
    (folder / "checks" / "task_1.py").write_text(PLAIN, encoding="utf-8")
    bundle = read_folder(folder)
    right = bundle.solution_files(MODULE)
    wrong = {**right, "toy.py": b"def weighted_sum(w, x):\n    return 7.0\n"}
    (first,) = judged(bundle, wrong)
    assert first.status is Status.FAILED
    for files, status in ((right, Status.PASSED), (wrong, Status.PASSED)):
        (outcome,) = judged(bundle, files, setting_with_earlier(bundle, files))
        assert outcome.status is status
    assert outcome.text == (
        "with the reference's weighted_sum: yours, brought from an earlier assignment, is wrong"
    )
    # A mistake of one's own stays one, and no function of one's own can be replaced.
    own = MODULE.replace("2 * w", "3 * w").encode()
    (outcome,) = judged(bundle, {**wrong, "twice.py": own}, setting_with_earlier(bundle, wrong))
    assert outcome.status is Status.FAILED
    moved = b"from toy import double\n"
    files = {"toy.py": b"def double(w, x):\n    return 7.0\n", "twice.py": moved}
    (outcome,) = judged(bundle, files, setting_with_earlier(bundle, files))
    assert outcome.status is Status.FAILED


def test_a_check_of_an_earlier_function_is_not_passed_by_the_solutions(folder: Path) -> None:
    bundle = read_folder(folder)
    wrong = {
        **bundle.solution_files(MODULE),
        "toy.py": b"def weighted_sum(w, x):\n    return 7.0\n",
    }
    first, second = judged(bundle, wrong, setting_with_earlier(bundle, wrong))
    assert (first.status, second.status) == (Status.FAILED, Status.PASSED)


def test_a_module_that_nobody_has_is_named(folder: Path) -> None:
    text = MANIFEST.replace('"toy.py"', '"nobody.py"')
    (folder / "assignment.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match=r"nobody\.py"):
        read_folder(folder)
