"""Face, depth and stencil tests against the tables of the graphics APIs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.raster import RasterOptions, Stencil, Visibility, rasterize
from photograd.raster.options import COMPARES, STENCIL_OPS

PIXEL = (1, 1)
BOTH_WAYS = np.array([[0, 1, 2], [0, 2, 1]])  # clockwise as the picture shows it, and not
# By name: new < stored, new == stored, new > stored.
TABLE = {
    "never": (0, 0, 0),
    "less": (1, 0, 0),
    "equal": (0, 1, 0),
    "less_equal": (1, 1, 0),
    "greater": (0, 0, 1),
    "not_equal": (1, 0, 1),
    "greater_equal": (0, 1, 1),
    "always": (1, 1, 1),
}


def at_depth(z: float) -> Any:
    """A triangle around the one pixel."""
    return z * np.array([[-2.0, -2, 1], [6, -2, 1], [-2, 6, 1]])


def draw(z: float, onto: Visibility | None = None, face: int = 0, **options: Any) -> Visibility:
    return rasterize(
        at_depth(z), BOTH_WAYS[:1], PIXEL, RasterOptions(**options), onto=onto, first_face=face
    )


@pytest.mark.parametrize("name", COMPARES)
def test_depth(name: Any) -> None:
    before = draw(2.0)
    for z, expected in zip((1.0, 2.0, 3.0), TABLE[name], strict=True):
        after = draw(z, before, face=7, depth_test=name)
        assert after.face[0, 0] == (7 if expected else 0)
        assert after.depth[0, 0] == (z if expected else 2.0)


def test_depth_is_not_written_unless_asked() -> None:
    after = draw(1.0, draw(2.0), face=7, depth_write=False)
    assert after.face[0, 0] == 7
    assert after.depth[0, 0] == 2.0


@pytest.mark.parametrize("cull", ["none", "back", "front"])
def test_faces(cull: Any) -> None:
    # The world's y points up and the image's down: what runs counter-clockwise in the world, seen
    # by the camera, runs counter-clockwise in the picture that is shown.
    for k, front in ((0, False), (1, True)):
        visibility = rasterize(at_depth(2.0), BOTH_WAYS[k : k + 1], PIXEL, RasterOptions(cull=cull))
        assert visibility.covered[0, 0] == (cull != ("front" if front else "back"))


@pytest.mark.parametrize(("near", "far"), [(1.0, 3.0), (2.0, 2.0), (2.1, 3.0), (1.0, 1.9)])
def test_the_range_of_depths(near: float, far: float) -> None:
    assert draw(2.0, near=near, far=far).covered[0, 0] == (near <= 2.0 <= far)


@pytest.mark.parametrize("name", COMPARES)
@pytest.mark.parametrize("mask", [255, 0x0F])
def test_stencil_compares_the_reference_with_what_is_stored(name: Any, mask: int) -> None:
    for stored in (0x34, 0x53, 0x05):
        rules = Stencil(compare=name, reference=0x13, read_mask=mask)
        before = Visibility.cleared(1, 1, stencil=stored)
        reference, own = 0x13 & mask, stored & mask
        column = 0 if reference < own else 1 if reference == own else 2
        assert draw(2.0, before, stencil=rules).covered[0, 0] == bool(TABLE[name][column])


# By name, of what is stored and the reference 0x5A.
OPERATIONS: dict[str, Callable[[int], int]] = {
    "keep": lambda stored: stored,
    "zero": lambda _: 0,
    "replace": lambda _: 0x5A,
    "increment_clamp": lambda stored: min(stored + 1, 255),
    "decrement_clamp": lambda stored: max(stored - 1, 0),
    "invert": lambda stored: 255 - stored,
    "increment_wrap": lambda stored: (stored + 1) % 256,
    "decrement_wrap": lambda stored: (stored - 1) % 256,
}


@pytest.mark.parametrize("name", STENCIL_OPS)
@pytest.mark.parametrize("mask", [255, 0x3C])
def test_what_becomes_of_the_stencil(name: Any, mask: int) -> None:
    cases = {  # which of the three operations is asked
        "on_fail": {"compare": "never"},
        "on_depth_fail": {"compare": "always"},
        "on_pass": {"compare": "always"},
    }
    for stored in (0, 1, 77, 254, 255):
        for slot, rules in cases.items():
            z = 3.0 if slot == "on_depth_fail" else 1.0
            before = draw(2.0, Visibility.cleared(1, 1, stencil=stored))
            stencil = Stencil(reference=0x5A, write_mask=mask, **{**rules, slot: name})
            after = draw(z, before, stencil=stencil)
            made = OPERATIONS[name](stored)
            assert after.stencil is not None
            assert after.stencil[0, 0] == (stored & ~mask) | (made & mask), (slot, stored)


def test_a_stencil_without_a_buffer_is_refused() -> None:
    with pytest.raises(ShapeError, match=r"rasterize: onto: expected a stencil buffer, got none"):
        draw(1.0, Visibility.cleared(1, 1), stencil=Stencil())
    with pytest.raises(RangeError, match=r"Stencil: reference"):
        Stencil(reference=256)
    with pytest.raises(RangeError, match=r"Stencil: on_pass"):
        Stencil(on_pass="flip")  # type: ignore[arg-type]
