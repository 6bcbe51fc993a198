"""Elementary functions with the same bits on every processor.

NumPy chooses its exp, log, power, sin, ... by what the processor can do, in float64 too, and so
does the C library behind `math`. The last bits differ, and an optimization spreads a last bit over
all of its parameters. The functions here are made of +, -, *, /, sqrt and steps without rounding,
each of which IEEE 754 fixes. They stand wherever equal bits are promised.

NumPy's sums, einsum and sqrt may stay: their order, and with it their rounding, depends on the
shape of the arrays alone. BLAS (`@`, dot, linalg) and sorting that is not stable may not; `matmul`,
`norm` and kind="stable" replace them.

The result has the dtype of the argument, float64 for plain numbers; NaN stays NaN. exp, expm1 and
log have the formulas of cpp/photograd/core/exp.h and cpp/photograd/core/log.h; exp and expm1 also
have their bits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .checks import FloatArray

_BLOCK = 1 << 13
"""Elements at a time: a dozen arrays of a block stay in the second-level cache."""


@dataclass(frozen=True)
class _Format:
    """What exp needs to know of a floating-point format."""

    lowest: float  # the argument is clamped: 2^n stays a normal number
    highest: float
    ln2_high: float  # few bits, so that its products with exponents are exact
    ln2_low: float
    coefficients: tuple[float, ...]  # of (exp(r) - 1 - r) / r^2, highest power first
    integer: type[np.signedinteger[Any]]
    bias: int
    mantissa: int


_LOG2_E = 1.4426950408889634
_EXP = (
    1.0 / 6227020800.0,
    1.0 / 479001600.0,
    1.0 / 39916800.0,
    1.0 / 3628800.0,
    1.0 / 362880.0,
    1.0 / 40320.0,
    1.0 / 5040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
)
_EXP_SHORT = (1.98412698e-4, 1.38888889e-3, 8.33333333e-3, 4.16666667e-2, 1.66666667e-1, 0.5)
_DOUBLE = _Format(
    -708.0, 709.0, 6.93147180369123816490e-1, 1.90821492927058770002e-10, _EXP, np.int64, 1023, 52
)
_SINGLE = _Format(-87.0, 88.0, 0.693359375, -2.12194440e-4, _EXP_SHORT, np.int32, 127, 23)

_ATANH = tuple(1.0 / k for k in range(23, 1, -2))
"""Of (atanh(s) - s) / s^3 in s^2; remainder 2e-20 for |s| <= 0.172."""
_ATANH_LONG = tuple(1.0 / k for k in range(33, 1, -2))
_ATANH_SHORT = tuple(1.0 / k for k in range(13, 1, -2))
"""The same; remainders 1e-18 and 7e-9 for |s| <= 1/3."""
_SIN = (
    1.0 / 355687428096000.0,
    -1.0 / 1307674368000.0,
    1.0 / 6227020800.0,
    -1.0 / 39916800.0,
    1.0 / 362880.0,
    -1.0 / 5040.0,
    1.0 / 120.0,
    -1.0 / 6.0,
)
"""Of (sin(r) - r) / r^3 in r^2; remainder 8e-20 for |r| <= pi / 4."""
_COS = (
    -1.0 / 6402373705728000.0,
    1.0 / 20922789888000.0,
    -1.0 / 87178291200.0,
    1.0 / 479001600.0,
    -1.0 / 3628800.0,
    1.0 / 40320.0,
    -1.0 / 720.0,
    1.0 / 24.0,
    -0.5,
)
"""Of (cos(r) - 1) / r^2 in r^2; remainder 4e-21 for |r| <= pi / 4."""
_HALF_PI_HIGH, _HALF_PI_LOW = 1.57079632673412561417, 6.07710050650619224932e-11
"""The product of the first with up to 2^20 quarter turns is exact."""


def exp(x: ArrayLike) -> FloatArray:
    """e^x, relative error below 2e-7 (float32) and 4e-16; saturates instead of overflowing."""
    return _blockwise(_exp, x, wide=False)


def expm1(x: ArrayLike) -> FloatArray:
    """e^x - 1, as accurate as exp, near 0 too."""
    return _blockwise(_expm1, x, wide=False)


def sigmoid(x: ArrayLike) -> FloatArray:
    """1 / (1 + e^-x)."""
    return _blockwise(lambda block: 1.0 / (1.0 + _exp(-block)), x, wide=False)


def softplus(x: ArrayLike) -> FloatArray:
    """ln(1 + e^x), without overflow, as accurate as exp."""
    return _blockwise(_softplus, x, wide=False)


def log(x: ArrayLike) -> FloatArray:
    """Ln x, relative error below 5e-16 before rounding; -inf at 0, NaN below."""
    return _blockwise(_log, x)


def log1p(x: ArrayLike) -> FloatArray:
    """ln(1 + x), as accurate as log, near 0 too; -inf at -1, NaN below."""
    return _blockwise(_log1p, x)


def power(x: ArrayLike, exponent: float) -> FloatArray:
    """x^exponent for x > 0, as exp(exponent ln x).

    The relative error grows with |exponent ln x|, to 2e-15 at 10.
    """
    return _blockwise(lambda block: _exp(exponent * _log(block)), x)


def integer_power(base: float, exponent: int) -> float:
    """base^exponent for an exponent >= 0, by repeated squaring."""
    result = 1.0
    while exponent:
        if exponent & 1:
            result *= base
        base *= base
        exponent >>= 1
    return result


def root(x: ArrayLike, degree: int) -> FloatArray:
    """x^(1 / degree) for a degree of 2 to 5, relative error below 4e-16; NaN for x < 0."""
    return _blockwise(lambda block: _root(block, degree), x)


def sin(x: ArrayLike) -> FloatArray:
    """Sine of radians, absolute error below 3e-16 for |x| < 10^6."""
    return _blockwise(lambda block: _sine(block, 0), x)


def cos(x: ArrayLike) -> FloatArray:
    """Cosine of radians, absolute error below 3e-16 for |x| < 10^6."""
    return _blockwise(lambda block: _sine(block, 1), x)


def matmul(a: FloatArray, b: FloatArray) -> FloatArray:
    """Product of matrices (..., I, J) and (..., J, K), or of matrices and one vector (J,).

    Sums run over J in order. Meant for the small matrices of geometry; large ones take long.
    """
    if b.ndim == 1:
        return matmul(a, b[:, None])[..., 0]
    total = a[..., :, 0, None] * b[..., None, 0, :]
    for j in range(1, b.shape[-2]):
        total = total + a[..., :, j, None] * b[..., None, j, :]
    return np.asarray(total)


def norm(vector: FloatArray) -> float:
    """Euclidean length of a vector (N,)."""
    return float(np.sqrt(np.square(vector).sum()))


def _blockwise(
    function: Callable[[FloatArray], FloatArray], x: ArrayLike, *, wide: bool = True
) -> FloatArray:
    """`function` of the elements, in float64 throughout if `wide`."""
    array = np.asarray(x)
    dtype: Any = array.dtype if array.dtype in (np.float32, np.float64) else np.float64
    inside: Any = np.float64 if wide else dtype
    flat = array.reshape(-1)
    found = np.empty(flat.shape, dtype)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):  # NaN, 0, infinity pass
        for start in range(0, flat.size, _BLOCK):
            part = slice(start, start + _BLOCK)
            found[part] = function(flat[part].astype(inside))
    return found.reshape(array.shape)


def _scaled_exp(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """2^n and q = exp(r) - 1 with x = n ln2 + r and |r| <= ln2 / 2."""
    kind = _SINGLE if x.dtype == np.float32 else _DOUBLE
    x = np.clip(x, kind.lowest, kind.highest)
    n = np.rint(x * _LOG2_E)
    r = (x - n * kind.ln2_high) - n * kind.ln2_low
    q = _polynomial(kind.coefficients, r)
    q *= r * r
    q += r
    bits = (n.astype(kind.integer) + kind.integer(kind.bias)) << kind.integer(kind.mantissa)
    return bits.view(x.dtype), q


def _exp(x: FloatArray) -> FloatArray:
    scale, q = _scaled_exp(x)
    return np.asarray(scale * q + scale)


def _expm1(x: FloatArray) -> FloatArray:
    scale, q = _scaled_exp(x)
    return np.asarray(scale * q + (scale - 1.0))


def _log(x: FloatArray) -> FloatArray:
    m, exponent = np.frexp(x)  # x = 2^exponent m, 1/2 <= m < 1
    low = m < np.sqrt(0.5)
    n = exponent - low.astype(np.float64)
    m = m + m * low
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    p = _polynomial(_ATANH, z)
    found = n * _DOUBLE.ln2_high + (2.0 * (s + s * (p * z)) + n * _DOUBLE.ln2_low)
    edge = np.where(x == 0.0, -np.inf, np.where(x > 0.0, x, np.nan))  # 0, infinity, the rest
    return np.where((x > 0.0) & (x < np.inf), found, edge)


def _log1p(x: FloatArray) -> FloatArray:
    u = 1.0 + x
    kept = u - 1.0  # of x; ln(1 + x) / x is nearly the same for both
    return np.where(kept == x, _log(u), np.where(kept == 0.0, x, _log(u) * (x / kept)))


def _softplus(x: FloatArray) -> FloatArray:
    e = _exp(-np.abs(x))
    s = e / (2.0 + e)  # at most 1/3, and ln(1 + e) = 2 atanh(s)
    z = s * s
    p = _polynomial(_ATANH_SHORT if x.dtype == np.float32 else _ATANH_LONG, z)
    return np.maximum(x, 0.0) + 2.0 * (s + s * (p * z))


def _root(x: FloatArray, degree: int) -> FloatArray:
    """Newton's method, y - (y - x / y^(degree - 1)) / degree; each step doubles the digits."""
    first = x.view(np.int64) // degree + (1023 << 52) * (degree - 1) // degree
    y = first.view(np.float64)  # a piecewise linear guess, at most an eighth from the root
    for _ in range(5):
        below = y.copy()
        for _ in range(degree - 2):
            below *= y
        y = y - (y - x / below) / degree
    return np.where((x > 0.0) & (x < np.inf), y, np.where(x >= 0.0, x, np.nan))


def _sine(x: FloatArray, quarters: int) -> FloatArray:
    """The sine of x and so many quarter turns."""
    turns = np.rint(x * (2.0 / np.pi))
    r = (x - turns * _HALF_PI_HIGH) - turns * _HALF_PI_LOW
    z = r * r
    sine = r + r * (z * _polynomial(_SIN, z))
    cosine = 1.0 + z * _polynomial(_COS, z)
    quarter = turns.astype(np.int64) + quarters
    value = np.where(quarter & 1, cosine, sine)
    return np.where(quarter & 2, -value, value)


def _polynomial(coefficients: tuple[float, ...], x: FloatArray) -> FloatArray:
    """Horner's rule, highest power first."""
    total = coefficients[0] * x
    for coefficient in coefficients[1:-1]:
        total += coefficient
        total *= x
    total += coefficients[-1]
    return total
