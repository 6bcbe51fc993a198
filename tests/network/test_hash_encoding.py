"""Multiresolution hash encoding: golden rows, interpolation, collisions, adjoints, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.network import HashEncoding
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants

pytestmark = pytest.mark.usefixtures("core")

PRIMES = (1, 2654435761, 805459861)
SHAPES = {
    "2D": HashEncoding([3, 8, 21], dimensions=2, log2_rows=6, features=3),
    "3D": HashEncoding([2, 5, 13], log2_rows=7, features=2),
    "smoothstep": HashEncoding([2, 5, 13], log2_rows=7, features=2, smoothstep=True),
    "eight rows": HashEncoding([4, 9], log2_rows=3, features=2),
}
each_shape = pytest.mark.parametrize("encoding", SHAPES.values(), ids=SHAPES)


def inputs(encoding: HashEncoding, count: int, dtype: Any = np.float64) -> tuple[Any, Any, Any]:
    """A table, points away from the faces of all levels' cells, cotangents."""
    random = np.random.default_rng(count)
    table = random.normal(size=(encoding.rows, encoding.features))
    p = random.random((40 * count, encoding.dimensions))
    for level in encoding.levels:
        f = p * level.resolution % 1.0
        p = p[(np.minimum(f, 1.0 - f) > 1e-2).all(1)]
    assert len(p) >= count
    d = random.normal(size=(count, encoding.outputs))
    return table.astype(dtype), p[:count].astype(dtype), d.astype(dtype)


def row(level: Any, corner: Any) -> int:
    """The row of a corner [Mueller2022, Eq. 4], in Python's integers."""
    if level.dense:
        return sum(int(i) * (level.resolution + 1) ** a for a, i in enumerate(corner))
    hashed = 0
    for i, prime in zip(corner, PRIMES, strict=False):
        hashed ^= int(i) * prime % 2**32
    return hashed % level.rows


def in_python(encoding: HashEncoding, table: Any, points: Any) -> Any:
    """Features, corner by corner."""
    features = np.zeros((len(points), encoding.outputs))
    sides = np.indices((2,) * encoding.dimensions).reshape(encoding.dimensions, -1).T
    for s, p in enumerate(points):
        for number, level in enumerate(encoding.levels):
            cell = np.minimum(np.floor(p * level.resolution), level.resolution - 1)
            f = p * level.resolution - cell
            for side in sides:
                w = np.prod(np.where(side, f, 1 - f))
                at = slice(number * encoding.features, (number + 1) * encoding.features)
                features[s, at] += w * table[level.first + row(level, cell + side)]
    return features


@pytest.mark.parametrize("name", ["2D", "3D", "eight rows"])
def test_features_are_those_of_the_formulas(name: str) -> None:
    encoding = SHAPES[name]
    table, points, _ = inputs(encoding, 60)
    points[0], points[1] = 0.0, 1.0
    expected = in_python(encoding, table, points)
    np.testing.assert_allclose(encoding.encode(table, points), expected, rtol=1e-12, atol=1e-12)
    single = encoding.encode(table.astype(np.float32), points.astype(np.float32))
    np.testing.assert_allclose(single, expected, atol=2e-5)


# Corners and their rows in tables of 2^14 and 2^19 rows [Eq. 4].
GOLDEN = [
    ((0, 0, 0), 0, 0),
    ((1, 0, 0), 1, 1),
    ((0, 1, 0), 14769, 489905),
    ((0, 0, 1), 6037, 153493),
    ((256, 256, 256), 9472, 402688),
    ((120, 155, 52), 9239, 484375),
    ((202, 245, 79), 12372, 421972),
    ((46, 34, 10), 638, 82558),
    ((205, 148, 30), 6639, 268783),
    ((113, 184, 141), 2648, 346712),
    ((88, 54, 134), 15600, 163056),
    ((109, 13, 133), 11769, 437753),
    ((139, 99, 84), 13084, 45852),
    ((158, 148, 190), 6748, 481884),
    ((44, 172, 198), 16382, 163838),
    ((127, 91, 126), 6850, 481986),
    ((242, 143, 45), 7196, 367644),
    ((153, 3, 149), 5171, 169011),
    ((159, 99, 211), 8227, 139299),
    ((216, 147, 220), 9335, 107639),
]


