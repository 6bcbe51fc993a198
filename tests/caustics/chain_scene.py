"""A wavy sheet of glass, a glass ball and a mirror ball, as groups of numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.caustics import SpecularMesh, SpecularScene, SpecularSphere
from photograd.caustics.chains import ENDED, Chains, _intersect
from photograd.caustics.intersections import unit
from photograd.caustics.lens import grid_faces
from photograd.caustics.scattering import scatter

SIDE = 7
FACES = grid_faces(SIDE, SIDE)


def place(*, smooth: bool = True) -> dict[str, Any]:
    """The parameters; the sheet spans 2 m, its outside is above."""
    y, x = np.meshgrid(*[np.linspace(-1, 1, SIDE)] * 2, indexing="ij")
    sheet = np.stack([x, y, 0.05 * np.sin(3 * x + y)], axis=-1).reshape(-1, 3)
    bent = np.array([0.0, 0.0, 1.0]) + 0.1 * np.random.default_rng(4).normal(size=sheet.shape)
    found = {
        "vertices": sheet,
        "eta": np.array(1.4),
        "center": np.array([0.1, 0.05, -1.5]),
        "radius": np.array(0.9),
        "ball eta": np.array(1.6),
        "mirror": np.array([0.3, 0.0, -6.0]),
        "mirror radius": np.array(2.0),
    }
    return {**found, "normals": bent} if smooth else found


def scene(p: dict[str, Any]) -> SpecularScene:
    """The surfaces of these numbers."""
    return SpecularScene(
        [
            SpecularMesh(p["vertices"], FACES, p.get("normals"), float(p["eta"])),
            SpecularSphere(p["center"], float(p["radius"]), float(p["ball eta"])),
            SpecularSphere(p["mirror"], float(p["mirror radius"]), None),
        ]
    )


def rays(count: int) -> tuple[Any, Any, Any]:
    """Origins, directions, and random numbers of the lobes."""
    rng = np.random.default_rng(1)
    across = rng.uniform(-0.5, 0.5, (count, 2))
    origins = np.column_stack([across, np.full(count, 3.0)])
    directions = unit(np.array([0.0, 0.0, -1.0]) + 0.1 * rng.normal(size=(count, 3)))
    return origins, directions, rng.uniform(size=(count, 10))


def held(p: dict[str, Any], base: Chains, origins: Any, directions: Any) -> dict[str, Any]:
    """Ends of chains that pass the triangles and lobes of `base`, wherever the surfaces are."""
    surfaces = scene(p).surfaces
    o, d, f = origins.copy(), directions.copy(), np.ones(len(origins))
    for step in base.steps:
        surface, r = surfaces[step.surface], step.rays
        point = _intersect(surface, o[r], d[r], step.primitive)
        out = scatter(d[r], point.normal, surface.eta, step.reflected, step.pmf)
        o[r], d[r], f[r] = point.position, out.direction, f[r] * out.factor
    live = base.state == ENDED
    return {"origin": o * live[:, None], "direction": d * live[:, None], "factor": f * live}


def groups(gradients: list[Any], names: Any) -> dict[str, Any]:
    """The surfaces' gradients under the names of `place`."""
    sheet, ball, mirror = gradients
    found = {
        "vertices": sheet.vertices,
        "normals": sheet.normals,
        "eta": np.array(sheet.eta),
        "center": ball.center,
        "radius": np.array(ball.radius),
        "ball eta": np.array(ball.eta),
        "mirror": mirror.center,
        "mirror radius": np.array(mirror.radius),
    }
    return {name: found[name] for name in names}
