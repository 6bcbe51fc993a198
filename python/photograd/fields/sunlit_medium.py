"""Fog in the sun: single scattering in a medium, with shadows and their shafts of light.

Light of the sun crosses the medium to a point x, is scattered there once, and crosses the rest of
it to the camera [Max1995]:

    L = integral of T(t) sigma_t(x) albedo p(<ray, sun>) E S(x) dt      x = o + t ray
    S = V exp(-integral of sigma_t from x towards the sun)              what of the sun reaches x

E is the sun's irradiance on a surface that faces it, V whether solids let x see it. Albedo, p and E
are the same along a ray, so one march with S as its color gives the integral. S itself is a march
as well: from the middle of every voxel towards the sun, of which the transmittance is kept. Between
voxels S is blended like sigma_t. The adjoint goes back through both:

    s_r     = march of (S, sigma_t)                        a number a ray
    L_r     = albedo E p_r s_r
    d_s_r   = <d_L_r, albedo E> p_r                         d_p_r = <d_L_r, albedo E> s_r
    d_albedo = E sum_r p_r s_r d_L_r                        d_E = albedo sum_r p_r s_r d_L_r
    d_S, d_sigma_t from the first march's adjoint;          d_T = V d_S
    d_sigma_t += the second march's adjoint of d_T

Held fixed: V, whose edges no derivative here moves, and where a ray meets a solid. Shadows are as
sharp as voxels are small, and blend across walls that are thinner than one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from photograd_course.portable_math import norm

from photograd._arrays import Arguments
from photograd.bsdf.phase import registry as phase_functions
from photograd.errors import RangeError, message
from photograd.fields.march import MarchContext, MarchPolicy, march, march_backward
from photograd.geometry.mesh import Bvh
from photograd.representation import (
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Representation,
    register,
)
from photograd.types import Array


def voxel_centers(box: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """(X, Y, Z, 3) middles of the equal voxels that fill a box (2, 3).

    Args:
        box: (2, 3) in meters.
        shape: (X, Y, Z).
    """
    corners = np.asarray(box, np.float64)
    axes = [
        lo + (np.arange(n) + 0.5) * (hi - lo) / n
        for n, lo, hi in zip(shape, *corners.tolist(), strict=True)
    ]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def sun_visibility(
    solids: Bvh, box: ArrayLike, shape: tuple[int, ...], sun: ArrayLike, *, samples: int = 2
) -> NDArray[np.float64]:
    """(X, Y, Z) share of samples^3 points of each voxel from which the sun is visible.

    Args:
        solids: what throws shadows.
        box: (2, 3) of the world, meters.
        shape: (X, Y, Z).
        sun: (3,) unit, towards the sun.
        samples: points a side, spread evenly; more of them make edges softer, not sharper.

    Raises:
        RangeError: samples below 1.
    """
    Arguments("sun_visibility").integer("samples", samples, low=1)
    fine = tuple(int(n) * samples for n in shape)
    origins = voxel_centers(box, fine).reshape(-1, 3)
    towards = np.ascontiguousarray(np.broadcast_to(np.asarray(sun, np.float64), origins.shape))
    visible = ~solids.occluded(origins, towards)
    x, y, z = shape
    cells = visible.reshape(x, samples, y, samples, z, samples)
    return np.asarray(cells.mean(axis=(1, 3, 5)))


# Fog in the sun: single scattering in a medium, with shadows and their shafts of light.


@dataclass(frozen=True)
class SunlitContext:
    """What the backward pass needs."""

    params: dict[str, Array]
    view: MarchContext  # from the camera
    shadow: MarchContext  # from the voxels towards the sun
    cos_theta: Array  # (R,)
    p: Array  # (R,) of the phase function
    s: Array  # (R,) sunlight that scatters into each ray, for albedo E p = 1


@register
class SunlitMedium(Representation):
    """A medium of uniform color and varying thickness, lit by a sun at infinity.

    Attributes:
        params: "sigma_t" (X, Y, Z) extinction at voxel centers, 1/m, values below zero count as
            none; "albedo" (3,) the share of it that scatters; "g" (1,) of the phase function;
            "irradiance" (3,) of the sun on a surface that faces it, W/m^2.
        visibility: (X, Y, Z) how much of each voxel sees the sun past the solids, 0 to 1.
        sun: (3,) unit, towards the sun, in the world.
    """

    name: ClassVar[str] = "sunlit_medium"
    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    teaching_example: ClassVar[str] = "start it from Python, with parameters of your own"

    def __init__(
        self,
        params: Mapping[str, Array],
        box: ArrayLike,
        dt: float,
        *,
        sun: ArrayLike,
        phase: str = "henyey_greenstein",
        visibility: Array | None = None,
        solids: Bvh | None = None,
    ) -> None:
        """A medium in a box of the world.

        Args:
            params: as described for the class, all float32 or all float64.
            box: (2, 3), meters; beyond it there is no medium.
            dt: step of both marches, meters; half a voxel or less.
            sun: (3,) direction towards the sun, of any length.
            phase: of photograd.bsdf.phase.registry.
            visibility: by default what the solids leave of it, `sun_visibility`; 1 without any.
            solids: rays end where they meet them.

        Raises:
            ShapeError, DtypeError: parameters of other shapes or types.
            RangeError: an unknown phase function; a box, step or direction without extent.
        """
        self.params = _checked(params)
        call = Arguments("SunlitMedium", np.float64)
        corners, towards = call.box("box", box), call.array("sun", sun, (3,))
        length = norm(towards)
        if not 0 < length < np.inf:
            raise RangeError(message("SunlitMedium", "sun", "a direction", towards.tolist()))
        self.sun = towards / length
        self.phase = phase_functions()[phase]
        self.solids = solids
        self.policy = MarchPolicy(
            (tuple(corners[0].tolist()), tuple(corners[1].tolist())),
            dt,
            density_activation="relu",
            color_activation="identity",
        )
        shape = self.params["sigma_t"].shape
        if visibility is None and solids is not None:
            visibility = sun_visibility(solids, corners, shape, self.sun)
        if visibility is None:
            visibility = np.ones(shape)
        self.visibility = call.array("visibility", visibility, shape, finite=False)

    @classmethod
    def homogeneous(
        cls,
        sigma_t: float,
        shape: tuple[int, int, int],
        box: ArrayLike,
        dt: float,
        *,
        albedo: ArrayLike = (1.0, 1.0, 1.0),
        g: float = 0.0,
        irradiance: ArrayLike = (1.0, 1.0, 1.0),
        dtype: type[np.floating[Any]] = np.float32,
        **more: Any,
    ) -> SunlitMedium:
        """The same extinction everywhere; `more` goes to the constructor.

        Voxels are needed nevertheless: the light in the medium is not the same everywhere.

        Args:
            sigma_t: extinction in 1/m.
            shape: (X, Y, Z) voxels.
            box: (2, 3) in meters.
            dt: distance of samples along a ray in meters.
            albedo: (3,) of scattering.
            g: asymmetry of the phase function.
            irradiance: (3,) of the sun.
            dtype: np.float32 or np.float64.
            more: arguments of the constructor.
        """
        params = {
            "sigma_t": np.full(shape, sigma_t, dtype),
            "albedo": np.asarray(albedo, dtype),
            "g": np.full(1, g, dtype),
            "irradiance": np.asarray(irradiance, dtype),
        }
        return cls(params, box, dt, **more)

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> SunlitMedium:
        """A lively cloud of 4 x 3 x 5 voxels under a slanting sun, partly in shadow."""
        random = np.random.default_rng(seed)
        shape = (4, 3, 5)
        params = {
            "sigma_t": random.uniform(0.3, 2.0, shape),
            "albedo": random.uniform(0.3, 0.9, 3),
            "g": random.uniform(0.2, 0.6, 1),
            "irradiance": random.uniform(1.0, 4.0, 3),
        }
        return cls(
            {name: value.astype(dtype) for name, value in params.items()},
            [[-1.0, -1.0, -1.0], [1.0, 0.5, 1.5]],
            0.1,
            sun=(0.5, 0.8, -0.3),
            visibility=random.uniform(0.2, 1.0, shape),
        )

    def example_batch(self, *, seed: int) -> RayBatch:
        """Rays from around the box to points within."""
        random = np.random.default_rng(seed + 100)
        box = np.array(self.policy.box)
        origins = box.mean(axis=0) + 3.0 * _unit(random.normal(size=(12, 3)))
        inside = box[0] + random.uniform(0.25, 0.75, (12, 3)) * (box[1] - box[0])
        return RayBatch(origins, _unit(inside - origins), np.arange(12, dtype=np.uint32))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Four groups; only sigma_t lies in the world."""
        shape = self.params["sigma_t"].shape
        (g,) = self.phase.parameters
        return {
            "sigma_t": ParamSpec(shape, "1/m", (0.0, 1e4), 0.1, "grid"),
            "albedo": ParamSpec((3,), "1", (0.0, 1.0), 0.01, "none"),
            "g": ParamSpec((1,), "1", (g.lo, g.hi), 0.01, "none"),
            "irradiance": ParamSpec((3,), "W/m^2", (0.0, 1e5), 0.05, "none"),
        }

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, SunlitContext]:
        """Scattered radiance (R, 3), opacity (R,) and depth (R,) as the marcher weighs it.

        Raises Error and RangeError as `photograd.fields.march.march`.
        """
        light, shadow = self.light()
        values = self._values(light)
        outputs, view = march(
            "dense_grid",
            values,
            self.policy,
            batch,
            options,
            seed=seed,
            step=step,
            t_max=self._ends(batch),
        )
        cos_theta = np.einsum("rk,k->r", view.directions, self.sun.astype(values.dtype))
        p, s = self.phase.p(self.params["g"], cos_theta), outputs.color[:, 0]
        color = (p * s)[:, None] * (self.params["albedo"] * self.params["irradiance"])
        context = SunlitContext(dict(self.params), view, shadow, cos_theta, p, s)
        found = Outputs(color, outputs.opacity, outputs.depth)
        return found.checked("SunlitMedium.render", batch), context

    def render_backward(self, context: SunlitContext, d_outputs: Outputs) -> dict[str, Array]:
        """A gradient for each group, and "origins", "directions" (R, 3) if the options asked."""
        c, params = context, context.params
        along = np.einsum("rc,c->r", d_outputs.color, params["albedo"] * params["irradiance"])
        d_phase, d_cos = self.phase.p_backward(params["g"], c.cos_theta, along * c.s)
        d_color = np.zeros((len(along), 3), along.dtype)
        d_color[:, 0] = along * c.p
        view = march_backward(c.view, Outputs(d_color, d_outputs.opacity, d_outputs.depth))
        d_values = view.pop("parameters")
        d_through = self.visibility.astype(d_values.dtype) * d_values[..., 0]
        d_product = np.einsum("r,rc->c", c.p * c.s, d_outputs.color)
        gradients = {
            "sigma_t": d_values[..., 3] + self._shadow_backward(c.shadow, d_through),
            "albedo": d_product * params["irradiance"],
            "g": np.atleast_1d(d_phase["g"]),
            "irradiance": d_product * params["albedo"],
            **view,
        }
        if "directions" in gradients:
            gradients["directions"] += d_cos[:, None] * self.sun.astype(d_cos.dtype)
        return gradients

    def light(self) -> tuple[Array, MarchContext]:
        """S (X, Y, Z), the share of the sun's light that reaches each voxel, and its march.

        Where a lattice ends, up to half a step is missing or too much. Each voxel's is moved by
        another fraction of a step, always the same one, so that this cancels out between voxels.
        """
        shape = self.params["sigma_t"].shape
        origins = voxel_centers(self.policy.box, shape).reshape(-1, 3)
        towards = np.broadcast_to(self.sun, origins.shape)
        batch = RayBatch(origins, towards, np.arange(len(origins), dtype=np.uint32))
        _, context = march(
            "dense_grid",
            self._values(None),
            self.policy,
            batch,
            RenderOptions(jitter=True),
            seed=0,
            step=0,
        )
        through = context.transmittance.reshape(shape)
        return through * self.visibility.astype(through.dtype), context

    def _shadow_backward(self, context: MarchContext, d_through: Array) -> Array:
        """dL/dsigma_t (X, Y, Z) of dL/dtransmittance (X, Y, Z) towards the sun."""
        rays = d_through.reshape(-1)
        nothing = np.zeros((len(rays), 3), rays.dtype)
        opacity = Outputs(nothing, -rays, None)  # opacity is 1 - transmittance
        return march_backward(context, opacity)["parameters"][..., 3]

    def _values(self, light: Array | None) -> Array:
        """(X, Y, Z, 4) of a dense grid: light, nothing, nothing, sigma_t."""
        sigma_t = self.params["sigma_t"]
        values = np.zeros((*sigma_t.shape, 4), sigma_t.dtype)
        values[..., 3] = sigma_t
        if light is not None:
            values[..., 0] = light
        return values

    def _ends(self, batch: RayBatch) -> Array | None:
        """(R,) where rays meet a solid, infinity where they do not."""
        if self.solids is None:
            return None
        dtype = self.params["sigma_t"].dtype
        return self.solids.trace(batch.origins.astype(dtype), batch.directions.astype(dtype)).t


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _checked(params: Mapping[str, Array]) -> dict[str, Array]:
    """Contiguous arrays of the right shapes and of one type."""
    expected: dict[str, tuple[int | str, ...]] = {
        "sigma_t": ("X", "Y", "Z"),
        "albedo": (3,),
        "g": (1,),
        "irradiance": (3,),
    }
    if set(params) != set(expected):
        got = sorted(params)
        raise RangeError(message("SunlitMedium", "params", f"exactly {sorted(expected)}", got))
    call = Arguments("SunlitMedium")
    return {
        name: call.array(name, params[name], shape, finite=False, min_length=2)
        for name, shape in expected.items()
    }
