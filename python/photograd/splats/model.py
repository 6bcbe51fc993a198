"""3D Gaussians as a scene: splatted, differentiated, and changed in number while they are fitted.

What is drawn, and its adjoint, is `splatting`; this file makes a representation of it.
Colors are display values and blend as such, as in the scenes that others exchange [Kerbl2023].

The harmonics are two groups, since the constant one learns twenty times as fast as the others, and
only those up to `active_degree` are drawn: a fit begins with plain colors and adds what depends on
the view later.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
from photograd_course.portable_math import log
from photograd_course.random import normal_vectors
from photograd_course.row_map import RowMap

from photograd import sh
from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._fit_options import FitOptions
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.capture.orbit import orbit_cameras
from photograd.errors import RangeError, message
from photograd.representation import (
    COPIES,
    FitInProgress,
    Fittable,
    ImageBatch,
    Memory,
    Outputs,
    ParamSpec,
    RenderOptions,
    Start,
    register,
)
from photograd.splats.density import DensityControl, Grad2dStatistics, NoControl
from photograd.splats.files import WRITABLE, write_gaussians
from photograd.splats.frames import USUAL_UP, WORLD_UP, Presentation, half_turn
from photograd.splats.orbit import scene_box
from photograd.splats.splatting import (
    Gaussians,
    SplatContext,
    SplatOptions,
    render,
    render_backward,
)
from photograd.splats.start import control_of, scene_extent, start_gaussians
from photograd.types import Array

MEAN_RATE = 1.6e-4
"""Adam's rate of the means, in extents of the scene [Kerbl2023]."""


@dataclass(eq=False)
class GaussianContext:
    """What `render_backward` needs; it leaves dL/d of the projected means in `screen`."""

    splats: SplatContext
    camera: Camera
    camera_adjoint: bool
    screen: Array | None = None  # (N, 2), per pixel


