"""A field from one file is registered, fitted, drawn, compared, exported, its gradient drawn.

No file of the package knows it: what the loop and the commands ask, it answers itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
import pytest
from photograd._fit_options import FitOptions
from photograd.commands.gradients import draw_gradients
from photograd.fields import fittable
from photograd.fitting import Fit, fit, load_model, options_for
from photograd.fitting.checks import require_startable
from photograd.fitting.compare import compare_one, parse_candidates
from photograd.fitting.evaluate import display_image, evaluate
from photograd.representation import (
    REGISTERED,
    Fittable,
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Start,
    register,
)
from photograd_course.gradcheck import check_gradient

from tests.fit import scene


@dataclass(frozen=True)
class BallPolicy:
    """Where the balls are."""

    box: tuple[tuple[float, float, float], tuple[float, float, float]]
    side: int


@dataclass
class BallContext:
    """Weights (R, N) of each ball in each ray, and the sum of the densities (R,)."""

    weight: Any
    optical_depth: Any
    color: Any


class Balls(Fittable):
    """Soft balls on a lattice, all seen through each other: color is their mean, by weight."""

    name: ClassVar[str] = "balls"
    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})

    def __init__(self, params: Mapping[str, Any], policy: BallPolicy) -> None:
        self.params, self.policy = dict(params), policy
        low, high = np.array(policy.box)
        self.radius = float((high - low).max()) / policy.side / 2
        axes = [np.linspace(a, b, policy.side + 2)[1:-1] for a, b in zip(low, high, strict=True)]
        self.centers = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)

    @property
    def box(self) -> Any:
        return np.array(self.policy.box)

    @property
    def resolution(self) -> int:
        return self.policy.side

    @classmethod
    def example(cls, *, seed: int, dtype: Any = np.float64) -> Balls:
        g = np.random.default_rng(seed)
        policy = BallPolicy(((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)), 3)
        return cls({"balls": g.normal(size=(27, 4)).astype(dtype)}, policy)

    def example_batch(self, *, seed: int) -> RayBatch:
        towards = np.random.default_rng(seed).normal(size=(20, 3))
        towards /= np.linalg.norm(towards, axis=1, keepdims=True)
        origins = -3 * towards + 0.3 * towards[::-1]
        return RayBatch(origins, towards, np.arange(20, dtype=np.uint32))

    def param_groups(self) -> dict[str, ParamSpec]:
        return {"balls": ParamSpec(self.params["balls"].shape, "1", (-20, 20), 0.3, "none")}

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, BallContext]:
        del seed, step, options
        to = self.centers[None] - batch.origins[:, None]
        along = np.einsum("rnk,rk->rn", to, batch.directions)
        off = np.square(to).sum(-1) - along**2
        reach = np.exp(-0.5 * off / self.radius**2)
        weight = reach * np.exp(self.params["balls"][:, 3])
        depth = weight.sum(axis=1)
        rgb = 1 / (1 + np.exp(-self.params["balls"][:, :3]))
        color = weight @ rgb / np.maximum(depth, 1e-9)[:, None]
        opacity = -np.expm1(-depth)
        context = BallContext(weight, depth, color)
        distance = opacity * (weight * along).sum(1) / np.maximum(depth, 1e-9)
        kind = self.params["balls"].dtype
        outputs = [a.astype(kind) for a in (opacity[:, None] * color, opacity, distance)]
        return Outputs(*outputs), context

    def render_backward(self, context: BallContext, d_outputs: Outputs) -> dict[str, Any]:
        c, raw = context, self.params["balls"]
        rgb = 1 / (1 + np.exp(-raw[:, :3]))
        opacity = -np.expm1(-c.optical_depth)
        d_color = opacity[:, None] * d_outputs.color
        d_opacity = (d_outputs.color * c.color).sum(1)
        if d_outputs.opacity is not None:
            d_opacity = d_opacity + d_outputs.opacity
        depth = np.maximum(c.optical_depth, 1e-9)[:, None]
        d_weight = (d_color @ rgb.T - (d_color * c.color).sum(1, keepdims=True)) / depth
        d_weight += (d_opacity * np.exp(-c.optical_depth))[:, None]
        d_rgb = (c.weight / depth).T @ d_color
        d_density = (d_weight * c.weight).sum(0)
        d = np.concatenate([d_rgb * rgb * (1 - rgb), d_density[:, None]], axis=1)
        return {"balls": d.astype(raw.dtype)}

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        side = start.options.resolution
        low, high = start.bounds.box.tolist()
        raw = np.zeros((side**3, 4), np.float32)
        raw[:, 3] = -3.0
        return cls({"balls": raw}, BallPolicy((tuple(low), tuple(high)), side)), "a lattice"

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Any], dict[str, Any]]:
        return {"balls": (("float32", "float64"), (options.resolution**3, 4))}, {}

    @classmethod
    def restored(cls, params: Any, state: Any, policy: Any, options: FitOptions) -> Self:
        del state, options
        box = tuple(tuple(corner) for corner in policy["box"])
        return cls(params, BallPolicy(box, policy["side"]))


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    register(Balls)
    yield
    del REGISTERED["balls"]


CHANGES: dict[str, Any] = {"resolution": 8, "steps": 60, "rays": 512, "seed": 1}


def test_its_gradient_is_right() -> None:
    field, seen = Balls.example(seed=1), Balls.example(seed=1).example_batch(seed=2)

    def at(params: Any) -> tuple[Outputs, BallContext]:
        field.params = dict(params)
        return field.render(seen, seed=0, step=0, options=RenderOptions())

    report = check_gradient(
        lambda p: {"color": at(p)[0].color, "opacity": at(p)[0].opacity},
        lambda p, d: field.render_backward(at(p)[1], Outputs(d["color"], d["opacity"])),
        dict(field.params),
        seed=1,
    )
    assert report, str(report)


def test_it_is_fitted_resumed_and_drawn(tmp_path: Path) -> None:
    require_startable("balls")
    capture = scene.capture()
    start = Fit.start(capture, options_for("balls", **{**CHANGES, "steps": 1}))
    start.run(tmp_path / "start")
    before = evaluate(load_model(tmp_path / "start"), capture.test).psnr
    model = fit(capture, "balls", folder=tmp_path / "model", **CHANGES)
    assert evaluate(model, capture.test).psnr > before + 3
    job = Fit.start(capture, options_for("balls", **CHANGES))
    job.run(tmp_path / "stopped", should_stop=lambda: job.step_number == 20)
    resumed = fit(capture, folder=tmp_path / "stopped", resume=True)
    assert np.array_equal(resumed.field.params["balls"], model.field.params["balls"])
    assert display_image(model, capture.test[0].camera).std() > 0.05


def test_it_is_compared_and_its_gradient_drawn(tmp_path: Path) -> None:
    capture = scene.capture()
    (candidate,) = parse_candidates("balls:8")
    options = candidate.options(FitOptions(steps=6, rays=128))
    assert (options.representation, options.resolution) == ("balls", 8)
    folder = tmp_path / "balls_8"
    result = compare_one(
        "memory", capture, candidate, folder, options, lambda job, out: job.run(out)
    )
    assert result is not None
    assert result[0].parameter_bytes == 4 * 4 * 8**3
    found = draw_gradients(load_model(folder), folder, capture, tmp_path / "pictures", 256, 1)
    assert found["steps"] == [0, 1, 6]
    assert {path.name for path in (tmp_path / "pictures").glob("*.png")} == {
        "group_gradients.png",
        "curves.png",
    }
    assert found["group_gradients"].stat().st_size > 10_000


def test_it_is_exported(tmp_path: Path) -> None:
    field = Balls.example(seed=3)
    field.export(tmp_path / "balls.npz", np.array([0.1, 0.2, 0.3]))
    with np.load(tmp_path / "balls.npz") as archive:
        assert np.array_equal(archive["balls"], field.params["balls"])
        assert archive["box"].shape == (2, 3)
        assert archive["background"].tolist() == [0.1, 0.2, 0.3]


def test_all_registered_are_fittable_or_teach() -> None:
    for name, kind in REGISTERED.items():
        assert (name in fittable()) != bool(kind.teaching_example)
        if name in fittable() and "rays" not in kind.capabilities:
            assert kind.color_space == "display"
