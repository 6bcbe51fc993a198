"""Pictures of smooth glass and mirrors under a sky, with derivatives that move the paths.

    L(pixel) = mean over samples of  color of the lobes  x  factor of the chain  x  sky(direction)

This is the path tracer's picture of such a scene, with lobes chosen at random. Its derivative
follows the path [NimierDavid2019]: the direction in which a chain leaves turns with the index of
refraction, with vertices, normals and spheres, and what is seen there changes.

That is the whole derivative where a ray's radiance is continuous in the ray. Glass spheres are: at
the rim all light is reflected, and goes straight on. Where it is not, edges would move, and that
term is missing; `discontinuities` finds what it can of:

    flat faces                     directions jump from face to face
    edges of meshes                rays of the same lobes meet a mesh here and something else there
    leaks                          blended normals send rays to the wrong side of a face
    mirrors that absorb            spheres of another reflectance than 1, at their rims
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.caustics.chains import (
    ENDED,
    LEAKED,
    Chains,
    SpecularScene,
    trace_chains,
    trace_chains_backward,
)
from photograd.caustics.surfaces import SpecularMesh, SpecularSphere, Surface
from photograd.errors import SceneError, message
from photograd.transport.incomplete import Missing, WholeGradients
from photograd.transport.material import Material
from photograd.transport.scene import Environment, Scene
from photograd.transport.shapes import MeshShape, Shape, SphereShape
from photograd.types import Array, FloatArray

MAX_SURFACES = 16
REMEDY = "look only at what is continuous, or ask for it with allow_incomplete=True"


class _Traced(NamedTuple):
    """One pass over all samples."""

    specular: SpecularScene
    chains: Chains
    color: Array  # (R, 3) of the lobes
    pixel: Array  # (R,)


def surface_of(function: str, shape: Shape, material: Material) -> Surface:
    """A shape of a scene as a surface of chains.

    Args:
        function: that was called, for errors.
        shape: a mesh or a sphere that stands still and does not shine.
        material: glass or a mirror, without textures and alpha.

    Raises:
        SceneError: anything else.
    """
    plain = not material.textures and material.normal_map is None and not material.has_opacity
    if material.model not in ("glass", "mirror") or not plain:
        expected, got = "glass or mirror, without textures or alpha", material.model
        raise SceneError(message(function, f"{shape.name}.material", expected, got))
    eta = float(np.asarray(material.values["eta"])) if material.model == "glass" else None
    if isinstance(shape, SphereShape) and shape.closing is None and not shape.emission.any():
        return SpecularSphere(shape.center, shape.radius, eta)
    moved = isinstance(shape, MeshShape) and (shape.instances or shape.closing_instances)
    if not isinstance(shape, MeshShape) or moved or shape.emission.any():
        expected = "meshes and spheres that stand once, still, and do not shine"
        got = type(shape).__name__
        raise SceneError(message(function, f"shapes.{shape.name}", expected, got))
    return SpecularMesh(shape.vertices, shape.faces, shape.normals, eta)


def _environment(function: str, scene: Scene) -> Environment:
    if scene.environment is None or scene.lights or scene.media or scene.lens.radius > 0:
        expected = "an environment and no lights, media or lens"
        got = "none" if scene.environment is None else "more"
        raise SceneError(message(function, "scene", expected, got))
    return scene.environment


def _samples(function: str, scene: Scene, spp: int, seed: int) -> _Traced:
    surfaces = [surface_of(function, s, scene.materials[s.material]) for s in scene.shapes]
    specular, camera = SpecularScene(surfaces), scene.camera
    count = camera.width * camera.height
    pixel, sample = np.repeat(np.arange(count), spp), np.tile(np.arange(spp), count)
    address = {"pixel": pixel[:, None], "sample": sample[:, None]}
    u = uniform(seed, dimension=np.arange(2 + MAX_SURFACES)[None, :], **address)
    origins, directions = camera_rays(camera, pixel, u[:, :2])
    chains = trace_chains(specular, origins, directions, u[:, 2:])
    color = np.ones((len(pixel), 3))
    for step in chains.steps:
        material = scene.materials[scene.shapes[step.surface].material]
        if material.model == "mirror":
            color[step.rays] *= np.asarray(material.values["reflectance"])
        else:
            tint = np.asarray(material.values["tint"])
            color[step.rays] *= np.where(step.reflected[:, None], 1.0, tint)
    return _Traced(specular, chains, color, pixel)


def camera_rays(camera: Camera, pixel: Array, inside: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Origins and unit directions (R, 3) of rays through points of pixels.

    Args:
        camera: a pinhole.
        pixel: (R,) row * width + column.
        inside: (R, 2) column and row within the pixel, 0 to 1.
    """
    x = (pixel % camera.width + inside[:, 0] - camera.cx) / camera.fx
    y = (pixel // camera.width + inside[:, 1] - camera.cy) / camera.fy
    axes = camera.world_from_camera[:3, :3].T
    way = x[:, None] * axes[0] + y[:, None] * axes[1] + axes[2]
    directions = way / np.sqrt(np.square(way).sum(axis=1, keepdims=True))
    return np.broadcast_to(camera.position, directions.shape).copy(), directions


def sky(environment: Environment, directions: FloatArray) -> FloatArray:
    """(R, 3) radiance from unit directions, as cpp/photograd/light/sky.h has it.

    Args:
        environment: three colors.
        directions: (R, 3).
    """
    up, down = np.maximum(directions[:, 1:2], 0.0), np.maximum(-directions[:, 1:2], 0.0)
    level = environment.horizon * (1.0 - up - down)
    return np.asarray(level + environment.zenith * up + environment.ground * down)


def sky_backward(environment: Environment, directions: FloatArray, d_L: FloatArray) -> FloatArray:
    """The derivative dL/ddirection (R, 3) of `sky`.

    Args:
        environment, directions: as for `sky`.
        d_L: (R, 3) dL/d of what it returned.
    """
    above = environment.zenith - environment.horizon
    below = environment.horizon - environment.ground
    slope = np.where(directions[:, 1:2] > 0, above, below)
    d_directions = np.zeros_like(directions)
    d_directions[:, 1] = (d_L * slope).sum(axis=1)
    return d_directions


@typed_call
def specular_picture(scene: Scene, *, spp: int, seed: int) -> FloatArray:
    """The picture (H, W, 3), linear radiance, of a scene of smooth glass and mirrors under a sky.

    Args:
        scene: meshes and spheres of model glass or mirror, an environment, a pinhole camera that is
            outside of all glass.
        spp: samples a pixel.
        seed: of all random numbers.

    Raises:
        RangeError: spp below 1.
        SceneError: other materials, shapes, lights or cameras.
    """
    name = "specular_picture"
    Arguments(name).integer("spp", spp, low=1)
    environment, camera = _environment(name, scene), scene.camera
    traced = _samples(name, scene, spp, seed)
    radiance = (
        traced.color * traced.chains.factor[:, None] * sky(environment, traced.chains.direction)
    )
    picture: FloatArray = radiance.reshape(camera.height, camera.width, spp, 3).mean(axis=2)
    return picture


@typed_call
def specular_picture_backward(
    scene: Scene, d_image: Array, *, spp: int, seed: int, allow_incomplete: bool = False
) -> dict[str, Array]:
    """dL/d of geometry and eta of dL/dimage (H, W, 3), with paths that move.

    Args:
        scene, spp, seed: as for `specular_picture`.
        d_image: (H, W, 3).
        allow_incomplete: hand out derivatives where something discontinuous is seen, too: the part
            without moving edges.

    Returns:
        {name: array}: "materials.NAME.eta" (); "shapes.NAME.center" (3,) and ".radius" ();
        "shapes.NAME.vertices" and, where a mesh has normals, ".normals" (V, 3).

    Raises:
        ShapeError, RangeError: d_image of another shape or not finite, spp below 1; on access to a
            derivative that `discontinuities` makes incomplete.
        SceneError: as `specular_picture`.
    """
    name = "specular_picture_backward"
    call = Arguments(name, np.float64)
    camera, environment = scene.camera, _environment(name, scene)
    d_image = call.array("d_image", d_image, (camera.height, camera.width, 3))
    call.integer("spp", spp, low=1)
    traced = _samples(name, scene, spp, seed)
    chains = traced.chains
    d_L = d_image.reshape(-1, 3)[traced.pixel] / spp * traced.color
    d_direction = sky_backward(environment, chains.direction, d_L * chains.factor[:, None])
    d_factor = (d_L * sky(environment, chains.direction)).sum(axis=1)
    none = np.zeros_like(d_direction)
    surfaces = trace_chains_backward(traced.specular, chains, none, d_direction, d_factor)
    found: dict[str, Array] = {}
    for shape, surface in zip(scene.shapes, surfaces, strict=True):
        key = f"materials.{shape.material}.eta"
        if scene.materials[shape.material].model == "glass":
            found[key] = found.get(key, np.zeros(())) + surface.eta
        if isinstance(shape, SphereShape):
            found[f"shapes.{shape.name}.center"] = surface.center
            found[f"shapes.{shape.name}.radius"] = np.array(surface.radius)
        elif isinstance(shape, MeshShape):
            found[f"shapes.{shape.name}.vertices"] = surface.vertices
            if shape.normals is not None:
                found[f"shapes.{shape.name}.normals"] = surface.normals
    reasons = [] if allow_incomplete else _reasons(scene, traced)
    missing = Missing("; ".join(reasons) + ", and moves", REMEDY)
    return WholeGradients(name, found, found, dict.fromkeys(found, missing) if reasons else {})


@typed_call
def discontinuities(scene: Scene, *, spp: int, seed: int) -> list[str]:
    """What in a picture is discontinuous, a sentence each; none where derivatives are whole.

    Args:
        scene, spp, seed: as for `specular_picture`. More samples see rarer paths.

    Raises:
        SceneError: as `specular_picture`.
    """
    _environment("discontinuities", scene)
    return _reasons(scene, _samples("discontinuities", scene, spp, seed))


def _reasons(scene: Scene, traced: _Traced) -> list[str]:
    chains, found = traced.chains, []
    met = {step.surface for step in chains.steps if len(step.rays)}
    for i in sorted(met):
        shape = scene.shapes[i]
        material = scene.materials[shape.material]
        if isinstance(shape, MeshShape) and shape.normals is None:
            found.append(f"faces of '{shape.name}' are flat")
        mirrored = np.asarray(material.values.get("reflectance", 1.0))
        if isinstance(shape, SphereShape) and (mirrored != 1).any():
            found.append(f"the rim of '{shape.name}', which absorbs, is seen")
    if (chains.state == LEAKED).any():
        found.append("blended normals send rays through faces")
    edges = [scene.shapes[i] for i in sorted(_edges(traced))]
    meshes = [shape.name for shape in edges if isinstance(shape, MeshShape)]
    return found + [f"an edge of '{name}' is seen" for name in meshes]


def _edges(traced: _Traced) -> set[int]:
    """Surfaces that some rays meet next, and others of the same lobes so far do not."""
    chains = traced.chains
    count = len(chains.origin)
    lobes, depth = np.ones(count, np.int64), np.zeros(count, np.int64)
    after: dict[tuple[int, int], set[int]] = {}
    for step in chains.steps:
        if not len(step.rays):
            continue
        for key in np.unique(lobes[step.rays]):
            after.setdefault((int(depth[step.rays[0]]), int(key)), set()).add(step.surface)
        lobes[step.rays] = 2 * lobes[step.rays] + step.reflected
        depth[step.rays] += 1
    for ended in np.unique(np.stack([depth, lobes], axis=1)[chains.state == ENDED], axis=0):
        after.setdefault((int(ended[0]), int(ended[1])), set()).add(-1)
    return {i for next_ones in after.values() if len(next_ones) > 1 for i in next_ones if i >= 0}
