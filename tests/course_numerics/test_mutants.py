"""Automatic mutants: the right checker kills them all, weak checkers are found out."""

from __future__ import annotations

import numpy as np
import pytest
from photograd_course.errors import RangeError
from photograd_course.gradcheck import check_accumulation, check_gradient, draw_like
from photograd_course.mutants import (
    check_mutants,
    check_overwriting_mutants,
    make_mutants,
    overwriting_mutants,
)

Arrays = dict[str, np.ndarray]

PLACE = {"color": draw_like((5, 3), seed=1, stream=0), "gain": np.array(1.3)}
COTANGENT = {"image": draw_like((5, 3), seed=2, stream=0), "sum": draw_like((5,), seed=2, stream=1)}


def value(p: Arrays) -> Arrays:
    return {"image": p["gain"] * p["color"] ** 2, "sum": p["color"].sum(axis=1)}


def backward(p: Arrays, d: Arrays) -> Arrays:
    return {
        "color": 2.0 * p["gain"] * p["color"] * d["image"] + d["sum"][:, None],
        "gain": np.array((p["color"] ** 2 * d["image"]).sum()),
    }


def accumulate(p: Arrays, d: Arrays, d_p: Arrays) -> None:
    for name, gradient in backward(p, d).items():
        d_p[name] += gradient


def test_difference_check_kills_every_mutant() -> None:
    report = check_mutants(
        lambda b: check_gradient(value, b, PLACE, seed=3), backward, PLACE, COTANGENT
    )
    assert report, str(report)
    assert set(report.killed) == {
        "zero color",
        "negate color",
        "twice color",
        "permute color",
        "zero gain",
        "negate gain",
        "twice gain",
        "drop cotangent image",
        "drop cotangent sum",
    }
    assert "9 of 9" in str(report)


def test_weak_checkers_are_found_out() -> None:
    finite = check_mutants(
        lambda b: all(np.isfinite(g).all() for g in b(PLACE, COTANGENT).values()),
        backward,
        PLACE,
        COTANGENT,
    )
    assert not finite
    assert len(finite.killed) == 0
    right = backward(PLACE, COTANGENT)["color"].reshape(-1)

    def cosine(b: object) -> bool:
        g = b(PLACE, COTANGENT)["color"].reshape(-1)  # type: ignore[operator]
        return bool(g @ right > 0.9 * np.linalg.norm(g) * np.linalg.norm(right) > 0)

    report = check_mutants(cosine, backward, PLACE, COTANGENT)
    assert "twice color" in report.survived
    assert "negate color" in report.killed
    assert "SURVIVED: twice color" in str(report)


def test_overwriting_mutants_die_by_the_accumulation_check() -> None:
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, PLACE, COTANGENT), accumulate, PLACE, COTANGENT
    )
    assert report, str(report)
    assert report.killed == ("overwrite color", "overwrite gain")
    # From a zeroed buffer one call looks right: a check that calls once cannot see the mistake.
    mutant = overwriting_mutants(accumulate, PLACE, COTANGENT)[0]
    buffers = {name: np.zeros_like(array) for name, array in PLACE.items()}
    mutant.accumulate(PLACE, COTANGENT, buffers)
    np.testing.assert_array_equal(buffers["color"], backward(PLACE, COTANGENT)["color"])


def test_single_array_outputs_drop_a_channel() -> None:
    mutants = make_mutants(
        lambda _, d: {"x": 3.0 * d}, {"x": np.ones((2, 3))}, draw_like((2, 3), seed=4, stream=0)
    )
    assert "drop cotangent channel 0" in [mutant.name for mutant in mutants]


def test_a_mutant_that_changes_nothing_is_an_error() -> None:
    zeros = {name: np.zeros_like(array) for name, array in COTANGENT.items()}
    with pytest.raises(RangeError, match="mutant that changes"):
        make_mutants(backward, PLACE, zeros)
    constant = lambda _, d: {"x": np.ones((2, 3)) * d}  # noqa: E731
    with pytest.raises(RangeError, match="permute x"):
        make_mutants(constant, {"x": np.ones((2, 3))}, 1.0)
    # An extra group keeps its gradient, so overwriting it does change the prefilled buffer.
    with pytest.raises(RangeError, match="accept the original"):
        check_mutants(lambda _: False, backward, PLACE, COTANGENT)
