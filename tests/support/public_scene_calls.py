"""Right calls of lights, textures, scenes and caustics; see support/public_calls.py."""

from __future__ import annotations

import numpy as np
from photograd import caustics, grids, lights, scenes, splats, textures, transport
from photograd.transport.builtin import cornell_box

from support.public_inputs import BOX, CORNERS, DEPTH, FACES, POINTS, RNG, Call


def light_calls() -> list[Call]:
    uv, colors = POINTS[:, :2], POINTS
    texture = RNG.random((4, 4, 3))
    mips = textures.build_mips(texture)
    levels = POINTS[:, 2]
    at, white = (0.0, 1.0, 0.0), (1.0, 1.0, 1.0)
    return [
        (lights.ConstantLight, {"radiance": white}),
        (lights.DirectionalLight, {"direction": at, "irradiance": white}),
        (lights.PointLight, {"position": at, "intensity": white}),
        (lights.SphereLight, {"center": at, "radius": 0.5, "radiance": white}),
        (lights.SunLight, {"direction": at, "radiance": white, "height": 0.01}),
        (lights.SkyLight, {"zenith": white, "horizon": white, "ground": white}),
        (lights.EnvironmentMap, {"texels": RNG.random((2, 4, 3)), "uniform_share": 0.1}),
        (lights.about_y, {"angle": 1.0}),
        (lights.cap_height, {"angular_radius": 0.1}),
        (textures.sample, {"texture": texture, "uv": uv}),
        (textures.sample_backward, {"texture": texture, "uv": uv, "d_color": colors}),
        (textures.build_mips, {"texture": texture}),
        (textures.build_mips_backward, {"d_mips": mips}),
        (textures.sample_mips, {"mips": mips, "uv": uv, "level": levels}),
        (textures.mip_level, {"shape": (4, 4), "footprint": RNG.random((5, 2, 2))}),
        (textures.TexturePlan, {"uv": uv, "colors": colors, "shape": (4, 4)}),
        (textures.recover, {"uv": uv, "colors": colors, "shape": (4, 4), "steps": 1}),
        (textures.loss_and_gradient, {"texture": texture, "uv": uv, "colors": colors}),
        (textures.stable_learning_rate, {"uv": uv, "shape": (4, 4), "channels": 3, "steps": 2}),
    ]


def transport_calls() -> list[Call]:
    room = cornell_box(8)
    tracer = transport.PathTracer(room)
    options = transport.PathOptions(max_depth=2)
    grid = {"corner": (0.0, 0.0, 1.0), "edge_x": (1.0, 0, 0), "edge_y": (0, 1.0, 0)}
    wall = transport.IrradianceSensor(**grid, height=2, width=2)
    return [
        (transport.PathTracer, {"scene": room}),
        (tracer.render, {"spp": 1, "seed": 0, "options": options}),
        (tracer.render_backward, {"d_image": np.ones((8, 8, 3)), "spp": 1, "seed": 0}),
        (transport.PathOptions, {"strategy": "mis", "heuristic": "power", "max_depth": 3}),
        (transport.Lens, {"radius": 0.1, "focus": 1.0}),
        (transport.Material, {"model": "lambert", "values": {"albedo": (0.5, 0.5, 0.5)}}),
        (transport.Medium, {"sigma_t": 1.0, "albedo": 0.5, "phase": "henyey_greenstein"}),
        (transport.DensityGrid, {"values": RNG.random((2, 2, 2))}),
        (transport.IrradianceSensor, {**grid, "height": 4, "width": 4}),
        (transport.Parameter, {"name": "materials.red.albedo", "start": 0.5}),
        (transport.RecoveryOptions, {"steps": 1, "spp": 1, "learning_rate": 0.1, "seed": 0}),
        (transport.builtin_scene, {"name": "cornell-box", "size": 8}),
        (
            transport.recover,
            {
                "scene": room,
                "targets": np.ones((8, 8, 3)),
                "parameters": ["materials.red.albedo"],
                "options": transport.RecoveryOptions(steps=1, spp=1, path=options),
            },
        ),
        (
            transport.derivative_image,
            {"tracer": tracer, "along": "materials.red.albedo", "spp": 1, "seed": 0},
        ),
        (transport.read_scene, {"path": "nowhere.toml"}),
        (transport.read_model, {"path": "nowhere.obj"}),
        (scenes.scene, {"name": "smooth_curves", "seed": 0}),
        (
            scenes.capture_cameras,
            {"bounds": BOX, "views": 2, "test_views": 1, "size": 8, "seed": 0},
        ),
        (splats.SplatOptions, {}),
        (splats.read_gaussians, {"path": "nowhere.ply"}),
        (transport.emit_particles, {"tracer": tracer, "count": 4, "seed": 0}),
        (transport.trace_light, {"tracer": tracer, "sensor": wall, "particles": 4, "seed": 0}),
        (grids.VoxelHash, {"voxels": np.array([[0, 0, 0], [1, 2, 3]])}),
        (grids.Volume, {"values": RNG.random((2, 2, 2)), "world_from_index": np.eye(4)}),
        (grids.read_volume, {"path": "nowhere.nrrd"}),
        (grids.read_vdb, {"path": "nowhere.vdb"}),
    ]


def caustic_calls() -> list[Call]:
    plate = {"corner": (0, 0, 0.0), "edge_x": (1.0, 0, 0), "edge_y": (0, 0, -1.0), "thickness": 0.1}
    lens = caustics.Lens(**plate, heights=np.zeros((5, 5)))
    sun = lights.DirectionalLight(direction=(0, -1.0, 0), irradiance=(1.0, 1.0, 1.0))
    wall = transport.IrradianceSensor((1.0, 0.9, 0), (-1.0, 0, 0), (0, 0, -1.0), 4, 4)
    ball = caustics.SpecularSphere(np.array([0, 0, 3.0]), 1.0, 1.5)
    world = caustics.SpecularScene([ball])
    rays = {"origins": np.zeros((4, 3)), "directions": np.tile([0, 0, 1.0], (4, 1))}
    axis = np.linspace(0, 1, 4)
    axes = caustics.Axes(axis, axis)
    maps = {"source": np.ones((4, 4)), "source_axes": axes, "target": np.ones((4, 4))}
    design = {"lenses": lens, "light": sun, "receiver": wall, "target": np.ones((4, 4))}
    quick = caustics.CausticOptions(start="plane", steps=1, rays=1)
    return [
        (caustics.Lens, {**plate, "heights": np.zeros((4, 4)), "eta": 1.5}),
        (caustics.Axes, {"x": axis, "y": axis}),
        (caustics.SpecularSphere, {"center": np.zeros(3), "radius": 1.0, "eta": 1.5}),
        (caustics.SpecularMesh, {"vertices": CORNERS, "faces": FACES, "eta": 1.5}),
        (caustics.SpecularScene, {"surfaces": [ball]}),
        (caustics.trace_chains, {"scene": world, **rays, "max_surfaces": 4}),
        (caustics.CausticOptions, {"start": "plane", "steps": 2, "rays": 1, "seed": 0}),
        (caustics.transport_map, {**maps, "target_axes": axes}),
        (
            caustics.transport_lens,
            {"lens": lens, "light": sun, "receiver": wall, "target": DEPTH[:4, :4]},
        ),
        (caustics.design_caustic, {**design, "options": quick}),
        (
            caustics.measure,
            {"lenses": [lens], "light": sun, "receiver": wall, "seed": 0, "rays": 1},
        ),
    ]
