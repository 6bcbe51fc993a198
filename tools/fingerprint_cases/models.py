"""Cases of registered parts: reflectance models, phase functions, lights, ops, lookups."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from photograd import bsdf
from photograd._compiled import _core
from photograd.bsdf import phase
from photograd.bsdf import specular as delta_bsdf
from photograd.textures import (
    build_mips,
    build_mips_backward,
    mip_level,
    sample,
    sample_backward,
    sample_mips,
    sample_mips_backward,
)

from fingerprint_cases.case import PRECISIONS, Array, Arrays, Case, unit_rows
from fingerprint_cases.scenes_light import LIGHTS

COUNT = 200


def rows_between(parameters: Any, dtype: Any, seed: int = 3) -> Array:
    """Random values (COUNT, P) in the middle of the parameters' ranges."""
    lo, hi = (
        np.concatenate([np.full(p.size, getattr(p, end)) for p in parameters] or [np.zeros(0)])
        for end in ("lo", "hi")
    )
    u = np.random.default_rng(seed).uniform(0.2, 0.8, (COUNT, len(lo)))
    return np.ascontiguousarray(lo + (hi - lo) * u, dtype)


def reflectance(name: str, dtype: Any, seed: int) -> Arrays:
    """Value, density, sample, gradients and tangents of a model."""
    model = bsdf.registry()[name]
    core, rows = model.core, rows_between(model.parameters, dtype)
    wo, wi = unit_rows(COUNT, seed).astype(dtype), unit_rows(COUNT, seed + 1).astype(dtype)
    if not model.transmits:
        wo[:, 2], wi[:, 2] = np.abs(wo[:, 2]), np.abs(wi[:, 2])
    g = np.random.default_rng(seed)
    u2, d = g.random((COUNT, 2)).astype(dtype), g.uniform(-1, 1, (COUNT, 3)).astype(dtype)
    found = {
        "f": core.f(rows, wo, wi),
        "pdf": core.pdf(rows, wo, wi),
        "wi": core.sample(rows, wo, u2),
        "d_rows": core.f_backward(rows, wo, wi, d, np.zeros_like(rows)),
    }
    if dtype == np.float64:
        found["tangent"] = core.jvp(rows, np.ones_like(rows), wo, wi)
        found["index"] = core.index_inside(rows)
    return found


def specular(name: str, dtype: Any, seed: int) -> Arrays:
    """Lobes of a specular model, gradients and tangents."""
    model = delta_bsdf.registry()[name]
    core, rows = model.core, rows_between(model.parameters, dtype)
    wo, g = unit_rows(COUNT, seed).astype(dtype), np.random.default_rng(seed)
    wi, weight = core.lobes(rows, wo)
    d = [g.uniform(-1, 1, wi.shape).astype(dtype) for _ in range(2)]
    found = {"wi": wi, "weight": weight}
    found["d_rows"] = core.lobes_backward(rows, wo, *d, np.zeros_like(rows))
    if dtype == np.float64:
        tangents = core.jvp(rows, np.ones_like(rows), wo)
        found |= {f"tangent-{k}": np.asarray(t) for k, t in enumerate(tangents)}
    return found


def phase_function(name: str, dtype: Any, seed: int) -> Arrays:
    """Value, gradients and tangents of a phase function."""
    model, g = phase.registry()[name], np.random.default_rng(seed)
    row = np.full(len(model.parameters), 0.3, dtype)
    cosine = g.uniform(-1, 1, COUNT).astype(dtype)
    d_values, d_cosine = model.p_backward(row, cosine, g.uniform(-1, 1, COUNT).astype(dtype))
    d_row = np.array([d_values[parameter.name] for parameter in model.parameters])
    found: Arrays = {"p": model.p(row, cosine), "d_row": d_row, "d_cosine": d_cosine}
    if dtype == np.float64:
        found["tangent"] = model.core.jvp(row, cosine, np.ones_like(row), cosine)
    return found


