"""What is differentiated by light transport, and the small scene in which each of it matters.

A case is a scene, a row one number of it: the cases below have one for every parameter of every
registered model, light and phase function, so that a new one brings its rows along. Of the models
in `LAYERED` there are some.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from photograd.bsdf import phase
from photograd.bsdf import specular as delta_bsdf
from photograd.lights import EnvironmentMap, RegisteredLight
from photograd.transport import Medium, PathOptions, PathTracer, Scene
from photograd.transport.incomplete import TURNING
from photograd.transport.material import ALPHA, MODELS

from tests.transport import difference_scenes as scenes
from tests.transport import test_emission_textures as emission
from tests.transport import test_textures as textures
from tests.transport.light_scenes import LIGHTS, lit_by
from tests.transport.media_scenes import cloud as densities
from tests.transport.media_scenes import smoke
from tests.transport.scenes import globe_light, view

PATHS = PathOptions(max_depth=4, roulette_from=2)
STEPS = {
    "roughness": 0.06,
    "coat_roughness": 0.1,
    "slope": 0.05,
    "clearcoat_gloss": 0.2,
    "anisotropic": 0.2,
    "anisotropy": 0.2,
    "rotation": 0.2,
    "dispersion": 0.5,
    "iridescence_thickness": 15.0,
    "iridescence_ior": 0.06,
    "cos_outer": 0.03,
    "softness": 0.06,
    "g": 0.1,
}
"""Where a fifth of the range, or three tenths of the value, would be too long, or too short."""
VEILED = ("lambert", "gltf_refraction", "mirror", "glass")
"""Coverage does not know what it covers: rough and smooth, with and without what lies behind."""
GRAZING = ("sheen", "sheen_tint")
"""What is hardly seen from above."""
_LAYERS = ("base_color", "roughness")
LAYERED = {
    "gltf_layered": (*_LAYERS, "metalness"),
    "gltf_layered_conserving": (*_LAYERS, "transmission", "metalness"),
    "gltf_layered_volume": (*_LAYERS, "eta"),
    "gltf_layered_volume_conserving": (*_LAYERS, "transmission", "eta"),
}
"""Of models that are other models' layers put together, what has rows: two dozen each would say
again how paths are differentiated, and nothing of f that tests/registry does not."""
OTHERS = {"map": "environment map"}
"""Lights whose number of parameters is not fixed: in no registry."""


@dataclass(frozen=True)
class Row:
    """One number of a scene: of a `thing` (a model, a light ...) the parameter and its place."""

    thing: str
    parameter: str
    place: tuple[int, ...]
    key: str  # among the tracer's params
    step: float

    @property
    def name(self) -> str:
        place = f"[{', '.join(map(str, self.place))}]" if self.place else ""
        return f"{self.thing}.{self.parameter}{place}"


@dataclass(frozen=True)
class Case:
    """A scene and the rows that it is for; `refused`: their derivatives are incomplete."""

    kind: str
    thing: str
    scene: Callable[[], Scene]
    rows: tuple[Row, ...]
    refused: bool = False


def step_of(name: str, value: float, lo: float, hi: float) -> float:
    """As long as its function is smooth, and within the range."""
    share = 0.1 if name == "eta" else 0.3
    known = STEPS.get(name, min(0.2 * (hi - lo), share * abs(value)))
    return min(known, 0.95 * (hi - value), 0.95 * (value - lo))


def rows_of(thing: str, name: str, key: str, value: Any, lo: float, hi: float) -> Iterator[Row]:
    """A row for every number of a parameter's value, () or an array."""
    for place in np.ndindex(np.shape(value)):
        step = step_of(name, float(np.asarray(value)[place]), lo, hi)
        yield Row(thing, name, place, key, step)


def models() -> Iterator[Case]:
    """Every parameter of every model, what covers in part, and what is refused of both."""
    for model in MODELS:
        material, (moving, _) = scenes.own(model), TURNING.get(model, ((), ""))
        named = LAYERED.get(model, [p.name for p in MODELS[model].parameters])
        rows = {
            p.name: tuple(
                rows_of(
                    model, p.name, f"materials.own.{p.name}", material.values[p.name], p.lo, p.hi
                )
            )
            for p in MODELS[model].parameters
            if p.name in named
        }
        still = {name: rows[name] for name in rows if name not in moving}
        smooth = model in delta_bsdf.registry()
        for flat in (False, True):
            chosen = [row for name in still if (name in GRAZING) == flat for row in still[name]]
            place = scenes.nook if smooth or flat else scenes.glint
            if chosen:
                yield Case("model", model, lambda m=material, f=place: f(m), tuple(chosen))
        turned = tuple(replace(row, thing=f"{model} ball") for p in moving for row in rows[p])
        if turned:
            yield Case("refused", model, lambda m=material: scenes.nook(m), turned, refused=True)
        if model not in VEILED:
            continue
        sheer = replace(material, values={**material.values, ALPHA.name: 0.7})
        row = Row(model, ALPHA.name, (), "materials.own.alpha", 0.25)
        yield Case("alpha", model, lambda m=sheer: scenes.nook(m), (row,))
    edges = (
        Row("mask", ALPHA.name, (), "materials.card.alpha", 0.1),
        Row("mask", "texels", (1, 0, 0), "textures.t", 0.1),
    )
    yield Case("refused", "mask", scenes.mask, edges, refused=True)


