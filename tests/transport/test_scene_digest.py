"""What is kept of a picture belongs to one scene: its digest changes with everything it has."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest
from photograd.geometry.sdf import placed, sphere
from photograd.transport import Scene
from photograd.transport.builtin import BUILTIN, builtin_scene
from photograd.transport.scene_digest import scene_digest
from photograd.transport.shapes import SdfShape

from tests.transport.light_scenes import LIGHTS, lit_by


def other(value: Any) -> Any:
    """Another value of the same kind, which need not make sense; None if there is none."""
    if isinstance(value, np.ndarray):
        if not value.size:
            return None
        changed = value.copy()
        changed.flat[-1] += 1
        return changed
    if isinstance(value, bool):
        return not value
    if isinstance(value, str):
        return value + "."
    if isinstance(value, int | float | np.generic):
        return value + 1
    return np.zeros(1) if value is None else None


def changed_once(value: Any) -> Iterator[Any]:
    """A value with one number or name of it changed, each in turn, without looking at sense."""
    if isinstance(value, tuple | list):
        for i, part in enumerate(value):
            for new in changed_once(part):
                yield (*value[:i], new, *value[i + 1 :])
    elif isinstance(value, dict):
        for name, part in value.items():
            for new in changed_once(part):
                yield {**value, name: new}
    elif is_dataclass(value):
        for each in (each for each in fields(value) if each.init):
            for new in changed_once(getattr(value, each.name)):
                copy = object.__new__(type(value))
                copy.__dict__.update(vars(value))
                copy.__dict__[each.name] = new
                yield copy
    elif (new := other(value)) is not None:
        yield new


def every_kind() -> list[Scene]:
    return [builtin_scene(name, 4) for name in BUILTIN] + [
        lit_by(*lights) for lights in LIGHTS.values()
    ]


def test_every_change_is_another_digest() -> None:
    for scene in every_kind():
        digests = [scene_digest(each) for each in changed_once(scene)]
        assert len(digests) > 20, scene.name
        assert len({scene_digest(scene), *digests}) == len(digests) + 1, scene.name


def test_the_same_scene_has_the_same_digest() -> None:
    for first, again in zip(every_kind(), every_kind(), strict=True):
        assert scene_digest(first) == scene_digest(again)


def test_what_is_left_out_does_not_count() -> None:
    scene = builtin_scene(next(iter(BUILTIN)), 4)
    renamed = replace(scene, name="another", camera=builtin_scene(scene.name, 5).camera)
    assert scene_digest(renamed) != scene_digest(scene)
    without = ("name", "camera")
    assert scene_digest(renamed, without=without) == scene_digest(scene, without=without)


def test_bodies_of_distances_are_told_apart() -> None:
    scene = builtin_scene("carved", 4)
    first = next(shape for shape in scene.shapes if isinstance(shape, SdfShape))
    rest = [shape for shape in scene.shapes if shape is not first]
    moved = replace(first, body=placed(sphere(0.3), [-0.5, 0.3, 0.3]))
    digests = {scene_digest(replace(scene, shapes=(each, *rest))) for each in (first, moved)}
    assert len(digests) == 2


def test_what_has_no_digest_is_named() -> None:
    scene = builtin_scene("carved", 4)
    scene.__dict__["world"] = object()
    with pytest.raises(TypeError, match="object has no digest"):
        scene_digest(scene)
