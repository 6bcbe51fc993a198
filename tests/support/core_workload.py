"""A little of everything that the library asks of its core, small enough to run in a second."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import photograd
from photograd import sh
from photograd._compiled import _core
from photograd.bsdf import phase
from photograd.bsdf import registry as bsdf_registry
from photograd.bsdf.principled import evaluate, evaluate_backward
from photograd.bsdf.specular import registry as delta_registry
from photograd.fitting.loss import ssim, ssim_backward
from photograd.fitting.steps import RowAdam
from photograd.geometry import Body, BspTree, ReferenceBvh
from photograd.geometry.bsp import order_by_distance
from photograd.geometry.mesh import Bvh, Instance, Mesh
from photograd.geometry.sdf import box, placed, smooth_union, sphere
from photograd.grids.bricks import BrickField
from photograd.grids.octree import Octree, Quadtree
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import read_vdb, write_vdb
from photograd.grids.voxel_hash import VoxelHash
from photograd.representation import Outputs, RenderOptions
from photograd.splats import rays as splat_rays
from photograd.splats import splatting as splat
from photograd.textures import (
    TexturePlan,
    build_mips,
    build_mips_backward,
    mip_level,
    sample,
    sample_backward,
    sample_mips,
    sample_mips_backward,
)
from photograd.transport import (
    Accumulation,
    IrradianceSensor,
    NormalMap,
    ParticleOptions,
    PathOptions,
    PathTracer,
    PhotonMap,
    Scene,
    Texture,
    TextureUse,
    bake_ambient_occlusion,
    builtin_scene,
    derivative_image,
    emit_particles,
    trace_light,
)
from photograd.transport.inverse.loss import loss_and_gradients

from support.raster_workload import LATER
from tests.splat import oracle
from tests.transport import light_scenes, media_scenes
from tests.transport.scenes import any_material, bent_floor, stage

G = np.random.default_rng(1)
BOTH: tuple[Any, ...] = (np.float32, np.float64)
PATHS = PathOptions(max_depth=4)


def rays(count: int, dtype: Any) -> tuple[Any, Any]:
    directions = G.standard_normal((count, 3))
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return G.standard_normal((count, 3)).astype(dtype), unit.astype(dtype)


def numbers() -> None:
    for dtype in BOTH:
        u2 = G.random((5, 2)).astype(dtype)
        _core.disk_to_square(_core.square_to_disk(u2))
        _core.cosine_hemisphere_to_square(_core.square_to_cosine_hemisphere(u2))
        _core.cap_to_square(_core.square_to_cap(u2, 0.3), 0.3)
        for name in ("exp", "expm1", "log1p_unit"):
            getattr(_core, name)(u2[:, 0].copy())
        for op in _core.ops.values():
            x = np.concatenate([G.uniform(lo, hi, n) for _, n, lo, hi in op.inputs]).astype(dtype)
            y = op.forward(x)
            op.backward(x, np.ones_like(y), np.zeros_like(x))
            if dtype == np.float64:
                op.jvp(x, x)
    for name in ("dipole", "normalized_diffusion", "diffusion_cdf", "sample_diffusion_radius"):
        rows, fit = (G.random((4, 4)), []) if name == "dipole" else (G.random((4, 3)), ["diffuse"])
        d = np.zeros_like(rows)
        getattr(_core, name + "_backward")(rows, *fit, getattr(_core, name)(rows, *fit), d)
    _core.dipole_albedo_backward(rows, _core.dipole_albedo(rows), d)
    _core.philox4x32(np.zeros((3, 4), np.uint32), np.zeros((3, 2), np.uint32))
    _core.uniform(1, 2, np.arange(4, dtype=np.uint32), 3, 4)
    _core.sobol_words(1, 2, 3, np.arange(4, dtype=np.uint32), 0, 4)
    _core.set_thread_count(_core.thread_count())
    _core.instruction_set()


def representations() -> None:
    for made in photograd.representations().values():
        for dtype in BOTH:
            field = made.example(seed=1, dtype=dtype)
            batch = field.example_batch(seed=2)
            camera = not made.no_camera_adjoint
            for options in (RenderOptions(), RenderOptions(jitter=True, camera_adjoint=camera)):
                out, context = field.render(batch, seed=1, step=2, options=options)
                ones = {k: np.ones_like(v) for k, v in vars(out).items() if v is not None}
                field.render_backward(context, Outputs(**ones))
            if hasattr(field, "add_prior"):
                gradients = {name: np.zeros_like(v) for name, v in field.params.items()}
                field.add_prior(gradients, 0.1, 0.5)
            for prior in field.priors():
                prior.value(field.params[prior.group])
            if hasattr(field, "greatest_weights") and dtype == np.float32:
                field.greatest_weights([batch])


def models() -> None:
    for dtype in BOTH:
        _, wo = rays(4, dtype)
        _, wi = rays(4, dtype)
        u2, ones = G.random((4, 2)).astype(dtype), np.ones((4, 3), dtype)
        for model in bsdf_registry().values():
            row = np.concatenate([np.full(p.size, (p.lo + p.hi) / 2) for p in model.parameters])
            row = row[None].astype(dtype)
            core = model.core
            core.f(row, wo, wi), core.pdf(row, wo, wi), core.sample(row, wo, u2)
            core.f_backward(row, wo, wi, ones, np.zeros_like(row))
            if dtype == np.float64:
                core.jvp(row, row, wo, wi), core.index_inside(row)
            core.parameters(), core.energy(), core.reciprocal(), core.transmits()
        for smooth in delta_registry().values():
            row = np.concatenate([np.full(p.size, (p.lo + p.hi) / 2) for p in smooth.parameters])
            row = row[None].astype(dtype)
            to, weight = smooth.core.lobes(row, wo)
            smooth.core.lobes_backward(row, wo, to, weight, np.zeros_like(row))
            if dtype == np.float64:
                smooth.core.jvp(row, row, wo)
        for scattering in phase.registry().values():
            row, cosine = np.full(len(scattering.parameters), 0.3, dtype), wo[:, 0].copy()
            scattering.core.p(row, cosine)
            scattering.core.p_backward(row, cosine, cosine, np.zeros_like(row), np.zeros(4, dtype))
            if dtype == np.float64:
                scattering.core.jvp(row, cosine, row, cosine)
        for lights in light_scenes.LIGHTS.values():
            core, first = lights[0].core_call(dtype)
            chosen = core.sample(*first, wo, u2)
            core.radiance(*first, wo, chosen[0]), core.pdf(*first, wo, chosen[0])
            d_first = np.zeros_like(first[0])
            core.radiance_backward(*first, wo, wi, ones, d_first)
            core.sample_backward(*first, wo, chosen[0], ones, d_first)
            if dtype == np.float64 and hasattr(core, "jvp"):
                core.jvp(*first, first[0], wo, wi)
    surface = np.full((2, 5), 0.5, np.float32)
    wo, wi = np.abs(rays(4, np.float32)[1]), np.abs(rays(4, np.float32)[1])
    evaluate_backward(surface, wo, wi, evaluate(surface, wo, wi))
    light_scenes.environment_map(share=0.1)


def geometry() -> None:
    vertices = G.standard_normal((30, 3)).astype(np.float32)
    mesh = Mesh(vertices, np.arange(30).reshape(10, 3), vertices[:, :2].copy())
    placed_at = np.hstack([2 * np.eye(3), [[1.0], [0], [0]]])
    for bvh in (Bvh(mesh), Bvh([mesh], [Instance(0), Instance(0, placed_at)])):
        for dtype in BOTH:
            origins, directions = rays(33, dtype)
            hits = bvh.trace(origins, directions)
            bvh.surface_points(origins, directions, hits)
            bvh.occluded(origins, directions, t_max=np.full(33, 2.0, dtype))
    origins, directions = rays(9, np.float64)
    reference = ReferenceBvh(mesh)
    reference.trace(origins, directions), reference.trace_all(origins, directions)
    reference.any_hit(origins, directions), reference.cost()
    tree = BspTree(mesh)
    tree.polygons, tree.back_to_front(origins)
    order_by_distance(origins, [0, 0, 0])
    body = Body(smooth_union(placed(box([0.3] * 3), [0.2, 0, 0]), sphere(0.4), 0.1))
    body.distance(origins), body.distance_backward(origins, np.ones(9))
    found = body.trace(-2 * directions, directions)
    body.trace_backward(-2 * directions, directions, found, np.ones(9))


def grids() -> None:
    for dtype in (np.bool_, *BOTH):
        values = (G.random((5, 4, 3, 1)) > 0.5).astype(dtype)
        tree = Octree.from_dense(values, np.array([[0.0] * 3, [1.0] * 3]))
        flat = Quadtree.from_dense(values[:, :, 0], np.array([[0.0] * 2, [1.0] * 2]))
    origins, directions = rays(7, np.float64)
    for grid in (tree, flat):
        n = grid.dimensions
        inside = np.abs(origins[:, :n]).copy()
        grid.leaf_at(inside), grid.traverse(inside, directions[:, :n].copy())
        grid.leaf_boxes(), grid.statistics()
        grid.from_function(lambda _, size: None if size > 1 else [1.0], 2)
    table = VoxelHash(np.arange(30).reshape(10, 3))
    table.find(np.arange(6).reshape(2, 3)), table.erase(np.arange(3)[None]), table.items()
    table.statistics()
    for channels in (1, 3):
        dense = G.random((9, 8, 7, channels)).astype(np.float32)
        sparse = SparseGrid.from_dense(dense, background=np.zeros(channels, np.float32))
        sparse.to_dense(), sparse.sample(G.random((3, 3))), sparse.values_at([[1, 2, 3]])
        sparse.activate([[1, 2, 3]], np.ones((1, channels), np.float32))
        sparse.prune(), sparse.dilate(), sparse.copy(), sparse.set_metadata("a", 1.0)
        sparse.world_from_index = np.eye(4)
        assert sparse.metadata is not None
        assert sparse.statistics.leaves > 0
        with tempfile.TemporaryDirectory() as folder:
            write_vdb(Path(folder) / "a.vdb", [sparse])
            read_vdb(Path(folder) / "a.vdb")
        bricks = BrickField(sparse)
        bricks.sample_backward(G.random((3, 3)), bricks.sample(G.random((3, 3))))
        bricks.to_sparse()
        sparse.core.voxelize()
        sparse.core.keep(np.ones(len(sparse.core.leaf_values()), np.uint8))
    rows = {"a": np.ones((4, 3), np.float32)}
    RowAdam().step(rows, {"a": np.ones((4, 3), np.float32)}, {"a": 0.1})


def textures() -> None:
    for dtype in BOTH:
        texture, uv = G.random((12, 13, 3)).astype(dtype), G.random((5, 2)).astype(dtype)
        colors = sample(texture, uv)
        sample_backward(texture, uv, colors)
        mips = build_mips(texture)
        build_mips_backward([level.copy() for level in mips])
        level = mip_level((12, 13), G.random((5, 2, 2)).astype(dtype))
        sample_mips_backward(mips, uv, level, sample_mips(mips, uv, level))
        TexturePlan(uv, colors, (12, 13)).loss_and_gradient(texture)
        ssim_backward(texture, texture[::-1].copy()), ssim(texture, texture)
        for degree in range(1, 4):
            table = G.random((5, (degree + 1) ** 2, 3)).astype(dtype)
            _, directions = rays(5, dtype)
            sh.evaluate_backward(table, directions, sh.evaluate(table, directions))


def gaussians() -> None:
    for dtype in BOTH:
        cloud = oracle.cloud(6, 1, degree=1).astype(dtype)
        _, context = splat.render(cloud, oracle.camera(20, 17))
        splat.render_backward(context, np.ones((17, 20, 3), dtype))
        assert len(context.visible) == 6
        picture, seen = splat_rays.render(cloud, *rays(9, dtype))
        splat_rays.render_backward(seen, np.ones_like(picture.color), rays=True)
        assert len(seen.crossings) == 9


def textured() -> Scene:
    paint = any_material("gltf")
    paint = replace(paint, values={**paint.values, "alpha": 0.5})
    bumps = NormalMap(np.full((2, 2, 3), [0.0, 0.1, 1.0]))
    paint = replace(paint, textures={"base_color": TextureUse("t")}, normal_map=bumps)
    texels = Texture(G.uniform(0.1, 0.9, (4, 5, 3)), filter="mip")
    plain = stage(any_material("lambert"))
    return replace(plain, materials={**plain.materials, "floor": paint}, textures={"t": texels})


def paths() -> None:
    scenes = [
        *(replace(builtin_scene(name, 4)) for name in ("cornell-box", "wax", "carved", "thrown")),
        light_scenes.lit_by(*light_scenes.LIGHTS["all"], size=3),
        textured(),
        media_scenes.fog_box(media_scenes.smoke(), size=3),
        bent_floor(4),
    ]
    for scene in scenes:
        for dtype in BOTH:
            tracer = PathTracer(scene, dtype=dtype)
            image = tracer.render(spp=2, seed=1, options=PATHS).mean
            tracer.render_backward(image, spp=2, seed=1, options=PATHS)
        derivative_image(tracer, next(iter(tracer.params)), spp=1, seed=1, options=PATHS)
        tracer.path(5, 0, seed=1, options=PATHS)
        loss_and_gradients(tracer, image, np.ones_like(image), spp=1, seeds=(1, 2), options=PATHS)
        tracer._geometry.choose_lights(G.random(3))
        sums = Accumulation.empty(*image.shape[:2])
        _core.trace_reference(
            **tracer.wide_arguments(),
            options=PATHS.numbers(1),
            first=0,
            count=1,
            radiance=sums.radiance,
            squares=sums.squares,
        )
    tracer = PathTracer(scenes[0])
    interval = np.zeros(1), np.full(1, np.inf)
    tracer._geometry.bvh.occluded(*rays(5, np.float64), *interval)
    tracer.add_samples(Accumulation.empty(4, 4), 1, seed=1, hits=np.zeros((4, 4)))
    tracer.add_occlusion(Accumulation.empty(4, 4), 1, radius=1.0, seed=1)
    photons = PhotonMap(tracer, particles=50, radius=0.2, seed=1)
    photons.render(spp=1, seed=1), photons.irradiance(*rays(5, np.float64)), len(photons)
    emit_particles(tracer, 5, seed=1)
    sensor = IrradianceSensor([-1.0, 0.5, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0], 3, 4)
    trace_light(tracer, sensor, particles=40, seed=1, options=ParticleOptions(max_depth=3))
    bake_ambient_occlusion(textured(), "floor", 4, spp=1, seed=1)


PARTS = (numbers, representations, models, geometry, grids, textures, gaussians, paths, *LATER)
