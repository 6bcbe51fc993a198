"""Derivatives that are computed instead of written, in many spellings, for real assignments.

A way differentiates a function of an array whose values depend on one number each, for the targets
in `evasion_targets`.
"""

from __future__ import annotations

# Name to the body of slope(f, x): the derivative of f at x, number by number.
REAL = {
    "forward": "h = 1e-8\nreturn (f(x + h) - f(x)) / h",
    "backward, step from a call": "h = np.ldexp(1.0, -25)\nreturn (f(x) - f(x - h)) / h",
    "central, step from finfo": (
        "h = np.cbrt(np.spacing(1.0))\nreturn np.divide(np.subtract(f(x + h), f(x - h)), 2 * h)"
    ),
    "central, step from a length": (
        "h = 1.0 / len('0' * 60000)\nreturn (f(x + h) - f(x - h)) * (0.5 / h)"
    ),
    "step from a view of other bits": (
        "h = np.array([4517329193108106637]).view(np.float64)[0]\n"
        "return (f(x + h) - f(x - h)) / (2 * h)"
    ),
    "step from the environment": (
        "h = float(np.__version__.split('.')[0]) / 10.0 ** len(np.__doc__[:6])\n"
        "return (f(x + h) - f(x - h)) / (2 * h)"
    ),
    "step from the data, the largest": (
        "h = np.max(np.abs(x)) / 90001.0\nreturn (f(x + h) - f(x - h)) / (2 * h)"
    ),
    "step from the data, the mean": (
        "h = np.mean(np.abs(x)) / np.hypot(3e4, 4e4)\nreturn (f(x + h) - f(x - h)) / (2 * h)"
    ),
    "relative step, by multiplication": (
        "h = np.exp2(-18.0)\nreturn (f(x * (1 + h)) - f(x * (1 - h))) / (2 * h * x)"
    ),
    "step that grows with the number": (
        "h = np.exp2(-17.0) * np.sqrt(1 + x * x)\nup, down = x + h, x - h\n"
        "return (f(up) - f(down)) / (up - down)"
    ),
    "next bits of the number": (
        "up = np.array(x)\nup.view(np.int64)[...] += 2 ** 30\nreturn (f(up) - f(x)) / (up - x)"
    ),
    "extrapolated twice": (
        "d = lambda h: (f(x + h) - f(x - h)) / (2 * h)\nh = np.exp2(-9.0)\n"
        "return (64 * d(h / 4) - 20 * d(h / 2) + d(h)) / 45"
    ),
    "weights that solve a system": (
        "s = np.arange(-3, 4)\nw = np.linalg.solve(np.vander(s, increasing=True).T.astype(float),"
        " np.eye(7)[1])\nh = np.exp2(-10.0)\n"
        "return sum(a * f(x + k * h) for a, k in zip(w, s)) / h"
    ),
    "a fitted polynomial": (
        "t = np.linspace(-1.0, 1.0, 9)\nh = np.exp2(-9.0)\n"
        "values = np.array([np.ravel(f(x + h * each)) for each in t])\n"
        "return (np.polyfit(t, values, 8)[-2] / h).reshape(np.shape(f(x)))"
    ),
    "a Chebyshev series": (
        "t = np.cos(np.pi * (np.arange(12) + 0.5) / 12)\nh = np.exp2(-7.0)\n"
        "values = np.array([np.ravel(f(x + h * each)) for each in t])\n"
        "series = np.polynomial.chebyshev.chebfit(t, values, 11)\n"
        "slope = np.polynomial.chebyshev.chebder(series)\n"
        "return (np.polynomial.chebyshev.chebval(0.0, slope) / h).reshape(np.shape(f(x)))"
    ),
    "a Chebyshev series over a third of the number": (
        "t = np.cos(np.pi * (np.arange(28) + 0.5) / 28)\nh = 0.3 * x\n"
        "values = np.array([np.ravel(f(x + h * each)) for each in t])\n"
        "series = np.polynomial.chebyshev.chebfit(t, values, 27)\n"
        "slope = np.polynomial.chebyshev.chebder(series)\n"
        "found = np.polynomial.chebyshev.chebval(0.0, slope).reshape(np.shape(f(x)))\n"
        "return found / h"
    ),
    "np.gradient of samples": (
        "h = np.exp2(-17.0)\nvalues = np.stack([f(x + k * h) for k in (-1, 0, 1)])\n"
        "return np.gradient(values, h, axis=0)[1]"
    ),
    "np.diff, and products with reciprocals": (
        "h = np.exp2(-17.0)\npair = np.diff(np.stack([f(x - h), f(x + h)]), axis=0)[0]\n"
        "return np.multiply(pair, np.reciprocal(np.add(h, h)))"
    ),
    "weights in a matrix product": (
        "h = np.exp2(-17.0)\npair = np.stack([f(x + h), f(x - h)], axis=-1)\n"
        "return pair @ np.array([0.5, -0.5]) * np.exp2(17.0)"
    ),
    "shifted by out=": (
        "h, there = np.exp2(-17.0), np.empty_like(x)\nnp.add(x, h, out=there)\nup = f(there)\n"
        "np.subtract(x, h, out=there)\nreturn (up - f(there)) / (2 * h)"
    ),
    "shifted in place": (
        "h, there = np.exp2(-17.0), x.copy()\nthere += h\nup = f(there)\nthere -= 2 * h\n"
        "return (up - f(there)) / (2 * h)"
    ),
    "shifted by np.where": (
        "h, k = np.exp2(-17.0), np.ones(x.shape, bool)\n"
        "return (f(np.where(k, x + h, 0)) - f(np.where(k, x - h, 0))) / (2 * h)"
    ),
    "shifted by a matrix product": (
        "h = np.exp2(-17.0)\nboth = np.stack([x, np.ones_like(x)], axis=-1) @ np.array("
        "[[1.0, 1.0], [h, -h]])\nreturn (f(both[..., 0]) - f(both[..., 1])) / (2 * h)"
    ),
    "shifted by an average": (
        "h = np.exp2(-17.0)\nup = np.mean([x, x + 2 * h], axis=0)\n"
        "down = np.mean([x, x - 2 * h], axis=0)\nreturn (f(up) - f(down)) / (2 * h)"
    ),
    "shifted numbers of Python, one by one": (
        "h, found = 2.0 ** -17, np.empty_like(x)\nfor k, each in np.ndenumerate(x):\n"
        "    up, down = x.copy(), x.copy()\n    up[k], down[k] = float(each) + h, float(each) - h\n"
        "    found[k] = (f(up)[k] - f(down)[k]) / (2 * h)\nreturn found"
    ),
    "a list that is shifted": (
        "h, found = 2.0 ** -17, np.empty_like(x)\nfor k in np.ndindex(x.shape):\n"
        "    each = [x.copy(), x.copy()]\n    each[0][k] += h\n    each[1][k] -= h\n"
        "    found[k] = (f(*each[:1])[k] - f(*each[1:])[k]) / (2 * h)\nreturn found"
    ),
    "longer floats": (
        "h = np.longdouble(2.0) ** -17\nthere = x.astype(np.longdouble)\n"
        "return ((f(there + h) - f(there - h)) / (2 * h)).astype(np.float64)"
    ),
    "a class that shifts": (
        "class Nudged:\n    def __init__(self, h):\n        self.x, self.h = x + h, h\n"
        "    def value(self):\n        return f(self.x)\n"
        "a, b = Nudged(2.0 ** -17), Nudged(-(2.0 ** -17))\n"
        "return (a.value() - b.value()) / (a.h - b.h)"
    ),
    "a generator of shifts": (
        "def places():\n    yield from (x + 2.0 ** -17, x - 2.0 ** -17)\n"
        "up, down = map(f, places())\nreturn (up - down) * 2.0 ** 16"
    ),
}
COMPLEX = {
    "complex by a call": "h = np.ldexp(1.0, -80)\nreturn f(x + np.sqrt(-1 + 0j) * h).imag / h",
    "complex by a view": (
        "h = np.ldexp(1.0, -80)\nz = np.stack([x, np.full_like(x, h)], axis=-1)\n"
        "z = z.view(np.complex128)[..., 0]\nreturn f(z).imag / h"
    ),
    "complex by the Fourier transform": (
        "i = -np.fft.fft([0.0, 1.0, 0.0, 0.0])[1]\nh = np.ldexp(1.0, -80)\n"
        "return f(x + i * h).imag / h"
    ),
    "complex by roots": (
        "i = [each for each in np.roots([1, 0, 1]) if each.imag > 0][0]\n"
        "h = np.ldexp(1.0, -80)\nreturn f(x + i * h).imag / h"
    ),
    "complex by multiplication": (
        "i, h = np.exp(np.log(-1 + 0j) / 2), np.ldexp(1.0, -80)\n"
        "return f(x * (1 + i * h)).imag / (h * x)"
    ),
    "complex, set in place": (
        "h, z = np.ldexp(1.0, -80), x.astype('c16')\nnp.copyto(z.imag, h)\nreturn f(z).imag / h"
    ),
    "a contour integral": (
        "w = np.exp(2j * np.pi * np.arange(24) / 24)\nr = np.hypot(0.03, 0.04)\n"
        "return np.real(sum(f(x + r * each) / each for each in w)) / (24 * r)"
    ),
    "a contour integral, relative": (
        "w = np.exp(2j * np.pi * np.arange(24) / 24)\n"
        "return np.real(sum(f(x * (1 + 0.2 * each)) / each for each in w)) / (24 * 0.2 * x)"
    ),
    "a contour integral by the Fourier transform": (
        "w = np.exp(2j * np.pi * np.arange(32) / 32)\nr = np.hypot(0.03, 0.04)\n"
        "values = np.stack([f(x + r * each) for each in w])\n"
        "return np.fft.fft(values, axis=0)[1].real / (32 * r)"
    ),
}
DUAL = {
    "a class of dual numbers": (
        "return f(Pair(x, np.ones_like(x))).b",
        """
        class Pair:
            __array_priority__ = 100
            def __init__(self, a, b):
                self.a, self.b = a, b
            def __add__(self, o):
                o = lift(o)
                return Pair(self.a + o.a, self.b + o.b)
            __radd__ = __add__
            def __mul__(self, o):
                o = lift(o)
                return Pair(self.a * o.a, self.a * o.b + self.b * o.a)
            __rmul__ = __mul__
            def __neg__(self):
                return self * -1.0
            def __sub__(self, o):
                return self + lift(o) * -1.0
            def __rsub__(self, o):
                return lift(o) - self
        def lift(o):
            return o if isinstance(o, Pair) else Pair(o, 0.0)
        """,
    ),
    "a class of dual numbers, made by a call": (
        "return f(Pair((x, np.ones_like(x))))[1]",
        """
        def lift(o):
            return o if isinstance(o, tuple) else (o, 0.0)
        def times(p, o):
            q = lift(o)
            return Pair((p[0] * q[0], p[0] * q[1] + p[1] * q[0]))
        def plus(p, o):
            q = lift(o)
            return Pair((p[0] + q[0], p[1] + q[1]))
        Pair = type("Pair", (tuple,), {
            "__array_priority__": 100, "__array_ufunc__": None,
            "__add__": plus, "__radd__": plus, "__mul__": times, "__rmul__": times,
            "__sub__": lambda p, o: plus(p, times(Pair(lift(o)), -1.0)),
            "__rsub__": lambda p, o: plus(times(p, -1.0), o),
        })
        """,
    ),
    "polynomials of the library": (
        "there = np.empty(x.shape, object)\nfor k in np.ndindex(x.shape):\n"
        "    there[k] = np.poly1d([1.0, x[k]])\n"
        "return np.array([each.deriv()(0.0) for each in f(there).ravel()]).reshape(x.shape)",
        "",
    ),
    "polynomials of the newer library": (
        "P = np.polynomial.Polynomial\nthere = np.empty(x.shape, object)\n"
        "for k in np.ndindex(x.shape):\n    there[k] = P([x[k], 1.0])\nup = f(there)\n"
        "return np.array([each.deriv()(0.0) for each in up.ravel()]).reshape(x.shape)",
        "",
    ),
    "an array that carries derivatives": (
        "z = np.stack([x, np.ones_like(x)]).view(Jet)\nreturn np.asarray(f(z))[1]",
        """
        class Jet(np.ndarray):
            def __mul__(self, o):
                a = np.asarray(self)
                if not isinstance(o, Jet):
                    return (a * o).view(Jet)
                b = np.asarray(o)
                return np.stack([a[0] * b[0], a[0] * b[1] + a[1] * b[0]]).view(Jet)
            __rmul__ = __mul__
            def __add__(self, o):
                a = np.asarray(self).copy()
                return (a + o if isinstance(o, Jet) else np.stack([a[0] + o, a[1]])).view(Jet)
            __radd__ = __add__
            def __sub__(self, o):
                return self + -1.0 * o
            def __rsub__(self, o):
                return -1.0 * self + o
        """,
    ),
}
