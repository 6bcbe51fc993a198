"""Cases of representations: marches through fields, splats, rays at Gaussians, direct light."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache, partial
from itertools import product
from typing import Any

import numpy as np
import photograd
from photograd import sh
from photograd._compiled import _core
from photograd.fields import SparseSh
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import MarchPolicy, march, march_backward
from photograd.geometry.mesh import Bvh, Instance, Mesh
from photograd.representation import Outputs, RayBatch, RenderOptions, dense_gradient
from photograd.scenes.direct_light import DirectLight
from photograd.scenes.registry import scene as described_scene
from photograd.scenes.registry import scenes as described_scenes
from photograd.splats import rays as splat_rays
from photograd.splats import splatting as splat
from photograd.transport.builtin import camera_at

from fingerprint_cases.case import PRECISIONS, Array, Arrays, Case, unit_rows

BOX = ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
RAYS = 300
POLICIES: dict[str, dict[str, Any]] = {
    "plain": {"density_activation": "softplus", "color_activation": "sigmoid"},
    "dense": {"density_scale": 20.0},
    "riemann": {"quadrature": "riemann", "border": "zero", "density_activation": "relu"},
    "entry": {"lattice": "entry", "density_activation": "exp", "color_activation": "identity"},
}


def rays(seed: int, dtype: Any) -> RayBatch:
    """From a sphere of radius 3 into the box."""
    origins = 3 * unit_rows(RAYS, seed)
    towards = np.random.default_rng(seed + 1).uniform(-0.7, 0.7, (RAYS, 3)) - origins
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    pixels = np.arange(RAYS, dtype=np.uint32)
    return RayBatch(origins.astype(dtype), towards.astype(dtype), pixels)


def cotangents(outputs: Outputs, seed: int = 5) -> Outputs:
    """Random numbers in the shapes of outputs."""
    g = np.random.default_rng(seed)
    given = outputs_of(outputs).items()
    return replace(
        outputs, **{name: g.uniform(-1, 1, a.shape).astype(a.dtype) for name, a in given}
    )


def outputs_of(outputs: Outputs) -> Arrays:
    """Those that there are."""
    return {name: value for name, value in vars(outputs).items() if value is not None}


def field_values(field: str, dtype: Any) -> Array:
    """Parameters of a field of the core."""
    g = np.random.default_rng(1)
    if field == "dense_grid":
        return g.uniform(0.0, 1.5, (21, 18, 35, 4)).astype(dtype)
    return g.uniform(-0.4, 0.4, _core.tiny_network_parameters).astype(dtype)


def marched(
    field: str, dtype: Any, policy: str, fused: bool, options: RenderOptions, seed: int
) -> Arrays:
    """A march and its adjoint, through a field of one array."""
    given = MarchPolicy(BOX, 0.05, **POLICIES[policy])
    out, context = march(
        field,
        field_values(field, dtype),
        given,
        rays(2, dtype),
        options,
        seed=seed,
        step=3,
        fused=fused,
    )
    return {**outputs_of(out), **march_backward(context, cotangents(out))}


@lru_cache(maxsize=1)
def active_voxels() -> ActiveVoxels:
    """A part of a grid, with a hole in the middle."""
    mask = np.random.default_rng(1).random((21, 18, 35)) < 0.6
    mask[4:16, :, 9:30] = False
    return ActiveVoxels(mask)


def marched_sparse(
    dtype: Any, policy: str, degree: int, fused: bool, skip: bool, seed: int
) -> Arrays:
    """A march and its adjoint, through sparse spherical harmonics."""
    active, k, g = active_voxels(), sh.count(degree), np.random.default_rng(seed)
    values = [
        g.uniform(-0.5, 2.0, len(active)),
        g.uniform(-0.5, 0.5, (len(active), k, 3)),
        g.uniform(-0.3, 0.3, 1 + 3 * k),
    ]
    given = [value.astype(dtype) for value in values]
    settings = MarchPolicy(BOX, 0.05, **POLICIES[policy]).settings(1e-3 if skip else 0.0)
    batch = rays(2, dtype)
    ends = batch.origins, batch.directions
    placed = _core.place_samples(settings, *ends)
    field: Any = (active.table, given, settings, 0.5, (*ends, *placed))
    forward: Any = _core.march_sparse_sh
    adjoint: Any = _core.march_sparse_sh_backward
    out = forward(*field, fused=fused, skip=skip)
    d = [g.uniform(-1, 1, value.shape).astype(dtype) for value in out[:3]]
    names = ("density", "sh", "background", "origins", "directions")
    gradients = [np.zeros_like(value) for value in (*given, *ends)]
    adjoint(*field, out[:3], d, gradients[:3], gradients[3:], fused=fused)
    found = dict(zip(("color", "transmittance", "depth"), out[:3], strict=True))
    return {**found, **{f"d_{n}": a for n, a in zip(names, gradients, strict=True)}}


def greatest_weights(seed: int) -> Arrays:
    """How much of any ray each voxel of sparse spherical harmonics is."""
    field = photograd.representations()["sparse_sh"].example(seed=1, dtype=np.float32)
    assert isinstance(field, SparseSh)
    return {"weights": field.greatest_weights([field.example_batch(seed=seed)])}


def traced(dtype: Any, seed: int) -> Arrays:
    """Rays at the triangles of two instances: nearest hits, any hits, points on surfaces."""
    g = np.random.default_rng(seed)
    corners = g.uniform(-1, 1, (60, 3)).astype(np.float32)
    mesh = Mesh(corners, np.arange(60).reshape(20, 3), corners[:, :2].copy())
    bvh = Bvh([mesh], [Instance(0), Instance(0, np.hstack([0.5 * np.eye(3), [[0.5], [0], [0]]]))])
    batch = rays(seed, dtype)
    hits = bvh.trace(batch.origins, batch.directions)
    points = bvh.surface_points(batch.origins, batch.directions, hits)
    occluded = bvh.occluded(batch.origins, batch.directions, t_max=np.full(RAYS, 3.0, dtype))
    arrays = [*vars(hits).values(), *vars(points).values(), occluded]
    found = [np.asarray(a) for a in arrays if a is not None]
    return {
        f"{k:02d}": np.nan_to_num(a, nan=-1.0, posinf=-1.0) if a.dtype.kind == "f" else a
        for k, a in enumerate(found)
    }


def represented(name: str, dtype: Any, options: RenderOptions, seed: int) -> Arrays:
    """A representation's own example."""
    field = photograd.representations()[name].example(seed=1, dtype=dtype)
    out, context = field.render(field.example_batch(seed=2), seed=seed, step=2, options=options)
    gradients = field.render_backward(context, cotangents(out))
    given = {k: v if isinstance(v, tuple) else (v,) for k, v in gradients.items()}
    dense = {
        k: dense_gradient(gradients[k], field.params[k]) if len(v) > 1 else v[0]
        for k, v in given.items()
    }
    return {**outputs_of(out), **{f"d_{k}": v for k, v in dense.items()}}