@pytest.mark.parametrize(("corner", "small", "large"), GOLDEN)
def test_golden_rows(corner: Any, small: int, large: int) -> None:
    for log2_rows, expected in ((14, small), (19, large)):
        encoding = HashEncoding([256], log2_rows=log2_rows, features=1)
        assert not encoding.levels[0].dense
        table = np.zeros((encoding.rows, 1))
        table[expected] = 1.0
        assert encoding.encode(table, np.array([corner]) / 256)[0, 0] == 1.0


def test_the_python_formula_gives_the_golden_rows() -> None:
    for corner, small, large in GOLDEN:
        for log2_rows, expected in ((14, small), (19, large)):
            level = HashEncoding([256], log2_rows=log2_rows, features=1).levels[0]
            assert row(level, corner) == expected


def test_rows_are_taken_evenly() -> None:
    level = HashEncoding([64], log2_rows=10, features=1).levels[0]
    corners = np.indices((64, 64, 64)).reshape(3, -1).T
    load = np.bincount([row(level, corner) for corner in corners[::7]], minlength=level.rows)
    mean = len(corners[::7]) / level.rows
    chi2 = float(((load - mean) ** 2 / mean).sum())
    assert chi2 < level.rows + 5 * np.sqrt(2 * level.rows)  # an even spread: 1024 +- 45


def test_levels_that_fit_are_dense_and_have_no_collisions() -> None:
    encoding = HashEncoding([15, 16, 25, 26, 80], log2_rows=14, features=2)
    assert [level.dense for level in encoding.levels] == [True, True, False, False, False]
    assert [level.rows for level in encoding.levels[:3]] == [16**3, 17**3, 2**14]
    assert encoding.rows == 16**3 + 17**3 + 3 * 2**14


def test_a_dense_level_reproduces_a_trilinear_field() -> None:
    encoding = HashEncoding([7], log2_rows=10, features=1)
    k, j, i = np.meshgrid(*[np.arange(8) / 7] * 3, indexing="ij")

    def field(x: Any, y: Any, z: Any) -> Any:
        return 1 + 2 * x - 3 * y + 4 * z + 5 * x * y * z

    table = field(i, j, k).reshape(-1, 1)
    points = np.random.default_rng(1).random((50, 3))
    got = encoding.encode(table, points)[:, 0]
    # Of cubic terms, a trilinear cell holds what is linear along each axis.
    for p, value in zip(points, got, strict=True):
        cell = np.floor(p * 7)
        corners = [(cell + side) / 7 for side in np.indices((2, 2, 2)).reshape(3, -1).T]
        w = [np.prod(np.where(c * 7 > cell + 0.5, p * 7 - cell, 1 - p * 7 + cell)) for c in corners]
        assert value == pytest.approx(sum(a * field(*c) for a, c in zip(w, corners, strict=True)))


@each_shape
def test_derivatives_agree_with_finite_differences(encoding: HashEncoding) -> None:
    table, points, d = inputs(encoding, 12)

    def function(groups: Any) -> Any:
        return {"features": encoding.encode(groups["table"], groups["points"])}

    def backward(groups: Any, cotangent: Any) -> Any:
        arrays = (groups["table"], groups["points"], cotangent["features"])
        d_table, d_points = encoding.encode_backward(*arrays, d_points=True)
        return {"table": d_table, "points": d_points}

    place, cotangent = {"table": table, "points": points}, {"features": d}
    report = check_gradient_mutants(function, backward, place, cotangent, seed=2)
    assert report, report
    assert check_gradient(function, backward, place, seed=3)
    assert taylor_slope(function, backward, {"table": table, "points": points}, seed=4)