def light(name: str, dtype: Any, seed: int) -> Arrays:
    """Sample, radiance, density and gradients of a light."""
    it, g = LIGHTS[name](), np.random.default_rng(seed)
    points = g.uniform(-1, 1, (COUNT, 3)) * [1, 0.4, 1]
    points = points.astype(dtype)
    chosen = it.sample(points, g.random((COUNT, 2)).astype(dtype))
    w = np.where(chosen.pdf[:, None] > 0, chosen.direction, np.array([0, 1, 0], dtype))
    d = g.uniform(-1, 1, (COUNT, 3)).astype(dtype) * (chosen.pdf > 0)[:, None]
    found = {
        "direction": chosen.direction,
        "distance": np.nan_to_num(chosen.distance, posinf=-1.0),
        "radiance": chosen.radiance,
        "pdf": chosen.pdf,
        "L": it.L(points, w),
        "pdf-of": it.pdf(points, w),
    }
    for key, value in it.L_backward(points, w, d).items():
        found[f"d_L-{key}"] = np.asarray(value)
    for key, value in it.sample_backward(points, chosen, d).items():
        found[f"d_sample-{key}"] = np.asarray(value)
    return found


def op(name: str, dtype: Any, seed: int) -> Arrays:
    """Value, gradients and tangents of an op."""
    it, g = _core.ops[name], np.random.default_rng(seed)
    values, gradients, tangents = [], [], []
    for _ in range(50):
        x = np.concatenate([g.uniform(lo, hi, n) for _, n, lo, hi in it.inputs]).astype(dtype)
        y = np.nan_to_num(it.forward(x))  # some have no value where light is reflected totally
        values.append(y)
        d_x = np.zeros_like(x)
        it.backward(x, g.uniform(-1, 1, y.shape).astype(dtype), d_x)
        gradients.append(np.nan_to_num(d_x))
        if dtype == np.float64:
            tangents.append(np.nan_to_num(it.jvp(x, g.uniform(-1, 1, x.shape))))
    found = {"y": np.array(values), "d_x": np.array(gradients)}
    return {**found, "tangent": np.array(tangents)} if tangents else found


def lookups(dtype: Any, seed: int) -> Arrays:
    """Textures looked up with and without mip maps, and gradients."""
    g = np.random.default_rng(seed)
    texture = g.random((12, 13, 3)).astype(dtype)
    uv = g.uniform(-0.2, 1.2, (COUNT, 2)).astype(dtype)
    colors, mips = sample(texture, uv), build_mips(texture)
    wide = np.geomspace(0.02, 1.5, COUNT)[:, None, None]
    level = mip_level((12, 13), (wide * g.uniform(-1, 1, (COUNT, 2, 2))).astype(dtype))
    coarse = sample_mips(mips, uv, level)
    d_texture = sample_backward(texture, uv, colors)
    d_mips = sample_mips_backward(mips, uv, level, coarse)
    found: list[Any] = [colors, level, coarse, *flat(d_texture), *flat(d_mips)]
    levels = [level.copy() for level in mips]
    found += flat(build_mips_backward(levels))
    return {f"{k:02d}": np.asarray(value) for k, value in enumerate(found)}


def flat(value: Any) -> list[Any]:
    """Arrays in nested lists, tuples and dictionaries."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return [array for part in value for array in flat(part)]
    return [value]


def model_cases() -> Iterator[Case]:
    """Every registered part, in both precisions."""
    groups: tuple[tuple[str, Any, Any], ...] = (
        ("bsdf", bsdf.registry(), reflectance),
        ("delta", delta_bsdf.registry(), specular),
        ("phase", phase.registry(), phase_function),
        ("light", LIGHTS, light),
        ("op", _core.ops, op),
    )
    for key, dtype in PRECISIONS.items():
        for group, names, compute in groups:
            for name in names:
                yield Case(f"{group}/{name}/{key}", partial(compute, name, dtype))
        yield Case(f"texture/lookups/{key}", partial(lookups, dtype))