def cloud(degree: int, dtype: Any) -> splat.Gaussians:
    """Random Gaussians before a camera that looks along -z."""
    g, n = np.random.default_rng(4), 60
    return splat.Gaussians(
        g.uniform(-0.8, 0.8, (n, 3)),
        g.uniform(-3.5, -1.2, (n, 3)),
        g.standard_normal((n, 4)),
        g.uniform(-2, 5, n),
        g.uniform(-0.4, 0.6, (n, sh.count(degree), 3)),
    ).astype(dtype)


SPLATS: dict[str, splat.SplatOptions] = {
    "default": splat.SplatOptions(),
    "antialiased": splat.SplatOptions(antialiased=True, low_pass=0.1),
    "held": splat.SplatOptions(alpha_max=0.8, clamped_gradient="pass", alpha_min=0.02),
    "extent": splat.SplatOptions(extent_sigmas=2.0, stop=0.1, near=2.5, frustum_margin=0.0),
    "smooth": splat.SplatOptions().smooth(),
}
RAY_OPTIONS: dict[str, splat_rays.RayOptions] = {
    "default": splat_rays.RayOptions(),
    "held": splat_rays.RayOptions(alpha_max=0.8, alpha_min=0.02, stop=0.1, t_min=2.5),
    "smooth": splat_rays.RayOptions().smooth(),
}