@typed_call
@register
class GaussianScene(Fittable):
    """params: "means" (N, 3) meters, "log_scales" (N, 3), "quats" (N, 4), "opacity_logits" (N,),
    "sh_constant" (N, 1, 3) and "sh_rest" (N, K - 1, 3); see `photograd.splats.splatting.Gaussians`.

    Attributes:
        policy: how splats are drawn.
        control: decides when Gaussians are cloned, split, moved and dropped.
        extent: size of the scene in meters; rates and thresholds are in units of it.
        active_degree: harmonics up to here are drawn.
        grad2d: positional gradient statistics of the pictures since the last refinement.
    """

    name: ClassVar[str] = "gaussians"
    capabilities: ClassVar[frozenset[str]] = frozenset({"image"})
    color_space: ClassVar[str] = "display"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"steps": 4000, "degree": 3}
    fit_options: ClassVar[frozenset[str]] = frozenset({"degree", "gaussians", "density_control"})
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "optional"
    size_option: ClassVar[str] = "gaussians"
    counts: ClassVar[str] = "Gaussians"
    gradient_picture: ClassVar[str] = "gaussians"
    export_suffixes: ClassVar[tuple[str, ...]] = WRITABLE
    exported_as: ClassVar[str] = "gaussians.ply"

    def __init__(
        self,
        gaussians: Gaussians,
        *,
        extent: float,
        policy: SplatOptions | None = None,
        control: DensityControl | None = None,
        active_degree: int | None = None,
    ) -> None:
        """`active_degree` None draws all harmonics.

        Raises RangeError for a bad extent or degree.

        Args:
            gaussians: all of one dtype.
            extent: of the scene, in meters.
            policy: options of the rendering.
            control: of the number of Gaussians; None leaves it.
            active_degree: highest degree of the harmonics that are drawn.
        """
        call = Arguments("GaussianScene")
        call.number("extent", extent, above=0)
        degree = gaussians.degree if active_degree is None else active_degree
        call.integer("active_degree", degree, low=0, high=gaussians.degree)
        self.params = _groups(gaussians)
        self.extent = extent
        self.policy = policy or SplatOptions()
        self.control = control or NoControl()
        self.active_degree = degree
        self.grad2d = Grad2dStatistics.zero(len(gaussians))

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> GaussianScene:
        """Eleven Gaussians of degree 2 about the origin, without cut-offs."""
        rows = np.arange(11)
        spread, turn, look = (
            normal_vectors(seed, step=0, row=rows, sample=sample) for sample in range(3)
        )
        colors = normal_vectors(seed, step=1, row=np.arange(11 * 9)).reshape(11, 9, 3)
        gaussians = Gaussians(
            means=0.25 * spread,
            log_scales=log(0.15) + 0.3 * look,
            quats=np.concatenate([np.full((11, 1), 0.7), turn], axis=1),
            opacity_logits=normal_vectors(seed, step=2, row=rows)[:, 0],
            sh=np.concatenate([0.5 + 0.2 * colors[:, :1], 0.1 * colors[:, 1:]], axis=1),
        )
        policy = SplatOptions(antialiased=True).smooth()
        return cls(gaussians.astype(dtype), extent=1.0, policy=policy)

    def example_batch(self, *, seed: int) -> ImageBatch:
        """A picture of 12 x 10 pixels from two meters away."""
        box = np.array([[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]])
        camera = list(orbit_cameras(box, 5, size=12, elevation=20.0))[seed % 5]
        low = replace(camera, height=10, cy=camera.cy - 1.0)
        pose = invert_rigid(low.world_from_camera)[:3]
        return ImageBatch(low, np.ascontiguousarray(pose))

    @property
    def gaussians(self) -> Gaussians:
        """The parameters as Gaussians, with the harmonics that are drawn."""
        count = sh.count(self.active_degree)
        harmonics = np.concatenate(
            [self.params["sh_constant"], self.params["sh_rest"][:, : count - 1]], axis=1
        )
        plain = ("means", "log_scales", "quats", "opacity_logits")
        return Gaussians(**{name: self.params[name] for name in plain}, sh=harmonics)

    @property
    def resolution(self) -> int:
        """How many Gaussians there are."""
        return len(self.params["means"])

    @property
    def shape(self) -> tuple[int, ...]:
        """(N,)."""
        return (self.resolution,)

    @property
    def box(self) -> Array:
        """(2, 3) corners of what holds 96 % of the means along each axis, padded by 5 %."""
        return scene_box(self.gaussians)

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Six groups with a row a Gaussian; the rates are those of [Kerbl2023]."""
        shape = {name: array.shape for name, array in self.params.items()}
        far = 1e3 * self.extent
        return {
            "means": ParamSpec(shape["means"], "m", (-far, far), MEAN_RATE * self.extent, "world"),
            "log_scales": ParamSpec(shape["log_scales"], "1", (-20.0, 10.0), 0.005, "none"),
            "quats": ParamSpec(shape["quats"], "1", (-10.0, 10.0), 0.001, "world"),
            "opacity_logits": ParamSpec(shape["opacity_logits"], "1", (-20.0, 20.0), 0.05, "none"),
            "sh_constant": ParamSpec(shape["sh_constant"], "1", (-10.0, 10.0), 0.0025, "none"),
            "sh_rest": ParamSpec(shape["sh_rest"], "1", (-10.0, 10.0), 0.0025 / 20, "world"),
        }

    def render(
        self, batch: ImageBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, GaussianContext]:
        """Color (P, 3), opacity (P,) and depth (P,) of all pixels, row by row."""
        del seed, step  # nothing random here
        policy = replace(self.policy, stop=options.stop)
        picture, context = render(
            self.gaussians, batch.camera, options=policy, camera_from_world=batch.camera_from_world
        )
        outputs = Outputs(
            picture.color.reshape(-1, 3), picture.opacity.ravel(), picture.depth.ravel()
        )
        return outputs, GaussianContext(context, batch.camera, options.camera_adjoint)

    def render_backward(self, context: GaussianContext, d_outputs: Outputs) -> dict[str, Array]:
        """dL/d params, and "camera_from_world" (3, 4) if the options asked."""
        picture = context.splats.picture
        given = (d_outputs.color, d_outputs.opacity, d_outputs.depth)
        wanted = (picture.color, picture.opacity, picture.depth)
        d_color, d_opacity, d_depth = (
            None if d is None else np.ascontiguousarray(d, like.dtype).reshape(like.shape)
            for d, like in zip(given, wanted, strict=True)
        )
        found = render_backward(context.splats, d_color, d_opacity, d_depth)
        context.screen = found.screen
        gradients: dict[str, Array] = {**found.gaussians}
        harmonics = gradients.pop("sh")
        gradients["sh_constant"] = np.ascontiguousarray(harmonics[:, :1])
        rest = np.zeros_like(self.params["sh_rest"])
        rest[:, : harmonics.shape[1] - 1] = harmonics[:, 1:]
        gradients["sh_rest"] = rest
        if context.camera_adjoint:
            gradients["camera_from_world"] = found.camera_from_world
        return gradients

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Round Gaussians of constant colors: at `start.points`, the capture's points or random."""
        options, box = start.options, start.bounds.box
        control = control_of(options)
        count = max(1, int(control.first_share * options.gaussians))
        gaussians, rule = start_gaussians(
            start.capture,
            box,
            count,
            degree=options.degree,
            seed=options.seed,
            given=start.points(count) if start.points else None,
        )
        extent = scene_extent(start.capture, box)
        scene = cls(gaussians, extent=extent, control=control, active_degree=0)
        return scene, f"Gaussians: {rule}"

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> Sequence[Memory]:
        """Of position, scales, rotation, opacity and the harmonics of three colors."""
        del box
        each = COPIES * 4 * (3 + 3 + 4 + 1 + 3 * sh.count(options.degree))
        what = f"{options.gaussians:,} Gaussians"
        remedy = f"--gaussians {max(1, available // (2 * each))} takes half of it"
        return (Memory("gaussians", what, each * options.gaussians, remedy),)

    def learning_rates(self, options: FitOptions, step: int) -> dict[str, float]:
        """Those of the means fall to another fraction: they must come to rest."""
        resting = replace(options, final_rate=options.final_mean_rate)
        means = super().learning_rates(resting, step)["means"]
        return super().learning_rates(options, step) | {"means": means}

    def adapted(self, fit: FitInProgress) -> Self:
        """Higher harmonics are drawn, and the density control decides, before a step."""
        self.active_degree = fit.options.active_degree(fit.step_number)
        rows = self.refine(fit.step_number, {})
        if rows is not None:
            fit.optimizer.apply_row_map(rows, self.params)
        return self

    def observe(self, context: GaussianContext, gradients: dict[str, Array]) -> None:
        """Add the picture behind `context` to grad2d, and the density control's priors."""
        if context.screen is not None:
            self.grad2d.add(context.screen, context.splats.visible, context.camera)
        self.control.add_priors(self.params, gradients, extent=self.extent)

    def after_step(self, rates: Mapping[str, float], step: int) -> None:
        """The density control's random motion."""
        self.control.explore(self.params, extent=self.extent, rate=rates["means"], step=step)

    def stored(self) -> dict[str, Array]:
        """The parameters; the state serves the fit alone."""
        return dict(self.params)

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """Write a file of Gaussians, half a turn about x away from the world: -y is up there."""
        told = Presentation.of_fit(USUAL_UP, background, antialiased=self.policy.antialiased)
        write_gaussians(path, half_turn(self.gaussians), presentation=told)
        kept = "" if background is None else "; the learned background is in its header"
        kept = kept if path.suffix.lower() == ".ply" else ""
        return (f"{USUAL_UP} is up, as other programs expect, {WORLD_UP} in the model{kept}",)

    def refine(self, step: int, statistics: Mapping[str, Array]) -> RowMap | None:
        """What the density control decides before this step.

        `statistics` is not looked at: a scene gathers its own, see `observe`.
        """
        del statistics
        change = self.control.change(self.params, self.grad2d, extent=self.extent, step=step)
        if change is None:
            return None
        self.params = change.params
        self.grad2d = Grad2dStatistics.zero(self.resolution)
        return change.row_map

    def state(self) -> dict[str, Array]:
        """Active degree, extent, and the statistics since the last refinement."""
        return {
            "active_degree": np.array(self.active_degree, np.int64),
            "extent": np.array(self.extent, np.float64),
            "grad2d_sum": self.grad2d.total,
            "grad2d_count": self.grad2d.count,
        }

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """A row a Gaussian, in the parameters and in the statistics."""
        rows: dict[str, Row] = {
            "means": (FLOAT, ("N", 3)),
            "log_scales": (FLOAT, ("N", 3)),
            "quats": (FLOAT, ("N", 4)),
            "opacity_logits": (FLOAT, ("N",)),
            "sh_constant": (FLOAT, ("N", 1, 3)),
            "sh_rest": (FLOAT, ("N", sh.count(options.degree) - 1, 3)),
        }
        return rows, {
            "active_degree": (("int64",), ()),
            "extent": (("float64",), ()),
            "grad2d_sum": (("float64",), ("N",)),
            "grad2d_count": (("int64",), ("N",)),
        }

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The scene of a checkpoint."""
        plain = {name: params[name] for name in ("means", "log_scales", "quats", "opacity_logits")}
        harmonics = np.concatenate([params["sh_constant"], params["sh_rest"]], axis=1)
        scene = cls(
            Gaussians(**plain, sh=harmonics),
            extent=float(state["extent"]),
            policy=from_plain("checkpoint", SplatOptions, policy),
            control=control_of(options),
            active_degree=int(state["active_degree"]),
        )
        scene.load_state(state)
        return scene

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Raises RangeError unless `state` is one that `state()` of as many Gaussians returned."""
        if set(state) != set(self.state()):
            expected = f"{sorted(self.state())}"
            raise RangeError(
                message("GaussianScene.load_state", "state", expected, f"{sorted(state)}")
            )
        self.grad2d = Grad2dStatistics(
            state["grad2d_sum"].copy(), state["grad2d_count"].copy()
        ).checked(self.resolution)
        self.active_degree = int(state["active_degree"])
        self.extent = float(state["extent"])


def _groups(gaussians: Gaussians) -> dict[str, Array]:
    """Arrays of our own, the harmonics split."""
    arrays = {name: array.copy() for name, array in gaussians.arrays().items()}
    harmonics = arrays.pop("sh")
    arrays["sh_constant"] = np.ascontiguousarray(harmonics[:, :1])
    arrays["sh_rest"] = np.ascontiguousarray(harmonics[:, 1:])
    return arrays
