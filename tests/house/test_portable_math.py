"""Where equal bits are promised, nothing is computed with what depends on the processor."""

from __future__ import annotations

import pytest

from support.portable import PROMISED, is_promised, portable_breaches
from support.tree import python_texts


def test_fits_compute_with_portable_functions_only() -> None:
    texts = {path: text for path, text in python_texts().items() if is_promised(path)}
    assert all(any(path.startswith(start) for path in texts) for start in PROMISED)
    assert portable_breaches(texts) == []


@pytest.mark.parametrize(
    "line",
    [
        "np.exp(x)",
        "math.log(x)",
        "numpy.power(x, 2)",
        "np.logaddexp(0, x)",
        "from math import exp",
        "f = np.tanh",
        "x ** 2.4",
        "x ** n",
        "2.0 ** -x",
        "a @ b",
        "a.dot(b)",
        "np.dot(a, b)",
        "np.linalg.norm(x)",
        "np.linalg.inv(x)",
        "np.argsort(x)",
        "x.argsort()",
        "x **= 3",
        "np.einsum('ij,jk', a, b, optimize=True)",
    ],
)
def test_a_breach_is_seen(line: str) -> None:
    assert len(portable_breaches({"x.py": line})) == 1


@pytest.mark.parametrize(
    "line",
    [
        "exp(x)",
        "np.sqrt(x)",
        "2.0**-24",
        "2**32",
        "np.linalg.norm(x, axis=1)",
        "x * x",
        "np.argsort(x, kind='stable')",
        "np.einsum('ij,jk', a, b)",
        "np.square(x).sum()",
        "math.sqrt(x)",
    ],
)
def test_what_is_portable_passes(line: str) -> None:
    assert portable_breaches({"x.py": line}) == []
