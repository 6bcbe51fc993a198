"""Frames: what may cross comes back equal, what may not is refused, garbage is only an error."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from photograd_course.worker.codec import PREFIX, FrameError, FunctionId, decode, encode, round_trip


def reader(data: bytes):
    at = 0

    def read(count: int) -> bytes:
        nonlocal at
        if at + count > len(data):
            raise EOFError
        at += count
        return data[at - count : at]

    return read


SCALARS = st.none() | st.booleans() | st.floats() | st.text() | st.integers(-(2**62), 2**62)
ARRAYS = hnp.arrays(
    st.sampled_from([np.float64, np.float32, np.int64, np.int32, np.uint8, np.bool_]),
    hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4),
)
VALUES = st.recursive(
    SCALARS | ARRAYS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)


def same(a: object, b: object) -> bool:
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.tobytes() == b.tobytes()
    if isinstance(a, list):
        return isinstance(b, list) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict):
        return isinstance(b, dict) and list(a) == list(b) and all(same(a[k], b[k]) for k in a)
    return type(a) is type(b) and (a == b or repr(a) == repr(b) == "nan")


@given(VALUES)
@settings(max_examples=150, deadline=None)
def test_what_may_cross_comes_back_equal(value: object) -> None:
    frame = decode(reader(encode("call", 7, value)))
    assert (frame.kind, frame.number) == ("call", 7)
    assert same(value, frame.value)


@pytest.mark.parametrize(
    "value",
    [
        object(),
        {1: 2},
        1 << 70,
        np.zeros(2, complex),
        np.array([None]),
        np.array(["a"]),
        {1.0},
        len,
    ],
)
def test_what_may_not_cross_is_refused(value: object) -> None:
    with pytest.raises(FrameError):
        encode("result", 1, [value])


@pytest.mark.parametrize("number", ["9" * 400, "-9223372036854775808", "18446744073709551616"])
def test_integers_beyond_64_bits_do_not_come_in_either(number: str) -> None:
    head = f'{{"kind": "result", "number": 1, "value": [{number}], "arrays": []}}'.encode()
    with pytest.raises(FrameError, match="64 bits"):
        decode(reader(PREFIX.pack(b"PGF1", len(head), 0) + head))


def test_a_list_in_itself_is_refused() -> None:
    loop: list[object] = []
    loop.append(loop)
    with pytest.raises(FrameError, match="deep"):
        encode("result", 1, loop)


def test_functions_cross_by_number() -> None:
    names = iter(range(3, 9))
    frame = decode(reader(encode("call", 1, {"f": len, "g": [max]}, lambda _: next(names))))
    assert frame.value == {"f": FunctionId(3), "g": [FunctionId(4)]}


def test_a_round_trip_copies_and_keeps_functions() -> None:
    array = np.arange(6.0).reshape(2, 3)
    back = round_trip((array, len, {"x": np.float64(2.5), "y": np.int32(3), "z": np.bool_(True)}))
    assert back[0] is not array
    np.testing.assert_array_equal(back[0], array)
    assert back[1] is len
    assert back[2] == {"x": 2.5, "y": 3, "z": True}
    assert type(back[2]["x"]) is float
    assert type(back[2]["z"]) is bool


@given(st.binary(max_size=300))
@settings(max_examples=300, deadline=None)
def test_garbage_is_an_error_and_nothing_else(data: bytes) -> None:
    with pytest.raises((FrameError, EOFError)):
        decode(reader(data))


@given(st.integers(0, 10_000), st.binary(min_size=1, max_size=4))
@settings(max_examples=300, deadline=None)
def test_a_damaged_frame_is_an_error_or_another_frame(at: int, damage: bytes) -> None:
    data = bytearray(encode("result", 3, {"a": np.arange(5.0), "b": [1, 2.5, "x"]}))
    at %= len(data)
    data[at : at + len(damage)] = damage
    try:
        frame = decode(reader(bytes(data)), max_body=1 << 16)
    except (FrameError, EOFError):
        return
    # What is accepted is a frame like any other: it can be sent on, and arrives as it was.
    again = decode(reader(encode(frame.kind, frame.number, frame.value)))
    assert (again.kind, again.number) == (frame.kind, frame.number)
    assert same(again.value, frame.value)


def test_a_giant_frame_is_refused_before_it_is_read() -> None:
    with pytest.raises(FrameError, match="over the limit"):
        decode(reader(PREFIX.pack(b"PGF1", 10, 1 << 50)))


@pytest.mark.parametrize(
    "header",
    [
        {"kind": "a", "number": 1, "value": {"array": 0}, "arrays": []},
        {"kind": "a", "number": 1, "value": {"array": -1}, "arrays": []},
        {"kind": "a", "number": 1, "value": {"odd": 1}, "arrays": []},
        {"kind": "a", "number": 1, "value": {"a": 1, "b": 2}, "arrays": []},
        {"kind": "a", "number": 1, "value": 0, "arrays": [{"dtype": "O", "shape": [1]}]},
        {"kind": "a", "number": 1, "value": 0, "arrays": [{"dtype": "f8", "shape": [-1]}]},
        {"kind": "a", "number": 1, "value": 0, "arrays": [{"dtype": "f8", "shape": [1 << 39] * 2}]},
        {"kind": "a", "number": 1, "value": 0, "arrays": [{"dtype": "f8", "shape": [True]}]},
        {"kind": 3, "number": 1, "value": 0, "arrays": []},
        {"number": 1, "value": 0, "arrays": []},
        [],
        7,
    ],
)
def test_a_malformed_header_is_refused(header: object) -> None:
    head = json.dumps(header).encode()
    with pytest.raises(FrameError):
        decode(reader(PREFIX.pack(b"PGF1", len(head), 0) + head))


def test_deeply_nested_json_is_refused() -> None:
    head = b'{"kind":"a","number":1,"arrays":[],"value":' + b"[" * 100_000
    with pytest.raises(FrameError):
        decode(reader(PREFIX.pack(b"PGF1", len(head), 0) + head))