def splatted(degree: int, dtype: Any, options: splat.SplatOptions, seed: int) -> Arrays:
    """A picture of Gaussians and its adjoint."""
    camera = camera_at([0.2, 0.3, 3.0], [0.0, 0.0, 0.0], 40.0, 40, 37)
    behind = (0.2, 0.3, 0.4)
    out, context = splat.render(cloud(degree, dtype), camera, background=behind, options=options)
    g = np.random.default_rng(seed)
    d = [g.uniform(-1, 1, a.shape).astype(dtype) for a in vars(out).values()]
    found = splat.render_backward(context, *d)
    return {
        **vars(out),
        **found.gaussians,
        "background": found.background,
        "camera": found.camera_from_world,
        "screen": found.screen,
    }


def splatted_rays(degree: int, dtype: Any, options: splat_rays.RayOptions, seed: int) -> Arrays:
    """Gaussians along rays, and the adjoint."""
    batch = rays(6, dtype)
    out, context = splat_rays.render(
        cloud(degree, dtype),
        batch.origins,
        batch.directions,
        background=(0.2, 0.3, 0.4),
        options=options,
    )
    g = np.random.default_rng(seed)
    d = [g.uniform(-1, 1, a.shape).astype(dtype) for a in vars(out).values()]
    found = splat_rays.render_backward(context, *d, rays=True)
    gradients = {**found.gaussians, "background": found.background}
    assert found.origins is not None
    assert found.directions is not None
    return {**vars(out), **gradients, "origins": found.origins, "directions": found.directions}


def direct_light(name: str, seed: int) -> Arrays:
    """Direct light as captures show it."""
    scene = described_scene(name, seed=1)
    low, high = scene.bounds
    middle, size = (low + high) / 2, float(np.linalg.norm(high - low))
    camera = camera_at(middle + size * np.array([0.4, 0.45, 0.6]), middle, 45.0, 12, 9)
    radiance, alpha = DirectLight(scene).render_view(camera, 4, seed)
    return {"radiance": radiance, "alpha": alpha}


def march_cases() -> Iterator[Case]:
    """The three marches: fused and staged through arrays, and through sparse harmonics."""
    ways = {
        "still": RenderOptions(),
        "stop-jitter": RenderOptions(stop=1e-2, jitter=True),
        "camera": RenderOptions(camera_adjoint=True),
    }
    for (key, dtype), policy in product(PRECISIONS.items(), POLICIES):
        for field, (way, options), fused in product(
            ("dense_grid", "tiny_network"), ways.items(), (True, False)
        ):
            if options.camera_adjoint and POLICIES[policy].get("lattice") == "entry":
                continue
            form = "fused" if fused else "staged"
            run = partial(marched, field, dtype, policy, fused, options)
            yield Case(f"march/{field}/{policy}/{way}/{form}/{key}", run)
        for degree, (fused, skip) in product((0, 2), ((True, True), (True, False), (False, False))):
            form = f"{'fused' if fused else 'staged'}{'-skip' if skip else ''}"
            run = partial(marched_sparse, dtype, policy, degree, fused, skip)
            yield Case(f"march/sparse_sh/{policy}/degree-{degree}/{form}/{key}", run)
    yield Case("march/sparse_sh/greatest-weights", greatest_weights)
    for (name, made), (key, dtype) in product(
        photograd.representations().items(), PRECISIONS.items()
    ):
        for way, options in ways.items():
            if options.camera_adjoint and made.no_camera_adjoint:
                continue
            run = partial(represented, name, dtype, options)
            yield Case(f"representation/{name}/{way}/{key}", run)


def splat_cases() -> Iterator[Case]:
    """Gaussians as pictures and along rays, and direct light."""
    for key, dtype in PRECISIONS.items():
        for degree in range(4):
            for name, options in SPLATS.items():
                if degree == 2 or name == "default":
                    run = partial(splatted, degree, dtype, options)
                    yield Case(f"splat/{name}/degree-{degree}/{key}", run)
            for name, casting in RAY_OPTIONS.items():
                if degree == 2 or name == "default":
                    cast = partial(splatted_rays, degree, dtype, casting)
                    yield Case(f"splat-rays/{name}/degree-{degree}/{key}", cast)
    for key, dtype in PRECISIONS.items():
        yield Case(f"rays/triangles/{key}", partial(traced, dtype))
    for name in described_scenes():
        yield Case(f"direct/{name}", partial(direct_light, name), ("radiance",))
