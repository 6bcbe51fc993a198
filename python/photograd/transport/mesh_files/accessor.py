"""Arrays of a glTF file: typed numbers in its buffers [Khronos2021, Sec. 3.6.2].

Counts are believed only as far as the buffer is long, and the zeros of sparse accessors without a
buffer view only up to a limit, so that a damaged file asks for no memory.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd._json_node import JsonNode
from photograd.errors import IoError, message
from photograd.transport.mesh_files.container import NAME, Container, whole
from photograd.types import Array

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def read_floats(container: Container, reference: JsonNode, width: int) -> Array:
    """An accessor as (count, width) float32; normalized integers become 0..1 or -1..1.

    Args:
        container: the file.
        reference: number of the accessor.
        width: numbers a row.

    Raises:
        IoError: another width, or an accessor that reaches beyond its buffer.
    """
    accessor, values = _read(container, reference)
    if values.shape[1] != width:
        raise IoError(message(NAME, accessor.where, f"{width} components", values.shape[1]))
    if values.dtype.kind == "f" or not _flag(accessor, "normalized"):
        with np.errstate(invalid="ignore"):
            return np.asarray(values, np.float32)
    scaled = np.asarray(values, np.float32) / np.float32(np.iinfo(values.dtype).max)
    bounded: Array = np.maximum(scaled, np.float32(-1))
    return bounded


def read_indices(container: Container, reference: JsonNode) -> Array:
    """An accessor of vertex numbers as (count,) int64.

    Args:
        container: the file.
        reference: number of the accessor.

    Raises:
        IoError: not unsigned integers, one a row.
    """
    accessor, values = _read(container, reference)
    if values.dtype.kind != "u" or values.shape[1] != 1:
        got = f"{values.shape[1]} x {values.dtype}"
        raise IoError(message(NAME, accessor.where, "one unsigned integer a row", got))
    return values[:, 0].astype(np.int64)


def _read(container: Container, reference: JsonNode) -> tuple[JsonNode, Array]:
    accessor = container.entry("accessors", reference)
    kind = accessor["type"].text()
    if kind not in WIDTHS:
        raise IoError(message(NAME, f"{accessor.where}: type", sorted(WIDTHS), kind[:20]))
    dtype = _component(accessor["componentType"])
    count = whole(accessor, 1, 1 << 31, "count")
    container.spend(accessor, count)
    if "bufferView" in accessor:
        values = _rows(container, accessor, dtype, WIDTHS[kind], count)
    elif "sparse" in accessor:
        container.expand(accessor, count * WIDTHS[kind] * dtype.itemsize)
        values = np.zeros((count, WIDTHS[kind]), dtype)
    else:
        raise IoError(message(NAME, accessor.where, "a member 'bufferView'", "none"))
    if "sparse" in accessor:
        values = _replaced(container, accessor["sparse"], values)
    return accessor, values


def _rows(
    container: Container, node: JsonNode, dtype: np.dtype[Any], width: int, count: int
) -> Array:
    """`count` rows of a buffer view, from the node's `byteOffset` on."""
    data, stride = container.view(node["bufferView"])
    size = dtype.itemsize * width
    step = stride or size
    start = whole(node, 0, len(data), "byteOffset", 0)
    if step < size or start + (count - 1) * step + size > len(data):
        got = f"{count} rows of {size} bytes, {step} apart from {start} on, in {len(data)}"
        raise IoError(message(NAME, node.where, "numbers inside of the buffer view", got))
    rows = np.ndarray((count, width), dtype, data, start, (step, dtype.itemsize))
    return np.array(rows)


def _replaced(container: Container, sparse: JsonNode, values: Array) -> Array:
    """`values` with the rows that a sparse accessor lists."""
    count = whole(sparse, 1, len(values), "count")
    indices, rows = sparse["indices"], sparse["values"]
    which = _rows(container, indices, _component(indices["componentType"]), 1, count)[:, 0]
    if which.dtype.kind != "u" or int(which.max()) >= len(values):
        raise IoError(message(NAME, indices.where, f"rows below {len(values)}", which.max()))
    values[which] = _rows(container, rows, values.dtype, values.shape[1], count)
    return values


def _component(node: JsonNode) -> np.dtype[Any]:
    number = whole(node, 0, 1 << 16)
    if number not in COMPONENTS:
        raise IoError(message(NAME, node.where, sorted(COMPONENTS), number))
    return np.dtype(COMPONENTS[number])


def _flag(node: JsonNode, key: str) -> bool:
    if key not in node:
        return False
    if not isinstance(node[key].value, bool):
        raise node[key].wrong("true or false")
    return bool(node[key].value)
