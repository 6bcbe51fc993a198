"""A short text that changes with a scene: what is kept of a picture belongs to one scene alone."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from photograd.transport.scene import Scene


def scene_digest(scene: Scene, *, without: Collection[str] = ()) -> str:
    """A hash, 64 hexadecimal digits, of everything that a scene is made from.

    All fields count, those of shapes, materials, lights and media, too, so a new one counts from
    the day it is there; what is computed from them does not. Files that it was read from do not
    count either, only what was in them.

    Args:
        scene: of any size; arrays are hashed where they are.
        without: fields of `Scene` that do not matter, as "name".
    """
    found = hashlib.sha256()
    for each in fields(scene):
        if each.name not in without:
            _add(found, each.name)
            _add(found, getattr(scene, each.name))
    return found.hexdigest()


def _add(found: Any, value: Any) -> None:
    """Each value with its kind and extent, so that no two lists of them read the same."""
    if isinstance(value, np.ndarray):
        found.update(f"array {value.dtype.str} {value.shape};".encode())
        found.update(np.ascontiguousarray(value).data)
    elif isinstance(value, Mapping):
        found.update(f"table {len(value)};".encode())
        for name, part in value.items():
            _add(found, name)
            _add(found, part)
    elif isinstance(value, tuple | list):
        found.update(f"list {len(value)};".encode())
        for part in value:
            _add(found, part)
    elif is_dataclass(value):
        found.update(f"{type(value).__name__};".encode())
        for each in fields(value):
            if each.init:
                _add(found, each.name)
                _add(found, getattr(value, each.name))
    elif value is None or isinstance(value, str | bool | int | float | np.generic):
        found.update(f"{value!r};".encode())
    else:
        raise TypeError(f"scene_digest: {type(value).__name__} has no digest")
