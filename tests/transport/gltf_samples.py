"""Small glTF files, written by hand."""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import numpy as np
from PIL import Image

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [0, 2, 3]], np.uint16)
UV = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
_COMPONENTS = {"<i1": 5120, "<u1": 5121, "<i2": 5122, "<u2": 5123, "<u4": 5125, "<f4": 5126}
LIGHTS = "KHR_lights_punctual"
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def png(pixels: Any) -> bytes:
    """An 8-bit PNG of (H, W, 3) or (H, W, 4)."""
    stream = io.BytesIO()
    Image.fromarray(np.asarray(pixels, np.uint8)).save(stream, "PNG")
    return stream.getvalue()


class Glb:
    """A file in the making: arrays and images go into the one buffer."""

    def __init__(self) -> None:
        self.data = b""
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "bufferViews": [],
            "accessors": [],
        }

    def view(self, data: bytes) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        )
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, array: Any, **more: Any) -> int:
        rows = np.ascontiguousarray(array)
        kind = rows.dtype.newbyteorder("<").str.replace("|", "<")
        self.json["accessors"].append(
            {
                "bufferView": self.view(rows.tobytes()),
                "componentType": _COMPONENTS[kind],
                "count": len(rows),
                "type": _TYPES[1 if rows.ndim == 1 else rows.shape[1]],
                **more,
            }
        )
        return len(self.json["accessors"]) - 1

    def image(self, pixels: Any) -> int:
        """The number of a texture with these pixels."""
        self.json.setdefault("images", []).append(
            {"bufferView": self.view(png(pixels)), "mimeType": "image/png"}
        )
        self.json.setdefault("textures", []).append({"source": len(self.json["images"]) - 1})
        return len(self.json["textures"]) - 1

    def material(self, **entries: Any) -> int:
        self.json.setdefault("materials", []).append(entries)
        return len(self.json["materials"]) - 1

    def mesh(
        self,
        vertices: Any = CORNERS,
        faces: Any = FACES,
        uv: Any = UV,
        *,
        material: int | None = None,
        **more: Any,
    ) -> int:
        part: dict[str, Any] = {"attributes": {"POSITION": self.accessor(vertices)}, **more}
        if uv is not None:
            part["attributes"]["TEXCOORD_0"] = self.accessor(uv)
        if faces is not None:
            part["indices"] = self.accessor(np.asarray(faces).reshape(-1))
        if material is not None:
            part["material"] = material
        self.json["meshes"].append({"primitives": [part]})
        return len(self.json["meshes"]) - 1

    def node(self, mesh: int, **place: Any) -> dict[str, Any]:
        return self._node({"mesh": mesh, **place})

    def seen(self, camera: Any, **place: Any) -> dict[str, Any]:
        """A node with a camera of its own."""
        self.json.setdefault("cameras", []).append(camera)
        return self._node(place | {"camera": len(self.json["cameras"]) - 1})

    def lit(self, light: Any, **place: Any) -> dict[str, Any]:
        """A node with a light of its own."""
        lamps = self.json.setdefault("extensions", {}).setdefault(LIGHTS, {"lights": []})["lights"]
        lamps.append(light)
        return self._node(place | {"extensions": {LIGHTS: {"light": len(lamps) - 1}}})

    def _node(self, node: dict[str, Any]) -> dict[str, Any]:
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)
        return node

    def bytes(self) -> bytes:
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def square(**material: Any) -> Glb:
    """A square of one material."""
    glb = Glb()
    glb.node(glb.mesh(material=glb.material(name="m", **material)))
    return glb


def core(**entries: Any) -> dict[str, Any]:
    """pbrMetallicRoughness."""
    return {"pbrMetallicRoughness": entries}


def extension(name: str, **entries: Any) -> dict[str, Any]:
    """A material with one extension."""
    return {"extensions": {f"KHR_materials_{name}": entries}}
