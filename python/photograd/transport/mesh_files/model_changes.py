"""What differs between two models of the same shapes, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from photograd.transport.material import Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.shapes import MeshShape
from photograd.transport.texture import NormalMap, OcclusionMap, Texture, TextureUse
from photograd.types import Array

ROUNDING, TEXEL_ROUNDING = 1e-12, 1e-6
"""Relative: what logarithms and roots leave behind in double, decoding in float, is no change."""


def changes(before: ModelFile, after: ModelFile) -> list[str]:
    """One line for each thing that is not the same; names of textures and media do not count.

    Numbers that differ by less than `ROUNDING` are the same, texels by less than `TEXEL_ROUNDING`;
    positions, normals and coordinates have to be equal.

    Args:
        before: a model.
        after: the model that it became.
    """
    found = [*_of_shapes(before, after), *_of_cameras(before, after), *_of_lights(before, after)]
    for name, material in before.materials.items():
        if name not in after.materials:
            found.append(f"material '{name}': no shape has it, left out")
            continue
        other = after.materials[name]
        found += [f"material '{name}': {text}" for text in _of_material(material, other)]
        sizes = {p.name: p.size for p in (*material.parameters, *other.parameters)}
        found += [
            f"material '{name}': {parameter}: {text}"
            for parameter in sorted(material.textures.keys() | other.textures.keys())
            for text in _of_use(
                material.textures.get(parameter),
                other.textures.get(parameter),
                before.textures,
                after.textures,
                sizes[parameter],
            )
        ]
    return found


def _of_shapes(before: ModelFile, after: ModelFile) -> Iterator[str]:
    others = {shape.name: shape for shape in after.shapes}
    for shape in before.shapes:
        other = others.get(shape.name)
        if not isinstance(shape, MeshShape) or not isinstance(other, MeshShape):
            yield f"shape '{shape.name}': missing"
            continue
        for name in ("vertices", "faces", "normals", "uv", "instances", "emission", "material"):
            if not _same(getattr(shape, name), getattr(other, name), 0.0):
                yield f"shape '{shape.name}': {name} changed"
        for text in _of_use(
            shape.emission_texture, other.emission_texture, before.textures, after.textures, 3
        ):
            yield f"shape '{shape.name}': emission_texture: {text}"
        mine, its = (
            media.get(name or "")
            for media, name in ((before.media, shape.interior), (after.media, other.interior))
        )
        if not _same_medium(mine, its):
            yield f"shape '{shape.name}': interior changed"


def _of_cameras(before: ModelFile, after: ModelFile) -> Iterator[str]:
    others = {camera.name: camera for camera in after.cameras}
    for camera in before.cameras:
        other = others.get(camera.name)
        if other is None:
            yield f"camera '{camera.name}': missing"
            continue
        for name in ("field_of_view", "aspect", "world_from_camera"):
            if not _same(getattr(camera, name), getattr(other, name), ROUNDING):
                yield f"camera '{camera.name}': {name} changed"


def _of_lights(before: ModelFile, after: ModelFile) -> Iterator[str]:
    if len(before.lights) != len(after.lights):
        yield f"{len(before.lights)} lights are read back as {len(after.lights)}"
        return
    for i, (mine, its) in enumerate(zip(before.lights, after.lights, strict=True)):
        if type(mine) is not type(its):
            yield f"lights[{i}]: {type(mine).__name__} is read back as {type(its).__name__}"
            continue
        for name, value in vars(mine).items():
            other = getattr(its, name)
            # Directions and cosines are of the size of 1, however small they are.
            if not np.allclose(value, other, rtol=ROUNDING, atol=ROUNDING):
                yield f"lights[{i}]: {name}: {_said(value)} is read back as {_said(other)}"


def _same(a: Any, b: Any, rounding: float) -> bool:
    if a is None or b is None or isinstance(a, str):
        return a is b or bool(a == b)
    if isinstance(a, tuple):
        return len(a) == len(b) and all(_same(x, y, rounding) for x, y in zip(a, b, strict=True))
    one, other = np.asarray(a), np.asarray(b)
    if one.shape != other.shape:
        return False
    size = float(np.abs(one).max(initial=0)) * rounding
    return bool((np.abs(one.astype(np.float64) - other) <= size).all())


def _same_medium(a: Medium | None, b: Medium | None) -> bool:
    """Whether both swallow the same: a medium of nothing is none."""
    mine, its = (np.zeros(3) if medium is None else medium.sigma_t for medium in (a, b))
    return _same(mine, its, ROUNDING)


def _of_material(before: Material, after: Material) -> Iterator[str]:
    if before.model != after.model:
        yield f"'{before.model}' is read back as '{after.model}'"
        return
    for name in sorted(before.values.keys() | after.values.keys()):
        mine, its = before.values.get(name), after.values.get(name)
        if not _same(mine, its, ROUNDING):
            yield f"{name}: {_said(mine)} is read back as {_said(its)}"
    if before.alpha_cutoff != after.alpha_cutoff:
        yield f"alpha_cutoff: {before.alpha_cutoff} is read back as {after.alpha_cutoff}"
    yield from _of_map("normal map", before.normal_map, after.normal_map)
    yield from _of_map("occlusion map", before.occlusion, after.occlusion)
    if before.occlusion is not None and after.occlusion is not None:
        mine, its = before.occlusion.strength, after.occlusion.strength
        if not _same(mine, its, ROUNDING):
            yield f"occlusion map: strength {mine} is read back as {its}"


def _of_map(
    name: str, before: NormalMap | OcclusionMap | None, after: NormalMap | OcclusionMap | None
) -> Iterator[str]:
    if before is None or after is None:
        if before is not after:
            yield f"{name}: lost" if after is None else f"{name}: new"
        return
    if not _same(before.values, after.values, TEXEL_ROUNDING):
        yield f"{name}: {_rounded(before.values, after.values)}"
    if before.wrap != after.wrap:
        yield f"{name}: wrap {before.wrap} is read back as {after.wrap}"


def _of_use(
    before: TextureUse | None,
    after: TextureUse | None,
    mine: Mapping[str, Texture],
    its: Mapping[str, Texture],
    size: int,
) -> Iterator[str]:
    """The `size` channels that scale something are compared; white ones scale nothing."""
    pair = []
    for use, textures in ((before, mine), (after, its)):
        texture = Texture(np.ones((1, 1, 3), np.float32)) if use is None else textures[use.texture]
        first = 0 if use is None else use.channel
        looked_up = texture.wrap, texture.filter
        pair.append((texture.values[..., first : first + size], looked_up))
    (a, mine_looked), (b, its_looked) = pair
    if before is None or after is None:
        if bool((a != 1).any() or (b != 1).any()):
            yield "texture lost" if after is None else "texture new"
    elif mine_looked != its_looked:
        yield f"texture: wrap and filter {mine_looked} are read back as {its_looked}"
    elif not _same(a, b, TEXEL_ROUNDING):
        yield f"texture: {_rounded(a, b)}"


def _rounded(a: Array, b: Array) -> str:
    if a.shape != b.shape:
        return f"shape {a.shape} is read back as {b.shape}"
    return f"rounded to eight bits, by at most {float(np.abs(a - b).max()):.3g}"


def _said(value: Any) -> str:
    return "none" if value is None else str(np.asarray(value).tolist())
