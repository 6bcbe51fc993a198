"""Lenses: closed meshes, derivatives of heights, landing points, and power beside the tracer's."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import pytest
from photograd.caustics import Lens, SpecularScene, trace_chains, trace_chains_backward
from photograd.caustics.measure import correlation, measure
from photograd.caustics.receiver import (
    Landing,
    land,
    land_backward,
    outside,
    outside_backward,
    splat,
    splat_backward,
)
from photograd.errors import RangeError
from photograd.lights import DirectionalLight
from photograd.transport import IrradianceSensor, Material, PathTracer, Scene, trace_light
from photograd.transport.builtin import camera_at
from photograd.transport.mesh_files.read import read_model
from photograd.transport.mesh_files.stl import write_stl
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.gradient_mutants import check_gradient_mutants


def wavy(m: int = 9, n: int = 13, height: float = 0.002) -> Lens:
    y, x = np.meshgrid(np.linspace(0, 6, m), np.linspace(0, 9, n), indexing="ij")
    heights = height * np.sin(x + 0.4 * y)
    return Lens([-0.06, 0.1, 0.04], [0.12, 0, 0], [0, 0, -0.08], 0.02, heights, 1.5)


def receiver(height: int = 16, width: int = 24) -> IrradianceSensor:
    """Above the lens, looking down at it."""
    return IrradianceSensor([0.08, 0.4, 0.05], [-0.16, 0, 0], [0, 0, -0.1], height, width)


SUN = DirectionalLight([0, -1.0, 0], [1000.0] * 3)


def test_a_lens_is_closed_and_faces_outwards() -> None:
    lens = wavy()
    vertices, faces = lens.closed_mesh()
    edges = Counter((int(a), int(b)) for f in faces for a, b in zip(f, np.roll(f, -1), strict=True))
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)
    corners = vertices[faces]
    volume = np.einsum("fk,fk->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume == pytest.approx(0.12 * 0.08 * (0.02 + lens.heights.mean()), rel=0.02)
    split = np.concatenate([part.vertices[part.faces[:, 0]] for part in lens.surfaces()])
    assert len(split) == 2 + len(faces) - 2 * 8 * 12  # the front is two faces


def test_a_printable_file_reads_back(tmp_path: Any) -> None:
    lens = wavy()
    vertices, faces = lens.closed_mesh()
    write_stl(tmp_path / "lens.stl", 1000 * vertices, faces)
    shape = read_model(tmp_path / "lens.stl").shapes[0]
    corners = shape.vertices[shape.faces]
    np.testing.assert_allclose(corners, 1000 * vertices[faces], atol=1e-4)


class Heights:
    """Ends of rays behind a lens, with its triangles held, as a function of its heights."""

    def __init__(self) -> None:
        rng = np.random.default_rng(1)
        self.lens = wavy()
        across = rng.uniform(-1, 1, (50, 2)) * [0.05, 0.03]
        self.o = np.column_stack([across[:, 0], np.full(50, 0.05), across[:, 1]])
        self.d = np.array([0, 1.0, 0]) + 0.05 * rng.normal(size=(50, 3))
        self.place = {"heights": self.lens.heights}

    def traced(self, p: dict[str, Any]) -> tuple[Lens, SpecularScene, Any]:
        lens = Lens(
            self.lens.corner, self.lens.edge_x, self.lens.edge_y, 0.02, p["heights"], self.lens.eta
        )
        scene = SpecularScene(lens.surfaces())
        return lens, scene, trace_chains(scene, self.o, self.d)

    def forward(self, p: dict[str, Any]) -> dict[str, Any]:
        _, _, chains = self.traced(p)
        return {"origin": chains.origin, "direction": chains.direction, "factor": chains.factor}

    def backward(self, p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        lens, scene, chains = self.traced(p)
        found = trace_chains_backward(scene, chains, d["origin"], d["direction"], d["factor"])
        return {"heights": lens.heights_backward(found)}


def test_derivatives_of_heights() -> None:
    """Free differences: no ray comes near an edge in steps below a micrometer."""
    heights = Heights()
    steps = (1e-6, 1e-7, 1e-8)
    options: dict[str, Any] = {"seed": 1, "steps": steps}
    report = check_gradient(heights.forward, heights.backward, heights.place, **options)
    assert report, str(report)
    slope = taylor_slope(heights.forward, heights.backward, heights.place, seed=2, start=1e-5)
    assert slope, str(slope)
    rng = np.random.default_rng(2)
    values = heights.forward(heights.place)
    cotangent = {name: rng.uniform(-1, 1, array.shape) for name, array in values.items()}
    killed = check_gradient_mutants(
        heights.forward, heights.backward, heights.place, cotangent, coordinates=4, **options
    )
    assert killed, str(killed)


def test_derivatives_of_what_lands() -> None:
    rng = np.random.default_rng(3)
    sensor, count = receiver(4, 5), 60
    down = np.column_stack([rng.normal(size=(count, 2)) * 0.05, np.ones(count)])[:, [0, 2, 1]]
    place = {
        "origin": rng.uniform(-1, 1, (count, 3)) * [0.09, 0.01, 0.06],
        "direction": down,
        "power": rng.uniform(0.5, 1.5, count),
    }

    def forward(p: dict[str, Any]) -> dict[str, Any]:
        at = land(sensor, p["origin"], p["direction"])
        cells = splat(sensor, at, p["power"])
        return {"cells": cells, "outside": np.array(outside(sensor, at, p["power"]))}

    def backward(p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        at = land(sensor, p["origin"], p["direction"])
        one = splat_backward(sensor, at, p["power"], d["cells"])
        two = outside_backward(sensor, at, p["power"], float(d["outside"]))
        d_x, d_y, d_power = (a + b for a, b in zip(one, two, strict=True))
        d_o, d_d = land_backward(sensor, p["origin"], p["direction"], d_x, d_y)
        return {"origin": d_o, "direction": d_d, "power": d_power}

    values = forward(place)
    assert float(values["outside"]) > 1
    report = check_gradient(forward, backward, place, seed=4, steps=(1e-5, 1e-6, 1e-7))
    assert report, str(report)


def test_rows_of_cells_are_those_of_the_sensor() -> None:
    sensor = receiver(4, 6)
    up, back = np.array([[0, 1.0, 0]]), np.array([[0, -1.0, 0]])
    start = sensor.corner + 0.99 * sensor.edge_y + 0.01 * sensor.edge_x - [0, 0.2, 0]
    at = land(sensor, start[None], up)
    cells = splat(sensor, at, np.ones(1))
    assert np.unravel_index(cells.argmax(), cells.shape) == (0, 0)
    assert not land(sensor, start[None], back).good[0]
    middle = Landing(np.array([2.0]), np.array([3.0]), np.array([True]))
    assert splat(sensor, middle, np.ones(1))[3, 2] == 1.0


def test_light_behind_a_lens_is_that_of_traced_particles() -> None:
    """The light tracer sends its particles through the same glass, reflections included."""
    lens = wavy(33, 49)
    sensor = receiver()
    found = measure([lens], SUN, sensor, seed=0, rays=8)
    glass = Material("glass", {"eta": 1.5, "tint": [1, 1, 1]})
    camera = camera_at([0.0, 0.1, 1.0], [0, 0.1, 0], 30, 4, 4)
    scene = Scene("lens", (lens.shape("lens", "glass"),), {"glass": glass}, camera, lights=(SUN,))
    traced = trace_light(PathTracer(scene, dtype=np.float64), sensor, 1 << 18, seed=1).mean[..., 0]
    aperture = traced[2:-2, 4:-4]
    assert correlation(found.irradiance[2:-2, 4:-4], aperture) > 0.95
    assert found.irradiance[2:-2, 4:-4].mean() == pytest.approx(aperture.mean(), rel=0.02)
    flat = measure([wavy(3, 3, 0.0)], SUN, sensor, seed=0, rays=2)
    assert flat.transmitted / flat.emitted == pytest.approx(0.96**2, rel=1e-12)
    assert flat.emitted == pytest.approx(1000 * 0.12 * 0.08)


def test_lenses_that_are_none() -> None:
    square = ([0, 0, 0], [0.1, 0, 0], [0, 0.1, 0])
    with pytest.raises(RangeError, match=r"heights: .*finite"):
        Lens(*square, 0.01, np.full((3, 3), np.nan))
    with pytest.raises(RangeError, match="behind the front"):
        Lens(*square, 0.01, np.full((3, 3), -0.02))
    with pytest.raises(RangeError, match="perpendicular"):
        Lens([0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], 0.01, np.zeros((3, 3)))
    with pytest.raises(RangeError, match="eta"):
        Lens(*square, 0.01, np.zeros((3, 3)), 1.0)
    away = DirectionalLight([0, 1.0, 0], [1.0] * 3)
    with pytest.raises(RangeError, match="before the lens's front"):
        measure([wavy()], away, receiver(), seed=0)