def lights() -> Iterator[Case]:
    """Every parameter of every light, of shapes that shine, and of the dome."""
    near = view(4, (0.0, 1.0, 2.2), (0.0, 0.35, 0.0))
    for name in LIGHTS:
        if name in ("all", "turned map"):
            continue
        light = LIGHTS[name][0]
        thing = light.core_name if isinstance(light, RegisteredLight) else OTHERS[name]
        if isinstance(light, EnvironmentMap):
            # Of the bright texel and of two above the horizon.
            places = [(*at, c) for at in ((1, 3), (2, 9), (2, 4)) for c in range(3)]
            rows = [
                Row(thing, "texels", at, "lights.0.texels", 0.3 * float(light.texels[at]))
                for at in places
            ]
        else:
            assert isinstance(light, RegisteredLight)
            rows = [
                row
                for key in (p.name for p in light.parameters())
                for row in rows_of(thing, key, f"lights.0.{key}", getattr(light, key), 0.0, np.inf)
            ]
        yield Case("light", thing, lambda one=light: replace(lit_by(one), camera=near), tuple(rows))
    stand = scenes.nook(scenes.own("gltf"))
    dome = [Row("dome", "environment", at, "environment", 0.1) for at in np.ndindex(3, 3)]
    lamp = [Row("mesh that shines", "emission", (c,), "emission.lamp", 0.2) for c in range(3)]
    yield Case("light", "dome", lambda: stand, (*dome,))
    yield Case("light", "mesh that shines", lambda: stand, (*lamp,))
    ball = [Row("sphere that shines", "emission", (c,), "emission.globe", 0.2) for c in range(3)]
    globe = replace(globe_light(), camera=near)
    yield Case("light", "sphere that shines", lambda: globe, (*ball,))


def medium_rows(thing: str, prefix: str, medium: Medium, voxels: Any = ()) -> tuple[Row, ...]:
    """All coefficients of a medium, and some of its voxels."""
    rows: list[Row] = []
    for name, value in medium.start.items():
        key = f"{prefix}.{name}"
        if name == "density":
            rows += [Row(thing, name, at, key, 0.6 * float(value[at])) for at in voxels]
            continue
        hi = {"sigma_t": np.inf, "albedo": 1.0}.get(name, 0.95)
        rows += rows_of(thing, name, key, value, 0.0, hi)
    return tuple(rows)


def media() -> Iterator[Case]:
    """Every coefficient: of each phase function, in a grid, of pure absorption."""
    fog = Medium([0.3, 0.22, 0.15], [0.8, 0.7, 0.85], values={"g": 0.4})
    cloud = replace(smoke(densities((2, 2, 3))), sigma_t=[0.6, 0.45, 0.3])
    densest = np.unravel_index(int(cloud.density.values.argmax()), cloud.density.values.shape)
    voxels = (tuple(map(int, densest)), (1, 0, 1))
    listed: dict[str, tuple[Medium, Any]] = {
        **{name: (replace(fog, phase=name), ()) for name in phase.registry()},
        "grid": (cloud, voxels),
        "absorbing": (Medium([0.3, 0.22, 0.15]), ()),
        "absorbing grid": (replace(cloud, albedo=None), voxels),
    }
    for thing, (medium, some) in listed.items():
        rows = medium_rows(thing, "media.fog", medium, some)
        yield Case("medium", thing, lambda m=medium: scenes.fog(m), rows)


def painted() -> Iterator[Case]:
    """Texels: of a color, of a roughness and a metalness, of coverage, of what shines."""
    for thing, scene, texture, places in (
        ("paint", textures.stage(4), "paint", ((2, 1, 0), (1, 2, 1))),
        ("rough paint", textures.stage(4), "rough", ((1, 1, 1), (1, 1, 2))),
        ("veil", scenes.veil(), "t", ((1, 0, 0), (1, 1, 0))),
        ("sign", emission.room(size=4), "sign", ((1, 1, 0), (1, 2, 2))),
    ):
        rows = []
        for at in places:
            value = float(scene.textures[texture].values[at])
            step = min(0.3 * value, 0.95 * abs(1 - value))  # 1 is an end of many ranges
            rows.append(Row(thing, "texels", at, f"textures.{texture}", step))
        yield Case("texture", thing, lambda s=scene: s, tuple(rows))


def cases() -> list[Case]:
    """All of them."""
    return [*models(), *lights(), *media(), *painted()]


def check(case: Case, tracer: PathTracer) -> None:
    """Raise ValueError for a row whose number is not there, or could leave its range."""
    for row in case.rows:
        value = tracer.params[row.key][row.place]
        if not row.step > 0:
            raise ValueError(f"{row.name}: step {row.step} at {value}")
