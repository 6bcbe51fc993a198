"""An alternative's functions take the places of the starter's."""

from __future__ import annotations

import math
from typing import Any

from photograd_course.build.filling import fill

STARTER = '''\
A = 1


class V:
    """Given."""

    x = 2

    def f(self):
        raise NotImplementedError


def g():
    raise NotImplementedError


def last():
    return g()
'''
OWN = '''\
"""Otherwise."""

from __future__ import annotations

import math

from m import A


class V:
    """Not said."""

    def f(self):
        return self.h()

    def h(self):
        return self.x


def g():
    return helper() + A


def helper():
    return math.pi
'''


def test_the_rest_comes_from_the_starter() -> None:
    text = fill(STARTER, OWN, "m")
    names: dict[str, Any] = {}
    exec(text, names)
    assert names["last"]() == math.pi + 1
    assert names["V"]().f() == 2
    assert names["V"].__doc__ == "Given."
    assert not [gone for gone in ("Otherwise", "Not said", "from m", "raise") if gone in text]


def test_what_is_left_out_stays_a_stub() -> None:
    text = fill(STARTER, OWN.partition("def g")[0], "m")
    assert text.count("raise NotImplementedError") == 1
