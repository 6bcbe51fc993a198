"""Frames between grader and worker: a length, a JSON header, raw bytes of arrays. Never pickle.

A frame is ``PGF1``, the length of the header (4 bytes, big endian), the length of the body (8), the
header and the body. The header holds ``kind``, ``number``, the tree ``value`` and, for each array,
its dtype and shape; the arrays' bytes follow one another in the body. In the tree an array stands
as ``{"array": k}``, a mapping as ``{"map": {...}}`` and a function of the sender as
``{"function": k}``. Both ends use this file; it needs nothing but NumPy and the standard library.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

MAGIC = b"PGF1"
PREFIX = struct.Struct(">4sIQ")
# The only element types that cross; little endian whatever the machine is.
DTYPES = {"f4": "<f4", "f8": "<f8", "i4": "<i4", "i8": "<i8", "u1": "|u1", "bool": "|b1"}
NAMES = {np.dtype(code): name for name, code in DTYPES.items()}
MAX_HEADER = 8 << 20  # parsed as JSON it takes up to twenty-two times as much memory
MAX_BODY = 256 << 20
MAX_DEPTH = 24
INTEGER_BITS = 63  # with a sign: what NumPy, too, can hold


class FrameError(ValueError):
    """A frame that is not what it should be."""


@dataclass(frozen=True)
class Frame:
    """One decoded frame; functions of the other side are still ``FunctionId``.

    ``size`` is the number of bytes that came.
    """

    kind: str
    number: int
    value: Any
    size: int = 0


@dataclass(frozen=True)
class FunctionId:
    """A function that lives on the other side of the pipe."""

    id: int


def encode(
    kind: str, number: int, value: Any, name_function: Callable[[Any], int] | None = None
) -> bytes:
    """The bytes of one frame.

    Args:
        kind, number: what the frame is, and the number of the request it belongs to.
        value: None, bool, int, float, str, ndarray of an allowed dtype, list, tuple, dict with str
            keys, or a function where ``name_function`` is given; nested at will.
        name_function: gives a function the number by which the other side may call it.

    Raises:
        FrameError: something in ``value`` cannot cross.
    """
    arrays: list[np.ndarray[Any, Any]] = []
    tree = _flatten(value, arrays, name_function, 0)
    described = [{"dtype": NAMES[array.dtype], "shape": list(array.shape)} for array in arrays]
    header = json.dumps({"kind": kind, "number": number, "value": tree, "arrays": described})
    head, body = header.encode("utf-8"), b"".join(array.tobytes() for array in arrays)
    return PREFIX.pack(MAGIC, len(head), len(body)) + head + body


def decode(read: Callable[[int], bytes], *, max_body: int = MAX_BODY) -> Frame:
    """Read one frame.

    Args:
        read: ``read(n)`` returns exactly n bytes or raises EOFError.
        max_body: a frame that announces more is refused before anything is allocated.

    Raises:
        FrameError: the bytes are no frame, or one beyond the limits.
        EOFError: the stream has ended.
    """
    magic, head_size, body_size = PREFIX.unpack(read(PREFIX.size))
    if magic != MAGIC:
        raise FrameError("not a frame")
    if head_size > MAX_HEADER or body_size > max_body:
        raise FrameError(f"a frame of {head_size + body_size} bytes is over the limit")
    head, body = read(head_size), read(body_size)
    try:
        header = json.loads(head)
        arrays = _cut_arrays(header["arrays"], body)
        kind, number = header["kind"], header["number"]
        if not (isinstance(kind, str) and isinstance(number, int)):
            raise FrameError("kind or number missing")
        return Frame(kind, number, _restore(header["value"], arrays, 0), head_size + body_size)
    except FrameError:
        raise
    except (KeyError, TypeError, ValueError, IndexError, RecursionError, MemoryError) as error:
        raise FrameError(f"malformed header: {type(error).__name__}") from error


def round_trip(value: Any) -> Any:
    """What the other side would see: copies, tuples become lists. Functions stay themselves."""
    functions: list[Any] = []

    def name(function: Any) -> int:
        functions.append(function)
        return len(functions) - 1

    data = memoryview(encode("copy", 0, value, name))
    at = 0

    def read(count: int) -> bytes:
        nonlocal at
        at += count
        return bytes(data[at - count : at])

    def put_back(item: Any) -> Any:
        if isinstance(item, FunctionId):
            return functions[item.id]
        if isinstance(item, list):
            return [put_back(each) for each in item]
        if isinstance(item, dict):
            return {key: put_back(each) for key, each in item.items()}
        return item

    return put_back(decode(read).value)


def _flatten(
    value: Any, arrays: list[Any], name_function: Callable[[Any], int] | None, depth: int
) -> Any:
    if depth > MAX_DEPTH:
        raise FrameError("nested too deeply")
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        number = int(value)
        return _bounded(number)
    if isinstance(value, float):  # np.float64 too
        return float(value)
    if isinstance(value, np.generic):
        value = np.asarray(value)
    if isinstance(value, np.ndarray):
        return {"array": _keep(value, arrays)}
    if isinstance(value, (list, tuple)):
        return [_flatten(item, arrays, name_function, depth + 1) for item in value]
    if isinstance(value, dict):
        if not all(isinstance(key, str) for key in value):
            raise FrameError("a dict whose keys are not all strings")
        items = value.items()
        return {"map": {k: _flatten(v, arrays, name_function, depth + 1) for k, v in items}}
    if callable(value) and name_function is not None:
        return {"function": name_function(value)}
    raise FrameError(f"an object of type {type(value).__name__}")


def _bounded(number: int) -> int:
    if abs(number) >= 1 << INTEGER_BITS:
        raise FrameError("an integer beyond 64 bits")
    return number


def _keep(array: np.ndarray[Any, Any], arrays: list[Any]) -> int:
    native = array.dtype.newbyteorder("<") if array.dtype.byteorder == ">" else array.dtype
    if native not in NAMES:
        raise FrameError(f"an array of dtype {array.dtype}")
    arrays.append(np.ascontiguousarray(array, dtype=native).reshape(array.shape))
    return len(arrays) - 1


def _cut_arrays(described: Any, body: bytes) -> list[np.ndarray[Any, Any]]:
    arrays, at = [], 0
    for entry in described:
        dtype, shape = np.dtype(DTYPES[entry["dtype"]]), entry["shape"]
        if len(shape) > 16 or not all(type(n) is int and 0 <= n < 1 << 40 for n in shape):
            raise FrameError("an impossible shape")
        size = math.prod(shape) * dtype.itemsize
        if size > len(body) - at:
            raise FrameError("an array longer than the frame")
        array = np.frombuffer(body, dtype, count=math.prod(shape), offset=at)
        arrays.append(array.reshape(shape).copy())
        at += size
    if at != len(body):
        raise FrameError("bytes that belong to no array")
    return arrays


def _restore(tree: Any, arrays: list[Any], depth: int) -> Any:
    if depth > MAX_DEPTH:
        raise FrameError("nested too deeply")
    if isinstance(tree, list):
        for k, item in enumerate(tree):  # in place: a copy would double what a frame can cost us
            tree[k] = _restore(item, arrays, depth + 1)
        return tree
    if not isinstance(tree, dict):
        return _bounded(tree) if isinstance(tree, int) else tree
    if len(tree) != 1:
        raise FrameError("an unknown node")
    ((tag, content),) = tree.items()
    if tag == "array" and type(content) is int and 0 <= content < len(arrays):
        return arrays[content]
    if tag == "function" and type(content) is int:
        return FunctionId(content)
    if tag == "map" and isinstance(content, dict):
        return {key: _restore(item, arrays, depth + 1) for key, item in content.items()}
    raise FrameError("an unknown node")
