"""Right calls of public functions and classes, for tests that make them wrong.

Each is a function and its named arguments, small enough to take milliseconds.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from photograd import capture, frame, geometry, network, raster, transport, vector
from photograd.geometry.mesh import Mesh
from photograd.transport.builtin import cornell_box

from support.public_inputs import (
    BOX,
    CAMERA,
    COLOR,
    CORNERS,
    DEPTH,
    FACES,
    MESH,
    NORMALS,
    POINTS,
    Call,
    H,
    W,
)
from support.public_scene_calls import caustic_calls, light_calls, transport_calls


def raster_calls() -> list[Call]:
    at = raster.project(CORNERS, CAMERA)
    seen = raster.rasterize(at, FACES, (H, W))
    drawn = {"positions": at, "faces": FACES}
    ring = np.array([[1.0, 1], [5, 1], [3, 4]])
    edges = raster.MeshEdges.of(FACES)
    crossings = raster.find_crossings(at, FACES, seen, edges)
    return [
        (raster.project, {"vertices": CORNERS, "camera": CAMERA}),
        (raster.project_backward, {"vertices": CORNERS, "camera": CAMERA, "d_positions": at}),
        (raster.rasterize, {**drawn, "size": (H, W), "options": raster.RasterOptions()}),
        (raster.rasterize_backward, {**drawn, "visibility": seen, "d_depth": DEPTH}),
        (raster.interpolate, {"attributes": CORNERS, "faces": FACES, "visibility": seen}),
        (raster.footprints, {"attributes": CORNERS[:, :2], **drawn, "visibility": seen}),
        (raster.FaceLookup, {**drawn, "size": (H, W), "near": 1e-3}),
        (raster.soft_silhouette, {**drawn, "size": (H, W), "sigma": 0.2}),
        (raster.soft_silhouette_backward, {**drawn, "d_silhouette": DEPTH, "sigma": 0.2}),
        (raster.polygon_coverage, {"points": ring, "size": (H, W)}),
        (raster.polygon_coverage_backward, {"points": ring, "d_coverage": DEPTH}),
        (raster.RasterOptions, {"near": 1e-3, "far": 10.0, "cull": "none", "depth_test": "less"}),
        (raster.Stencil, {"compare": "always", "reference": 1, "read_mask": 255}),
        (raster.MeshEdges.of, {"faces": FACES}),
        (raster.find_crossings, {**drawn, "visibility": seen, "edges": edges}),
        (raster.antialias, {"color": COLOR, "crossings": crossings}),
        (raster.sample_edges, {"positions": at, "edges": edges, "size": (H, W), "seed": 0}),
    ]


def frame_calls() -> list[Call]:
    aperture = transport.Lens(0.1, 1.0)
    return [
        (frame.fxaa, {"display": COLOR}),
        (frame.bloom, {"color": COLOR, "weights": np.array([0.1, 0.2]), "threshold": 0.5}),
        (frame.bloom_backward, {"color": COLOR, "weights": np.array([0.1]), "d_out": COLOR}),
        (frame.chromatic_aberration, {"color": COLOR, "strength": 0.02}),
        (frame.circle_of_confusion, {"depth": DEPTH, "camera": CAMERA, "lens": aperture}),
        (
            frame.depth_of_field,
            {"color": COLOR, "depth": DEPTH, "camera": CAMERA, "lens": aperture, "samples": 3},
        ),
        (frame.dither, {"display": COLOR, "levels": 16, "seed": 1, "strength": 1.0}),
        (
            frame.add_fog,
            {
                "radiance": COLOR,
                "depth": DEPTH,
                "camera": CAMERA,
                "sigma_t": 0.1,
                "color": COLOR[0, 0],
            },
        ),
        (frame.motion_blur, {"color": COLOR, "moved": COLOR[..., :2], "samples": 3}),
        (frame.vignette, {"color": COLOR, "camera": CAMERA, "strength": 1.0}),
        (frame.tone_map, {"color": COLOR, "curve": "reinhard", "exposure": 0.5}),
        (frame.tone_map_backward, {"color": COLOR, "d_out": COLOR, "curve": "agx"}),
        (
            frame.tune_bloom,
            {"color": COLOR, "target": COLOR, "weights": np.array([0.1]), "steps": 1},
        ),
        (frame.tune_tone_curve, {"radiance": COLOR, "target": COLOR, "curve": "agx", "steps": 1}),
    ]


def frame_pass_calls() -> list[Call]:
    layer = frame.Layer(DEPTH, COLOR, DEPTH / 4)
    screen = {"depth": DEPTH, "normals": NORMALS, "camera": CAMERA}
    room = frame.FrameScene(cornell_box(8))
    camera = room.scene.camera
    return [
        (frame.ssao, {**screen, "settings": frame.SsaoSettings(), "samples": 3}),
        (frame.ssao_backward, {**screen, "d_out": DEPTH, "samples": 3}),
        (frame.SsaoSettings, {"radius": 0.5, "falloff": 1.0, "bias": 0.1}),
        (frame.horizon_occlusion, {**screen, "settings": frame.HorizonSettings(slices=1, steps=2)}),
        (frame.HorizonSettings, {"radius": 0.5, "falloff": 0.5, "slices": 2, "steps": 2}),
        (frame.follow_screen_rays, {**screen, "wi": -NORMALS}),
        (frame.ScreenRaySettings, {"length": 1.0, "thickness": 0.2, "steps": 3}),
        (frame.blend_weighted, {"layers": [layer], "behind": COLOR, "scale": 1.0}),
        (frame.blend_nearest_first, {"layers": [layer, layer], "behind": COLOR}),
        (frame.meshlets, {"vertices": CORNERS, "faces": FACES, "shape": np.zeros(2, np.int64)}),
        (frame.FrameOptions, {"surface_points": 2, "sky_directions": 2, "occlusion_samples": 2}),
        (frame.ShadowSettings, {"size": 16, "filter_radius": 1, "normal_bias": 1.0}),
        (frame.TemporalAntialiasing, {"weight": 0.1, "clamped": True, "frames": 0}),
        (frame.FrameScene, {"scene": room.scene, "sphere_divisions": 4}),
        (frame.frame_graph, {"scene": room, "options": frame.FrameOptions()}),
        (frame.draw_surfaces, {"scene": room, "camera": camera}),
        (frame.delta_lights, {"scene": room}),
        (frame.surface_lights, {"scene": room, "count": 2}),
        (frame.sky_lights, {"scene": room, "count": 2}),
        (frame.traced_occlusion, {"scene": room, "camera": camera, "spp": 1, "seed": 0}),
        (frame.background, {"scene": room.scene, "camera": camera}),
        (frame.SceneDetail, {"scene": room.scene}),
        (frame.PassGraph, {"passes": (), "inputs": ("camera",)}),
    ]


def vector_calls() -> list[Call]:
    ring = vector.Subpath.lines([[1, 1], [6, 1], [6, 6]])
    shape = vector.Shape(
        (ring,), vector.Solid(np.array([0.5, 0.2, 0.1])), stroke=vector.Stroke(1.0)
    )
    drawing = vector.Drawing.of([shape])
    rendering = vector.Rendering(drawing, (H, W))
    bent = np.array([[0, 0], [1, 1.0], [2, 0], [3, 3]])
    stops = {"offsets": np.array([0, 1.0]), "colors": np.full((2, 4), 0.5)}
    options = vector.VectorFitOptions(steps=1)
    return [
        (vector.Subpath, {"points": bent, "degrees": (3,), "closed": False}),
        (vector.Subpath.lines, {"points": bent, "closed": True}),
        (vector.Subpath.circle, {"center": (1.0, 2.0), "radius": 1.0}),
        (vector.Stroke, {"width": 1.0, "cap": "butt", "join": "round", "miter_limit": 4.0}),
        (vector.Solid, {"color": np.ones(3), "alpha": 0.5}),
        (vector.LinearGradient, {"start": bent[0], "end": bent[1], **stops}),
        (vector.RadialGradient, {"center": bent[0], "radius": 2.0, **stops}),
        (vector.Shape, {"subpaths": (ring,), "paint": vector.Solid(np.ones(3)), "opacity": 0.5}),
        (vector.Drawing.of, {"shapes": [shape]}),
        (vector.Flattening, {"tolerance": 0.1, "segments": 3, "arc": 4}),
        (vector.Rendering, {"drawing": drawing, "size": (H, W), "background": (0.0, 0, 0, 1)}),
        (vector.render, {"drawing": drawing, "size": (H, W)}),
        (rendering.backward, {"d_picture": rendering.picture}),
        (rendering.coverage, {"shape": 0}),
        (rendering.coverage_backward, {"shape": 0, "d_coverage": DEPTH}),
        (drawing.with_parameters, {"parameters": drawing.parameters}),
        (vector.curve_distance, {"control": bent, "points": POINTS[:, :2]}),
        (
            vector.curve_distance_backward,
            {"control": bent, "points": POINTS[:, :2], "d_distance": POINTS[:, 0]},
        ),
        (vector.distance_stroke, {"control": bent, "width": 1.0, "size": (H, W)}),
        (vector.random_curves, {"picture": COLOR, "count": 2, "kind": "fill", "seed": 1}),
        (vector.fit_curves, {"picture": COLOR, "count": 1, "options": options, "kind": "stroke"}),
        (vector.fit_drawing, {"drawing": drawing, "picture": COLOR, "options": options}),
        (vector.VectorFitOptions, {"steps": 2, "point_rate": 0.5, "seed": 1}),
        (vector.svg_text, {"drawing": drawing, "size": (H, W), "linear": True}),
        (vector.read_svg, {"source": vector.svg_text(drawing, (H, W)).encode(), "linear": False}),
    ]


def network_calls() -> list[Call]:
    inputs = POINTS.astype(np.float32)
    net = network.Perceptron(3, (4, 2))
    numbers = net.initial(seed=0)
    many = network.Perceptrons(net)
    coded = network.HashEncoding((2, 4), dimensions=3, log2_rows=4)
    table = coded.initial(seed=0)
    waves, blobs = network.FrequencyEncoding(2), network.OneBlobEncoding(4)
    d_out = np.ones((5, 2), np.float32)
    both = {"parameters": np.tile(numbers, (2, 1)), "offset": np.array([0, 3, 5]), "inputs": inputs}
    return [
        (network.Perceptron, {"inputs": 3, "widths": (4, 2), "hidden": "relu", "skip": 0}),
        (net.initial, {"seed": 0, "dtype": np.float32}),
        (net.forward, {"parameters": numbers, "inputs": inputs}),
        (net.backward, {"parameters": numbers, "inputs": inputs, "d_outputs": d_out}),
        (net.layers, {"parameters": numbers}),
        (network.Perceptrons, {"each": net}),
        (many.forward, both),
        (many.backward, {**both, "d_outputs": d_out}),
        (network.HashEncoding, {"resolutions": (2, 4), "dimensions": 2, "log2_rows": 4}),
        (network.HashEncoding.geometric, {"levels": 3, "coarsest": 2, "finest": 8, "log2_rows": 4}),
        (coded.encode, {"table": table, "points": inputs}),
        (network.FrequencyEncoding, {"octaves": 2, "dimensions": 3}),
        (waves.encode, {"points": inputs}),
        (network.OneBlobEncoding, {"bins": 4, "dimensions": 3}),
        (blobs.encode, {"points": inputs}),
    ]


def geometry_calls() -> list[Call]:
    tree, box = geometry.ReferenceBvh(MESH), np.array([BOX])
    return [
        (Mesh, {"vertices": CORNERS, "faces": FACES, "uv": None}),
        (geometry.BspTree, {"mesh": MESH, "candidates": 2, "max_polygons": 100}),
        (geometry.ReferenceBvh, {"mesh": MESH, "leaf_size": 2, "bins": 4, "max_depth": 8}),
        (tree.trace, {"origins": POINTS, "directions": POINTS + 1}),
        (geometry.CullingTree, {"boxes": box, "max_depth": 2}),
        (geometry.clustered, {"mesh": MESH, "cell": 0.5}),
        (geometry.LevelsOfDetail, {"mesh": MESH, "cells": (0.1, 0.5)}),
        (geometry.nearest_on_mesh, {"points": POINTS, "mesh": MESH}),
        (geometry.order_by_distance, {"points": POINTS, "eye": np.zeros(3), "far_first": True}),
        (capture.Camera, {**vars(CAMERA)}),
        (capture.sees_box, {"camera": CAMERA, "box": BOX}),
        (capture.Distortion, {"k1": 0.1, "k2": 0.0, "p1": 0.0, "p2": 0.0}),
        (capture.FisheyeDistortion, {"k1": 0.1, "k2": 0.0}),
    ]


GROUPS = (
    raster_calls,
    frame_calls,
    frame_pass_calls,
    vector_calls,
    network_calls,
    geometry_calls,
    light_calls,
    transport_calls,
    caustic_calls,
)


def every_call() -> list[Call]:
    return [call for group in GROUPS for call in group()]


def name_of(function: Any) -> str:
    function = function.func if isinstance(function, partial) else function
    return str(getattr(function, "__qualname__", function))
