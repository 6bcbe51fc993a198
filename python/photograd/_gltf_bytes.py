"""A glTF file in the making: arrays and images in one buffer, and the file around it."""

from __future__ import annotations

import base64
import io
import json
import struct
from typing import Any

import numpy as np
from PIL import Image

from photograd.types import Array

_ARRAYS, _INDICES = 34962, 34963  # what a view holds, as OpenGL numbers it
_COMPONENTS = {"<u2": 5123, "<u4": 5125, "<f4": 5126}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class GltfBytes:
    """Collects the buffer and the tables that point into it.

    Attributes:
        root: the file's JSON.
    """

    def __init__(self) -> None:
        self.root: dict[str, Any] = {"asset": {"version": "2.0", "generator": "photograd"}}
        self._data = bytearray()

    def entry(self, table: str, value: dict[str, Any]) -> int:
        """Append to a table of the file; its number."""
        rows: list[dict[str, Any]] = self.root.setdefault(table, [])
        rows.append(value)
        return len(rows) - 1

    def attribute(self, rows: Array, *, bounds: bool = False) -> int:
        """The number of an accessor of float32 rows, (V,) or (V, 2) to (V, 4), one a vertex."""
        values = np.ascontiguousarray(rows, "<f4")
        more = {}
        if bounds:
            more = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        return self._accessor(values, _ARRAYS, more)

    def indices(self, faces: Array) -> int:
        """The number of an accessor of vertex numbers (F, 3)."""
        kind = "<u2" if int(faces.max()) < 0xFFFF else "<u4"  # the largest number is reserved
        return self._accessor(np.ascontiguousarray(faces.reshape(-1), kind), _INDICES, {})

    def image(self, name: str, pixels: Array) -> int:
        """The number of an image: a PNG of (H, W, 3 or 4) bytes."""
        stream = io.BytesIO()
        Image.fromarray(pixels).save(stream, "PNG")
        view = self._view(stream.getvalue(), {})
        entry = {"name": name, "bufferView": view, "mimeType": "image/png"}
        return self.entry("images", entry)

    def glb(self) -> bytes:
        """The file: chunks of JSON and bytes [Khronos2021, Sec. 4]."""
        data = bytes(self._data) + b"\0" * (-len(self._data) % 4)
        text = self._json({})
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def gltf(self) -> bytes:
        """The file: JSON, with the bytes as base64 in it."""
        body = base64.b64encode(self._data).decode("ascii")
        return self._json({"uri": f"data:application/octet-stream;base64,{body}"})

    def _json(self, buffer: dict[str, Any]) -> bytes:
        root = {**self.root, "buffers": [{**buffer, "byteLength": len(self._data)}]}
        return json.dumps(root, ensure_ascii=False, allow_nan=False).encode("utf-8")

    def _accessor(self, rows: Array, target: int, more: dict[str, Any]) -> int:
        return self.entry(
            "accessors",
            {
                "bufferView": self._view(rows.tobytes(), {"target": target}),
                "componentType": _COMPONENTS[rows.dtype.newbyteorder("<").str],
                "count": len(rows),
                "type": _TYPES[1 if rows.ndim == 1 else rows.shape[1]],
                **more,
            },
        )

    def _view(self, data: bytes, more: dict[str, Any]) -> int:
        self._data += b"\0" * (-len(self._data) % 4)
        view = {"buffer": 0, "byteOffset": len(self._data), "byteLength": len(data)}
        self._data += data
        return self.entry("bufferViews", {**view, **more})
