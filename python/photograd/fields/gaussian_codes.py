"""Gaussians with codes, started from a scene of Gaussians that was fitted before.

The mathematics is in photograd.fields.coded_splats.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
from photograd_course.metrics import psnr
from photograd_course.random import normal_vectors, uniform

from photograd import sh
from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._fit_options import FitOptions
from photograd.capture.orbit import orbit_cameras
from photograd.errors import RangeError, message
from photograd.fields.coded_splats import (
    GEOMETRY,
    CodedSplatsContext,
    CodedSplatsPolicy,
    geometry,
    render_codes,
    render_codes_backward,
    triples,
)
from photograd.fields.decoded_march import harmonics
from photograd.fields.tabulate import directions_around
from photograd.representation import (
    Fittable,
    ImageBatch,
    Outputs,
    ParamSpec,
    RenderOptions,
    Start,
    register,
)
from photograd.splats.files import WRITABLE
from photograd.splats.model import GaussianScene
from photograd.splats.orbit import scene_box
from photograd.splats.splatting import Gaussians
from photograd.types import Array

BAKED_DEGREE = 3
VIEWS, EDGE = 4, 128
"""Pictures in which a bake is compared with what it is baked from, and pixels along their edges."""


@register
class GaussianCodes(Fittable):
    """Gaussians of a scene that was fitted before, with a code each and a shared decoder.

    params: "means" (N, 3) meters, "log_scales" (N, 3), "quats" (N, 4), "opacity_logits" (N,),
    "colors" (N, 3) and "codes" (N, F), coefficients of Y_0, and "decoder" (P,) flat as in
    `Perceptron`. The number of Gaussians stays.

    Attributes:
        policy: how splats are drawn, and sizes.
        extent: size of the scene in meters; the rate of the means is in units of it.
    """

    name: ClassVar[str] = "gaussian_codes"
    capabilities: ClassVar[frozenset[str]] = frozenset({"image"})
    color_space: ClassVar[str] = "display"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"steps": 2000}
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "required"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("gaussians",)
    first_model_help: ClassVar[str] = "fit gaussians first, and start from them (--start-from)"
    keeps_background: ClassVar[bool] = True
    size_option: ClassVar[str] = "gaussians"
    counts: ClassVar[str] = "Gaussians"
    export_suffixes: ClassVar[tuple[str, ...]] = WRITABLE
    exported_as: ClassVar[str] = "gaussians.ply"
    policy: CodedSplatsPolicy

    def __init__(
        self, params: Mapping[str, Array], *, extent: float, policy: CodedSplatsPolicy
    ) -> None:
        """Raises ShapeError, DtypeError or RangeError for arrays that do not fit.

        Args:
            params: all groups, of one dtype.
            extent: of the scene, in meters.
            policy: options of the rendering, and sizes.
        """
        call = Arguments("GaussianCodes")
        call.number("extent", extent, above=0)
        means = call.array("means", params.get("means"), ("N", 3), finite=False)
        rows = len(means)
        shapes: dict[str, tuple[int, ...]] = {
            "means": (rows, 3),
            "log_scales": (rows, 3),
            "quats": (rows, 4),
            "opacity_logits": (rows,),
            "colors": (rows, 3),
            "codes": (rows, policy.features),
            "decoder": (policy.decoder().count,),
        }
        self.params = {
            name: call.array(name, params.get(name), shape, finite=False)
            for name, shape in shapes.items()
        }
        self.extent, self.policy = extent, policy

    @classmethod
    def from_gaussians(cls, scene: GaussianScene, *, seed: int = 0, **sizes: Any) -> Self:
        """The Gaussians of a scene with their constant colors; codes and decoder are random.

        Args:
            scene: that was fitted.
            seed: of codes and decoder.
            sizes: "features", "width", "depth" and "hidden" of `CodedSplatsPolicy`.
        """
        policy = CodedSplatsPolicy(**asdict(scene.policy), **sizes)
        groups, kind = scene.params, scene.params["means"].dtype
        count, decoder = len(groups["means"]), policy.decoder()
        index = np.arange(count * policy.features)
        u = uniform(seed, step=0, pixel=index, sample=0, dimension=0)
        params = {name: groups[name].copy() for name in GEOMETRY}
        params["colors"] = groups["sh_constant"][:, 0].copy()
        params["codes"] = (2 * u - 1).reshape(count, -1).astype(kind)
        params["decoder"] = decoder.initial(seed=seed + 1, dtype=kind)
        decoder.layers(params["decoder"])[-1][0][:] = 0
        return cls(params, extent=scene.extent, policy=policy)

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Random codes at Gaussians that were fitted before.

        Raises RangeError for another field.
        """
        field, options = start.field, start.options
        if not isinstance(field, GaussianScene):
            expected = f"a model of {' or '.join(cls.first_model_kinds)}"
            got = "none" if field is None else repr(field.name)
            raise RangeError(message("Fit.start", "start_from", expected, got))
        found = cls.from_gaussians(field, seed=options.seed)
        features = found.policy.features
        return found, f"{found.resolution:,} Gaussians with {features} numbers, decoded per pixel"

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int:
        """From the start: which Gaussians there are is decided by another fit."""
        del options
        return 0

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """A row a Gaussian, with codes of any length, and a decoder of any size."""
        del options
        params: dict[str, Row] = {
            "means": (FLOAT, ("N", 3)),
            "log_scales": (FLOAT, ("N", 3)),
            "quats": (FLOAT, ("N", 4)),
            "opacity_logits": (FLOAT, ("N",)),
            "colors": (FLOAT, ("N", 3)),
            "codes": (FLOAT, ("N", "F")),
            "decoder": (FLOAT, ("P",)),
        }
        return params, {"extent": (("float64",), ())}

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The scene of a checkpoint."""
        del options
        told = from_plain("checkpoint", CodedSplatsPolicy, policy)
        return cls(params, extent=float(state["extent"]), policy=told)

    def state(self) -> dict[str, Array]:
        """The extent."""
        return {"extent": np.array(self.extent, np.float64)}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Take what `state` returned; raises RangeError for anything else."""
        if set(state) != {"extent"}:
            got = f"{sorted(state)}"
            raise RangeError(message("GaussianCodes.load_state", "state", "extent alone", got))
        self.extent = float(state["extent"])

    @property
    def resolution(self) -> int:
        """How many Gaussians there are."""
        return len(self.params["means"])

    @property
    def shape(self) -> tuple[int, ...]:
        """(N, F)."""
        return self.params["codes"].shape

    @property
    def box(self) -> Array:
        """(2, 3) corners of what holds 96 % of the means along each axis, padded by 5 %."""
        return scene_box(Gaussians(**geometry(self.params), sh=triples(self.params)[0]))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Geometry with the rates and ranges of Gaussians; colors, codes and the decoder."""
        drawn = Gaussians(**geometry(self.params), sh=triples(self.params)[0])
        of_scene = GaussianScene(drawn, extent=self.extent).param_groups()
        shape = {name: array.shape for name, array in self.params.items()}
        return {
            **{name: of_scene[name] for name in GEOMETRY},
            "colors": replace(of_scene["sh_constant"], shape=shape["colors"]),
            "codes": ParamSpec(shape["codes"], "1", (-1e3, 1e3), 0.01, "none"),
            "decoder": ParamSpec(shape["decoder"], "1", (-1e4, 1e4), 2e-3, "none"),
        }

    def learning_rates(self, options: FitOptions, step: int) -> dict[str, float]:
        """Those of the means fall to another fraction: they must come to rest."""
        resting = replace(options, final_rate=options.final_mean_rate)
        means = super().learning_rates(resting, step)["means"]
        return super().learning_rates(options, step) | {"means": means}

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """The Gaussians of their example, with codes; smooth, without cut-offs."""
        scene = GaussianScene.example(seed=seed, dtype=dtype)
        found = cls.from_gaussians(scene, seed=seed, width=8, depth=1, hidden="softplus")
        rows = normal_vectors(seed, step=3, row=np.arange(found.resolution))
        found.params["codes"][:] = (0.6 * rows).astype(dtype)
        index = np.arange(found.params["decoder"].size)
        u = uniform(seed, step=4, pixel=index, sample=0, dimension=0)
        found.params["decoder"] += (0.4 * (2 * u - 1)).astype(dtype)
        return found

    def example_batch(self, *, seed: int) -> ImageBatch:
        """As that of Gaussians."""
        return GaussianScene.example(seed=1).example_batch(seed=seed)

    def render(
        self, batch: ImageBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, CodedSplatsContext]:
        """Color (P, 3), opacity (P,) and depth (P,) of all pixels, row by row."""
        del seed, step  # nothing random here
        return render_codes(dict(self.params), self.policy, batch, options)

    def render_backward(self, context: CodedSplatsContext, d_outputs: Outputs) -> dict[str, Array]:
        """dL/d params, and "camera_from_world" (3, 4) if the options asked."""
        return render_codes_backward(context, d_outputs)

    def baked(self, *, degree: int = BAKED_DEGREE) -> GaussianScene:
        """Gaussians of harmonics: what the decoder adds to each one by itself, projected.

        A pixel of several Gaussians has the decoder's value at the mean of their codes, not the
        mean of its values: that, and what varies faster over directions than the harmonics, is
        lost.

        Args:
            degree: of the harmonics, 0 to 3.
        """
        decoder, kind = self.policy.decoder(), self.params["means"].dtype
        codes = np.maximum(0, 0.5 + sh.Y_0 * self.params["codes"]).astype(kind)
        colors = np.maximum(0, 0.5 + sh.Y_0 * self.params["colors"].astype(np.float64))
        directions, around = directions_around()
        dual = sh.basis(directions, degree) * around[:, None]
        coefficients = np.zeros((len(codes), sh.count(degree), 3))
        for direction, weights in zip(harmonics(directions.astype(kind)), dual, strict=True):
            basis = np.broadcast_to(direction, (len(codes), len(direction)))
            given = np.ascontiguousarray(np.concatenate([codes, basis], axis=1))
            value = colors + decoder.forward(self.params["decoder"], given) - 0.5
            coefficients += weights[:, None] * value[:, None]
        drawn = Gaussians(**geometry(self.params), sh=coefficients.astype(kind))
        return GaussianScene(drawn, extent=self.extent, policy=self.policy.of_splats())

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """As the Gaussians that `baked` returns; no network is needed to read them."""
        baked = self.baked()
        close = _agreement(self, baked)
        return (
            *baked.export(path, background),
            f"colors are baked to harmonics of degree {BAKED_DEGREE}, {close:.1f} dB from the "
            f"decoded ones in {VIEWS} views",
        )


def _agreement(one: GaussianCodes, other: GaussianScene) -> float:
    """PSNR in dB of colors from `VIEWS` cameras around the scene."""
    colors: list[list[Array]] = [[], []]
    for camera in orbit_cameras(one.box, VIEWS, size=EDGE, elevation=25.0):
        for field, found in zip((one, other), colors, strict=True):
            drawn: Any = field
            options = RenderOptions(stop=1e-4)
            picture = drawn.render(ImageBatch(camera), seed=0, step=0, options=options)[0]
            found.append(np.clip(picture.color.astype(np.float64), 0, 1).reshape(EDGE, EDGE, 3))
    return psnr(np.concatenate(colors[0]), np.concatenate(colors[1]))
