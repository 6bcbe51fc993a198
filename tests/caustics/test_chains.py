"""Chains: attached derivatives against moved paths, wrong ones, and the path tracer's own paths."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.caustics import (
    SpecularMesh,
    SpecularScene,
    SpecularSphere,
    trace_chains,
    trace_chains_backward,
)
from photograd.caustics.chains import ENDED, LEAKED, TRAPPED, Chains
from photograd.caustics.lens import grid_faces
from photograd.errors import RangeError, ShapeError
from photograd.transport import Environment, Material, PathTracer, Scene, SphereShape
from photograd.transport.builtin import camera_at
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.caustics import chain_scene

COUNT = 40
STEPS = (1e-4, 1e-5, 1e-6)  # larger ones move balls away from held rays


class Ends:
    """Ends of chains as a function of the surfaces, and its adjoint."""

    def __init__(self, place: dict[str, Any]) -> None:
        self.place = place
        self.origins, self.directions, self.u = chain_scene.rays(COUNT)
        self.base = self.trace(place)

    def trace(self, p: dict[str, Any]) -> Chains:
        return trace_chains(chain_scene.scene(p), self.origins, self.directions, self.u)

    def forward(self, p: dict[str, Any]) -> dict[str, Any]:
        return chain_scene.held(p, self.base, self.origins, self.directions)

    def backward(self, p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        scene, chains = chain_scene.scene(p), self.trace(p)
        given = (d["origin"], d["direction"], d["factor"])
        return chain_scene.groups(trace_chains_backward(scene, chains, *given), self.place)


@pytest.mark.parametrize("smooth", [True, False])
def test_every_group_agrees_with_central_differences_of_the_moved_path(smooth: bool) -> None:
    ends = Ends(chain_scene.place(smooth=smooth))
    chains = ends.base
    assert (chains.state == ENDED).sum() > 30
    assert chains.count.max() == 4
    assert {step.surface for step in chains.steps} == {0, 1, 2}
    assert any(step.reflected.any() and not step.reflected.all() for step in chains.steps)
    factor = ends.forward(ends.place)["factor"]
    np.testing.assert_allclose(factor, chains.factor, rtol=1e-12)
    report = check_gradient(ends.forward, ends.backward, ends.place, seed=1, steps=STEPS)
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    ends = Ends(chain_scene.place())
    rng = np.random.default_rng(2)
    values = ends.forward(ends.place)
    cotangent = {name: rng.uniform(-1, 1, array.shape) for name, array in values.items()}
    report = check_gradient_mutants(
        ends.forward, ends.backward, ends.place, cotangent, seed=1, coordinates=4, steps=STEPS[1:]
    )
    assert report, str(report)


def test_a_free_change_agrees_where_nothing_is_discontinuous() -> None:
    """A mirror that fills the view: new hits are looked for, and the derivative is whole."""
    y, x = np.meshgrid(*[np.linspace(-2, 2, 33)] * 2, indexing="ij")
    flat = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    rng = np.random.default_rng(3)
    across = rng.uniform(-1, 1, (20000, 2))
    o = np.column_stack([across, np.full(len(across), 1.0)])
    d = np.broadcast_to([0.1, 0.0, -1.0], o.shape)
    change = np.zeros_like(flat)
    change[:, 2] = 0.05 * np.sin(3 * x + 2 * y).reshape(-1)
    bend = np.cos(3 * x + 2 * y)
    d_n = np.stack([-0.15 * bend, -0.1 * bend, 0 * x], axis=-1).reshape(-1, 3)
    weight = rng.normal(size=3)

    def mean(t: float) -> tuple[float, Any, Any]:
        normals = np.array([0, 0, 1.0]) + t * d_n
        scene = SpecularScene([SpecularMesh(flat + t * change, grid_faces(33, 33), normals, None)])
        chains = trace_chains(scene, o, d)
        ends = chains.origin + (2.0 - chains.origin[:, 2:]) / chains.direction[:, 2:] * (
            chains.direction
        )
        return float(np.sin(ends @ weight).mean()), scene, chains

    t, h = 1.0, 1e-3
    _, scene, chains = mean(t)
    reach = (2.0 - chains.origin[:, 2]) / chains.direction[:, 2]
    ends = chains.origin + reach[:, None] * chains.direction
    d_end = np.cos(ends @ weight)[:, None] * weight / len(o)
    slide = (d_end * chains.direction).sum(axis=1) / chains.direction[:, 2]
    d_o = d_end - slide[:, None] * np.array([0, 0, 1.0])
    (found,) = trace_chains_backward(scene, chains, d_o, reach[:, None] * d_o, np.zeros(len(o)))
    whole = (found.vertices * change).sum() + (found.normals * d_n).sum()
    difference = (mean(t + h)[0] - mean(t - h)[0]) / (2 * h)
    assert abs(whole) > 1e-3
    assert whole == pytest.approx(difference, rel=1e-3)  # 20000 rays cross edges smoothly: 2e-4
    held_normals = (found.vertices * change).sum()
    assert held_normals != pytest.approx(difference, rel=0.2)


def test_chains_are_paths_of_the_path_tracer() -> None:
    """Same directions behind every surface and the same weight, path by path."""
    ball, other = np.array([0.125, 0.0, 0.0]), np.array([-0.75, 0.25, -1.5])  # exact in float32
    shapes = (SphereShape("one", ball, 0.75, "glass"), SphereShape("two", other, 0.5, "crown"))
    materials = {
        "glass": Material("glass", {"eta": 1.5, "tint": [1, 1, 1]}),
        "crown": Material("glass", {"eta": 1.75, "tint": [1, 1, 1]}),
    }
    camera = camera_at([0, 0.2, 4], [0, 0, 0], 30, 6, 6)
    sky = Environment.constant(1.0)
    tracer = PathTracer(Scene("balls", shapes, materials, camera, sky), dtype=np.float64)
    scene = SpecularScene([SpecularSphere(ball, 0.75, 1.5), SpecularSphere(other, 0.5, 1.75)])
    seen, apart = 0, []
    for pixel in range(36):
        path = tracer.path(pixel, 0, seed=3)
        if path[-1]["shape"] != -1 or len(path) < 2:
            continue
        reflected = [vertex["lobe"] == 0 for vertex in path[:-1]]
        u = np.where([*reflected, False], 0.0, 1.0 - 2.0**-53)[None]
        start = camera.world_from_camera[:3, 3][None]
        chains = trace_chains(scene, start, np.array([path[0]["direction"]]), u)
        assert chains.state[0] == ENDED
        assert chains.count[0] == len(path) - 1
        apart.append(float(np.abs(chains.direction[0] - path[-1]["direction"]).max()))
        weight = np.prod([vertex["f"][0] for vertex in path[:-1]])  # 1 / e^2 cancels outside
        kept = chains.factor[0] * np.prod([step.pmf[0] for step in chains.steps])
        assert kept == pytest.approx(weight, rel=1e-3)
        seen += len(path) > 2
    assert seen >= 8
    assert np.median(apart) < 2e-5  # the tracer's rays begin a little off the surface
    assert max(apart) < 1e-4


def test_what_ends_a_chain() -> None:
    ball = SpecularScene([SpecularSphere([0, 0, 0], 1.0, 1.5)])
    inside = trace_chains(ball, [[0, 0, 0.9]], [[1.0, 0, 0.1]])
    assert inside.state[0] == TRAPPED
    assert inside.factor[0] == 0
    none = trace_chains(ball, [[0, 5.0, 0]], [[1.0, 0, 0]])
    assert (none.state[0], none.count[0], none.first[0], none.factor[0]) == (ENDED, 0, -1, 1.0)
    bent = np.tile([1.0, -0.2, -0.2], (3, 1))
    tilted = SpecularMesh(np.eye(3) * 2, np.array([[0, 1, 2]]), bent, None)
    lost = trace_chains(SpecularScene([tilted]), [[2.0, 2.0, 2.0]], [[-1.0, -1, -1]])
    assert lost.state[0] == LEAKED
    gradient = trace_chains_backward(ball, inside, np.ones((1, 3)), np.ones((1, 3)), np.ones(1))
    assert not gradient[0].center.any()


def test_wrong_arguments() -> None:
    with pytest.raises(RangeError, match="eta"):
        SpecularSphere([0, 0, 0], 1.0, 0.0)
    with pytest.raises(RangeError, match=r"vertices: .*finite"):
        SpecularMesh(np.full((3, 3), np.nan), [[0, 1, 2]])
    with pytest.raises(RangeError, match="at least one"):
        SpecularScene([])
    ball = SpecularScene([SpecularSphere([0, 0, 0], 1.0)])
    with pytest.raises(ShapeError, match="directions"):
        trace_chains(ball, np.zeros((2, 3)), np.ones((3, 3)))


@same_bits("specular chains")
def chains_and_gradients() -> list[Any]:
    ends = Ends(chain_scene.place())
    rng = np.random.default_rng(5)
    cotangent = {name: rng.normal(size=v.shape) for name, v in ends.forward(ends.place).items()}
    return [ends.base.direction, *ends.backward(ends.place, cotangent).values()]