def test_increments_that_meet_in_a_row_are_all_added() -> None:
    encoding = SHAPES["eight rows"]  # a thousand points, 8 corners each, in 8 rows a level
    table, _, _ = inputs(encoding, 1)
    random = np.random.default_rng(5)
    points, d = random.random((1000, 3)), random.normal(size=(1000, encoding.outputs))
    t = random.normal(size=table.shape)
    forward = encoding.encode(t, points)
    d_table, _ = encoding.encode_backward(table, points, d)
    left, right = float((forward * d).sum()), float((t * d_table).sum())
    assert left == pytest.approx(right, rel=1e-12)
    assert abs(left) > 1.0


def test_smoothstep_has_no_jump_at_a_face_and_linear_has_one() -> None:
    for smoothstep in (False, True):
        encoding = HashEncoding([4], log2_rows=8, features=1, smoothstep=smoothstep)
        table = np.random.default_rng(1).normal(size=(encoding.rows, 1))
        sides = np.array([[0.5 - 1e-9, 0.3, 0.7], [0.5 + 1e-9, 0.3, 0.7]])
        _, d_points = encoding.encode_backward(table, sides, np.ones((2, 1)), d_points=True)
        assert d_points is not None
        jump = abs(d_points[1, 0] - d_points[0, 0])
        assert bool(jump < 1e-6) is smoothstep, jump


def test_rows_that_no_point_takes_have_no_derivative() -> None:
    encoding = HashEncoding([16, 64], log2_rows=12, features=2)
    table = np.ones((encoding.rows, 2), np.float32)
    points = np.full((3, 3), 0.37, np.float32)
    d_table, _ = encoding.encode_backward(table, points, np.ones((3, 4), np.float32))
    assert (d_table != 0).any(1).sum() == 16  # 8 corners on each of 2 levels


@same_bits("hash encoding", each=["2D", "3D", "smoothstep"])
def many_points(name: str) -> list[Any]:
    encoding = SHAPES[name]
    table, _, _ = inputs(encoding, 1, np.float32)
    random = np.random.default_rng(1)
    points = random.random((20_000, encoding.dimensions)).astype(np.float32)
    d = random.normal(size=(20_000, encoding.outputs)).astype(np.float32)
    return [
        encoding.encode(table, points),
        *encoding.encode_backward(table, points, d, d_points=True),
    ]


def test_resolutions_follow_the_paper() -> None:
    encoding = HashEncoding.geometric(levels=16, coarsest=16, finest=512)
    resolutions = [level.resolution for level in encoding.levels]
    assert resolutions[0] == 16
    assert resolutions[-1] == 512
    growth = 2 ** (5 / 15)
    assert all(abs(n - 16 * growth**k) <= 1 for k, n in enumerate(resolutions))


def test_what_is_no_encoding_is_refused_by_name() -> None:
    for arguments in (
        {"resolutions": []},
        {"resolutions": [0]},
        {"resolutions": [4], "dimensions": 4},
        {"resolutions": [4], "log2_rows": 25},
        {"resolutions": [4], "features": 0},
    ):
        with pytest.raises(RangeError, match="HashEncoding: "):
            HashEncoding(**arguments)  # type: ignore[arg-type]
    with pytest.raises(RangeError, match=r"HashEncoding.geometric: levels"):
        HashEncoding.geometric(levels=0)
    with pytest.raises(RangeError, match=r"HashEncoding.geometric: finest"):
        HashEncoding.geometric(coarsest=32, finest=16)
    encoding = SHAPES["3D"]
    table, points, d = inputs(encoding, 4)
    with pytest.raises(ShapeError, match=r"HashEncoding.encode: table"):
        encoding.encode(table[1:], points)
    with pytest.raises(DtypeError, match=r"HashEncoding.encode: points"):
        encoding.encode(table, points.astype(np.float32))
    with pytest.raises(ShapeError, match=r"HashEncoding.encode_backward: d_features"):
        encoding.encode_backward(table, points, d[:, 1:])
    points[2, 1] = np.nan
    with pytest.raises(RangeError, match=r"HashEncoding.encode: points"):
        encoding.encode(table, points)
