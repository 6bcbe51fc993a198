"""Direct light on a scene of assignment 07 by the C++ core, for scripts that compare."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


def core_light(
    scene: dict[str, Array], origins: Array, directions: Array, rows: Array, spp: int = 4000
) -> tuple[Array, Array]:
    """Direct light along rays, and its derivative with respect to the roughness of primitive 0.

    Args:
        scene: rectangles of glTF materials; no balls.
        origins, directions: (N, 3), of the rays.
        rows: (N,) of bool, the rays to trace; the others get zeros.
        spp: samples for each ray.

    Returns:
        (light (N, 3), change (N,)): the derivative is that of the mean of the three channels.

    Raises:
        ImportError, AttributeError, TypeError: the core is not installed, or is another one.
    """
    transport = importlib.import_module("photograd.transport")
    shapes = importlib.import_module("photograd.transport.shapes")
    camera = importlib.import_module("photograd.capture.camera").Camera
    look_at = importlib.import_module("photograd.capture.orbit").look_at
    corners = zip(*(scene[name] for name in ("corners", "edges_u", "edges_v")), strict=True)
    parts = [
        shapes.rectangle(f"primitive{k}", *edges, f"of{k}", scene["emission"][k])
        for k, edges in enumerate(corners)
    ]
    names = ("base_color", "metalness", "roughness")
    materials = {
        f"of{k}": transport.Material("gltf", {name: scene[name][k] for name in names})
        for k in range(len(parts))
    }
    cameras = [
        camera(1, 1, 1e5, 1e5, 0.5, 0.5, look_at(o, o + d))
        for o, d in zip(origins, directions, strict=True)
    ]
    built = transport.Scene("scene", tuple(parts), materials, cameras[0])
    tracer = transport.PathTracer(built, dtype=np.float64)
    light, change = np.zeros((len(origins), 3)), np.zeros(len(origins))
    options = transport.PathOptions(max_depth=2)
    for k in np.flatnonzero(rows):
        given = {"spp": spp, "options": options, "camera": cameras[k]}
        light[k] = tracer.render(seed=int(k), **given).mean[0, 0]
        back = tracer.render_backward(np.full((1, 1, 3), 1 / 3), seed=1000 + int(k), **given)
        change[k] = back["materials.of0.roughness"]
    return light, change
