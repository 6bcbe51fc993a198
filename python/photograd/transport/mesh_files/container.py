"""The outer layers of a glTF file: JSON, and the bytes that it speaks of [Khronos2021, Sec. 3.6].

A .glb holds chunks: JSON, then at most one buffer. A .gltf is the JSON alone; its buffers are files
beside it, or base64 in the text.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import unquote

from photograd_course.input_files import read_file
from photograd_course.limits import EXPANSION, MODEL_ELEMENTS, Limit

from photograd._files import inside
from photograd._json_node import JsonNode
from photograd.errors import IoError, message

NAME = "read_model"


@dataclass
class Container:
    """A parsed file.

    Attributes:
        path: where it lies.
        root: its JSON.
        embedded: the buffer of a .glb, or none.
        asked: what was asked for so far, limit by limit; a small file can name its parts often.
    """

    path: Path
    root: JsonNode
    embedded: bytes | None
    asked: dict[Limit, int] = field(default_factory=dict)
    _buffers: dict[int, bytes] = field(default_factory=dict)
    _arrays: dict[str, list[JsonNode]] = field(default_factory=dict)

    def spend(self, node: JsonNode, elements: int) -> None:
        """Count vertices, triangles or texels before they are allocated.

        Args:
            node: on whose behalf errors speak.
            elements: how many.

        Raises:
            IoError: more than `MODEL_ELEMENTS` altogether.
        """
        self._count(node, MODEL_ELEMENTS, elements)

    def expand(self, node: JsonNode, size: int) -> None:
        """Count bytes of an array that the file does not hold, before it is allocated.

        Args:
            node: on whose behalf errors speak.
            size: bytes.

        Raises:
            IoError: more than `EXPANSION` altogether.
        """
        self._count(node, EXPANSION, size)

    def _count(self, node: JsonNode, limit: Limit, amount: int) -> None:
        total = self.asked[limit] = self.asked.get(limit, 0) + amount
        if total > limit.value():
            got = f"{total:,}"
            raise IoError(message(NAME, node.where, limit.expected(), got, limit.remedy()))

    def entries(self, name: str) -> list[JsonNode]:
        """The elements of an array of the file.

        Args:
            name: of the array.

        Raises:
            IoError: no such array.
        """
        if name not in self._arrays:
            self._arrays[name] = self.root[name].items()
        return self._arrays[name]

    def entry(self, name: str, reference: JsonNode) -> JsonNode:
        """The element of the array `name` that `reference` points at.

        Raises:
            IoError: no such element.
        """
        entries = self.entries(name)
        return entries[whole(reference, 0, len(entries) - 1)]

    def view(self, reference: JsonNode) -> tuple[memoryview, int]:
        """Bytes of a buffer view and its stride, 0 if it has none.

        Args:
            reference: number of the buffer view.

        Raises:
            IoError: a view that is not inside of its buffer.
        """
        view = self.entry("bufferViews", reference)
        data = self._buffer(view["buffer"])
        start, length = whole(view, 0, len(data), "byteOffset", 0), view["byteLength"]
        count = whole(length, 0, len(data) - start)
        stride = whole(view, 4, 252, "byteStride", 0) if "byteStride" in view else 0
        return memoryview(data)[start : start + count], stride

    def _buffer(self, reference: JsonNode) -> bytes:
        buffer = self.entry("buffers", reference)
        number = whole(reference, 0, 1 << 31)
        if number not in self._buffers:
            if "uri" in buffer:
                data = self.fetch(buffer["uri"])
            elif number == 0 and self.embedded is not None:
                data = self.embedded
            else:
                raise IoError(message(NAME, buffer.where, "a member 'uri'", "none"))
            self._buffers[number] = data
        return self._buffers[number]

    def fetch(self, uri: JsonNode) -> bytes:
        """What a URI names: base64 in the text, or a file in the folder of this one.

        Args:
            uri: a text.

        Raises:
            IoError: no such file, broken base64, or a place outside of the folder.
        """
        text = uri.text()
        if text.startswith("data:"):
            head, comma, body = text.partition(",")
            if not comma or not head.endswith(";base64"):
                raise IoError(message(NAME, uri.where, "data:...;base64,...", f"{head[:40]}..."))
            try:
                return base64.b64decode(body, validate=True)
            except (binascii.Error, ValueError) as failure:
                raise IoError(message(NAME, uri.where, "base64", failure)) from failure
        file = inside(NAME, uri.where, self.path.parent, unquote(text), portable=True)
        return read_file(f"{NAME}: {uri.where}", file)


def open_container(path: Path) -> Container:
    """Read a .gltf or .glb.

    Args:
        path: of the file.

    Raises:
        IoError: missing, damaged, or not of version 2.
    """
    data = read_file(NAME, path)
    embedded: bytes | None = None
    if data[:4] == b"glTF" or path.suffix.lower() == ".glb":
        data, embedded = _chunks(path, data)
    try:
        value = json.loads(data.decode("utf-8"))
    except (ValueError, RecursionError) as failure:  # UnicodeDecodeError, JSONDecodeError
        text = " ".join(str(failure).split())[:120]
        raise IoError(message(NAME, f"{path}", "glTF: JSON in UTF-8", text)) from failure
    root = JsonNode(NAME, f"{path.name}", value)
    version = root["asset"]["version"].text()
    if not version.startswith("2."):
        raise IoError(message(NAME, f"{path.name}: asset: version", "2.0", version[:20]))
    return Container(path, root, embedded)


def _chunks(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and the buffer of a .glb."""
    if len(data) < 12 or data[:4] != b"glTF":
        raise IoError(message(NAME, f"{path}", "a .glb, which begins with 'glTF'", data[:4]))
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2 or length > len(data):
        got = f"version {version}, {length} bytes of {len(data)}"
        raise IoError(message(NAME, f"{path}", "a whole .glb of version 2", got))
    found: dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, at)
        if at + 8 + size > length:
            got = f"a chunk of {size} bytes at {at}, file of {length}"
            raise IoError(message(NAME, f"{path}", "chunks inside of the file", got))
        found.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    if b"JSON" not in found:
        raise IoError(message(NAME, f"{path}", "a chunk of JSON", "none"))
    return found[b"JSON"], found.get(b"BIN\0")


def whole(
    node: JsonNode, least: int, most: int, key: str | None = None, default: int | None = None
) -> int:
    """A whole number: `node` itself, or its member `key`, which may be absent.

    Args:
        node: a value, or an object with it.
        least, most: the range, ends included.
        key: of a member, or None.
        default: of an absent member; None makes it an error.

    Raises:
        IoError: another kind of value, or one out of range.
    """
    if key is not None:
        if key not in node and default is not None:
            return default
        node = node[key]
    number = node.number()
    if number != int(number) or not least <= number <= most:
        expected = f"a whole number from {least} to {most}" if most >= least else "nothing here"
        raise IoError(message(NAME, node.where, expected, f"{number:.12g}"))
    return int(number)


def real(node: JsonNode, key: str, default: float) -> float:
    """A finite number that may be absent.

    Args:
        node: an object.
        key: of its member.
        default: of an absent member.

    Raises:
        IoError, RangeError: another kind of value.
    """
    return node[key].number() if key in node else default
