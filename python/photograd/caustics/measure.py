"""Light through lenses onto a receiver: forward passes, and what is measured of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from photograd._typed import typed_call
from photograd.caustics.chains import Chains, SpecularScene, trace_chains
from photograd.caustics.lens import Lens
from photograd.caustics.light import Light, Rays, check_light, rays_through
from photograd.caustics.receiver import Landing, land, splat
from photograd.transport.particles import IrradianceSensor
from photograd.types import FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class Caustic:
    """Light that lenses send to a receiver.

    Attributes:
        irradiance: (H, W) W/m^2.
        emitted: W of light onto the front of the first lens.
        transmitted: W that leave the last lens.
        received: W on the receiver.
        trapped: share of the emitted power that meets total reflection.
    """

    irradiance: FloatArray
    emitted: float
    transmitted: float
    received: float
    trapped: float


@dataclass(frozen=True, eq=False)
class Traced:
    """One forward pass."""

    scene: SpecularScene
    rays: Rays
    chains: Chains
    landing: Landing
    power: FloatArray  # (R,) behind all lenses
    cells: FloatArray  # (H, W) on the receiver


@typed_call
def measure(
    lenses: Sequence[Lens], light: Light, receiver: IrradianceSensor, *, seed: int, rays: int = 8
) -> Caustic:
    """The light on a receiver behind lenses, refracted at each surface, without reflections.

    Args:
        lenses: in any order; light enters through the front of the first.
        light: a directional or a point light; only what falls onto that front counts.
        receiver: whose front is lit.
        seed: of the places of rays.
        rays: along each axis for each cell of the receiver.

    Raises:
        DtypeError, RangeError: a light that does not light the front.
    """
    check_light("measure", light, lenses[0])
    found = trace_lenses(lenses, light, receiver, rays, seed, 0)
    emitted = float(found.rays.power.sum())
    trapped = float(found.rays.power[found.chains.state != 0].sum()) / emitted
    transmitted, received = float(found.power.sum()), float(found.cells.sum())
    return Caustic(found.cells / receiver.cell_area, emitted, transmitted, received, trapped)


def trace_lenses(
    lenses: Sequence[Lens],
    light: Light,
    receiver: IrradianceSensor,
    count: int,
    seed: int,
    step: int,
) -> Traced:
    """Light through lenses, by the rays of one step.

    Args:
        lenses, light, receiver, seed: as of `measure`.
        count: rays along each axis for each cell.
        step: which random places.
    """
    cells = (count * receiver.width, count * receiver.height)
    rays = rays_through(lenses[0], light, cells, seed=seed, step=step)
    scene = SpecularScene([surface for lens in lenses for surface in lens.surfaces()])
    chains = trace_chains(scene, rays.origin, rays.direction)
    landing = land(receiver, chains.origin, chains.direction)
    power = rays.power * chains.factor
    return Traced(scene, rays, chains, landing, power, splat(receiver, landing, power))


def correlation(a: FloatArray, b: FloatArray) -> float:
    """Pearson's, of two pictures; 0 where one is constant.

    Args:
        a, b: arrays of one shape.
    """
    a, b = a - a.mean(), b - b.mean()
    scale = float(np.sqrt(np.square(a).sum() * np.square(b).sum()))
    return float((a * b).sum()) / scale if scale > 0 else 0.0
