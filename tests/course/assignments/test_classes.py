"""Wrong solutions die by the class of their mistake, not because a check knows them.

They are those of a review, which had seen no hidden check, and kept all points at the time.
"""

from __future__ import annotations

import pytest

from course.assignments.support import ASSIGNMENTS, judge, lost, source

Change = tuple[str, str]
DESCENT, REFLECTANCE = "01_gradient_descent", "04_reflectance"
ALL_POINTS = "loss = np.array([f(each) for each in x])"
LAST_STEP = "tau * m_hat / (np.sqrt(v_hat) + eps)"
SEARCH = """while not f(x + tau * d) <= start + c * tau * slope:
        tau *= shrink"""
CAPPED = """for _ in range(30):
        if f(x + tau * d) <= start + c * tau * slope:
            break
        tau *= shrink"""
IN_PLACE = """x[i] += eps
        slope[i] = f(x)
        x[i] -= 2.0 * eps
        slope[i] = (slope[i] - f(x)) / (2.0 * eps)
        x[i] += eps"""

# What is wrong: folder, the check that finds it, changes of the solution.
WRONG: dict[str, tuple[str, str, tuple[Change, ...]]] = {
    "one roughness for all rows": (
        REFLECTANCE,
        "04.4.hidden",
        (
            (
                "stretch = np.stack([roughness**2, roughness**2",
                "stretch = np.stack([0 * roughness + roughness[0] ** 2] * 2 + [",
            ),
            (", np.ones(len(wo))], axis=1)\n    viewer", "np.ones(len(wo))], axis=1)\n    viewer"),
        ),
    ),
    "NaN is success": (
        DESCENT,
        "01.3.contraction",
        (
            (
                f"{ALL_POINTS}\n    return x, loss, not loss[n] <= loss[0]",
                f"{ALL_POINTS}\n    return x, loss, loss[n] > loss[0]",
            ),
        ),
    ),
    "differences move the caller's point": (
        DESCENT,
        "01.1.cubic",
        (
            ("        step = np.zeros(len(x))\n        step[i] = eps\n", ""),
            ("slope[i] = (f(x + step) - f(x - step)) / (2.0 * eps)", IN_PLACE),
        ),
    ),
    "descent clears the caller's start": (
        DESCENT,
        "01.3.contraction",
        ((ALL_POINTS, f"{ALL_POINTS}\n    x0[:] = 0.0"),),
    ),
    "Adam clears the caller's start": (
        DESCENT,
        "01.5.sums",
        ((f"{LAST_STEP}\n", f"{LAST_STEP}\n    x0[:] = 0.0\n"),),
    ),
    "a search gives up after 30 trials": (DESCENT, "01.6.descends", ((SEARCH, CAPPED),)),
    "the correction stops at step 50": (
        DESCENT,
        "01.5.sums",
        (("beta1**k", "beta1 ** min(k, 50)"), ("beta2**k", "beta2 ** min(k, 50)")),
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_solution_is_found_by_its_class(name: str) -> None:
    folder, check, changes = WRONG[name]
    text = source(ASSIGNMENTS / folder)
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    assert lost(judge(ASSIGNMENTS / folder, text, tasks=(check.rpartition(".")[0],))) == {check}
