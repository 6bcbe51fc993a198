"""Which graphs of passes are refused, what is run, and what is kept."""

from __future__ import annotations

from typing import Any

import pytest
from photograd.errors import RangeError
from photograd.frame import Pass, PassGraph


def one(*values: Any) -> int:
    return sum(values) + 1


A = Pass("first", one, ("in",), ("a",))
B = Pass("second", one, ("a",), ("b",))
C = Pass("third", one, ("in", "b"), ("c",))


@pytest.mark.parametrize(
    ("passes", "said"),
    [
        (
            [Pass("blur", one, ("in", "a"), ("a",))],
            "'blur', which reads and writes 'a'.*previous.a",
        ),
        ([B, A], "'a' of 'second'"),
        ([A, Pass("again", one, ("in",), ("a",))], "'a' of 'again', which 'first' has written"),
        ([Pass("over", one, (), ("in",))], "'in' of 'over', which 'the inputs' has written"),
        ([A, Pass("first", one, ("a",), ("b",))], "two of the name 'first'"),
        ([A, Pass("typo", one, ("aa",), ("b",))], "'aa' of 'typo'.*'a'"),
    ],
)
def test_hazards_are_refused_with_names(passes: list[Pass], said: str) -> None:
    with pytest.raises(RangeError, match=f"PassGraph: .*{said}"):
        PassGraph(passes, ["in"])


def test_passes_run_in_order_and_all_buffers_are_kept() -> None:
    order: list[str] = []
    result = PassGraph([A, B, C], ["in"]).run({"in": 1}, report=order.append)
    assert dict(result.buffers) == {"in": 1, "a": 2, "b": 3, "c": 5}
    assert order == list(result.milliseconds) == ["first", "second", "third"]
    with pytest.raises(RangeError, match="'d'"):
        result["d"]


def test_what_is_not_asked_for_is_neither_run_nor_kept() -> None:
    graph = PassGraph([A, B, C], ["in"])
    assert [each.name for each in graph.needed_for(["b"])] == ["first", "second"]
    result = graph.run({"in": 1}, ["b"])
    assert dict(result.buffers) == {"b": 3}
    with pytest.raises(RangeError, match=r"needed_for: name: .*'nothing'"):
        graph.run({"in": 1}, ["nothing"])


def test_an_input_that_is_not_given_is_named() -> None:
    with pytest.raises(RangeError, match="a buffer 'in', got other"):
        PassGraph([A], ["in"]).run({"other": 1})


def test_a_pass_has_to_return_what_it_writes() -> None:
    two = Pass("two", one, ("in",), ("a", "b"))
    with pytest.raises(RangeError, match="a tuple of 2 buffers from 'two', got int"):
        PassGraph([two], ["in"]).run({"in": 1})


def test_the_table_names_what_is_read_and_written() -> None:
    assert PassGraph([A, B], ["in"]).table() == (
        "pass    reads  writes\nfirst   in     a\nsecond  a      b"
    )
