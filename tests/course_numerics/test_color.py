"""sRGB against known points, compositing by hand, and every gradient by differences."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd_course import color
from photograd_course.errors import DtypeError, ShapeError
from photograd_course.gradcheck import check_gradient, draw_like
from photograd_course.mutants import check_mutants

Arrays = dict[str, np.ndarray]


def assert_proved(function: Any, backward: Any, place: Arrays) -> None:
    """Differences agree and every automatic mutant dies by the same check."""

    def check(candidate: Any) -> object:
        return check_gradient(function, candidate, place, seed=5, steps=(1e-4, 1e-5, 1e-6))

    report = check(backward)
    assert report, str(report)
    cotangent = draw_like(np.shape(function(place)), seed=6, stream=0)
    mutants = check_mutants(check, backward, place, cotangent)
    assert mutants, str(mutants)


def test_srgb_known_points() -> None:
    # Middle gray, and the ends of the two pieces, from the formula of the standard by hand.
    encoded = color.srgb_encode(np.array([0.0, 0.001, 0.18, 0.5, 1.0]))
    np.testing.assert_allclose(
        encoded, [0.0, 0.01292, 0.4613561295, 0.7353569831, 1.0], rtol=0, atol=1e-9
    )
    assert color.srgb_decode(np.array([0.5]))[0] == pytest.approx(0.2140411405, abs=1e-10)


def test_eight_bytes_of_an_image() -> None:
    # Of 255, in linear light, by the formula of the standard; 10 and 11 lie beside its seam.
    bytes_, linear = zip(
        (0, 0.0),
        (1, 0.000303527),
        (10, 0.003035270),
        (11, 0.003346536),
        (64, 0.051269458),
        (128, 0.215860501),
        (188, 0.502886458),
        (255, 1.0),
        strict=True,
    )
    found = color.srgb_decode(np.array(bytes_) / 255)
    np.testing.assert_allclose(found, linear, rtol=0, atol=1e-9)


def test_srgb_round_trip_is_monotonic_and_continuous() -> None:
    linear = np.linspace(-0.5, 2.0, 5001)
    encoded = color.srgb_encode(linear)
    assert (np.diff(encoded) > 0).all()
    # The standard's thresholds are rounded; the two pieces meet within 4e-8 of each other.
    np.testing.assert_allclose(color.srgb_decode(encoded), linear, rtol=0, atol=1e-7)
    assert color.srgb_encode(linear.astype(np.float32)).dtype == np.float32
    assert np.isnan(color.srgb_encode(np.array([np.nan]))).all()


@pytest.mark.parametrize(
    ("pair", "points"),
    [
        ((color.srgb_encode, color.srgb_encode_backward), [-0.3, 0.001, 0.002, 0.01, 0.4, 1.7]),
        ((color.srgb_decode, color.srgb_decode_backward), [-0.3, 0.01, 0.03, 0.06, 0.5, 1.2]),
    ],
)
def test_srgb_gradients(pair: tuple[Callable[..., Any], Callable[..., Any]], points: Any) -> None:
    function, backward = pair
    assert_proved(
        lambda p: function(p["x"]), lambda p, d: {"x": backward(p["x"], d)}, {"x": np.array(points)}
    )


def place() -> Arrays:
    return {
        "color": 0.5 + 0.4 * draw_like((4, 5, 3), seed=1, stream=0),
        "opacity": 0.5 + 0.4 * draw_like((4, 5), seed=1, stream=1),
    }


@pytest.mark.parametrize("shape", [(3,), (4, 5, 3)])
def test_composite_over(shape: tuple[int, ...]) -> None:
    p = {**place(), "background": draw_like(shape, seed=1, stream=2)}
    out = color.composite_over(**p)
    pixel, back = p["color"][2, 3], np.broadcast_to(p["background"], (4, 5, 3))[2, 3]
    np.testing.assert_array_equal(out[2, 3], pixel + (1.0 - p["opacity"][2, 3]) * back)

    def backward(p: Arrays, d_out: np.ndarray) -> Arrays:
        gradients = color.composite_over_backward(**p, d_out=d_out)
        return dict(zip(("color", "opacity", "background"), gradients, strict=True))

    assert_proved(lambda p: color.composite_over(**p), backward, p)


def test_alpha_conversions() -> None:
    p = {"straight": place()["color"], "opacity": place()["opacity"]}
    product = color.premultiply(**p)
    np.testing.assert_allclose(color.unpremultiply(product, p["opacity"]), p["straight"], 1e-15)

    def forth(p: Arrays, d: np.ndarray) -> Arrays:
        names = ("straight", "opacity")
        return dict(zip(names, color.premultiply_backward(**p, d_out=d), strict=True))

    def back(p: Arrays, d: np.ndarray) -> Arrays:
        names = ("color", "opacity")
        return dict(zip(names, color.unpremultiply_backward(**p, d_out=d), strict=True))

    assert_proved(lambda p: color.premultiply(**p), forth, p)
    assert_proved(lambda p: color.unpremultiply(**p), back, place())


def test_nothing_is_divided_by_zero_opacity() -> None:
    pixel, clear = np.array([[0.2, 0.3, 0.4]]), np.array([0.0])
    np.testing.assert_array_equal(color.unpremultiply(pixel, clear), 0.0 * pixel)
    d_color, d_opacity = color.unpremultiply_backward(pixel, clear, np.ones_like(pixel))
    np.testing.assert_array_equal(d_color, 0.0 * pixel)
    np.testing.assert_array_equal(d_opacity, [0.0])


def test_bad_input_is_refused() -> None:
    p = place()
    with pytest.raises(ShapeError, match="opacity: expected shape"):
        color.composite_over(p["color"], p["opacity"][..., None], np.ones(3))
    with pytest.raises(ShapeError, match="background"):
        color.composite_over(p["color"], p["opacity"], np.ones(4))
    with pytest.raises(DtypeError, match="background"):
        color.composite_over(p["color"], p["opacity"], np.ones(3, np.float32))
    with pytest.raises(DtypeError, match="opacity"):
        color.premultiply(p["color"], p["opacity"].astype(np.float32))
    with pytest.raises(ShapeError, match="d_out"):
        color.composite_over_backward(p["color"], p["opacity"], np.ones(3), np.ones(3))
    with pytest.raises(DtypeError, match="srgb_encode: linear"):
        color.srgb_encode(np.array([128], dtype=np.uint8))
    with pytest.raises(ShapeError, match="d_linear"):
        color.srgb_decode_backward(np.ones(3), np.ones(1))
