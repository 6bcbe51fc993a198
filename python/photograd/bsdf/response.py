"""What a reflectance model does with light: how much it returns, and what its parameters change."""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd.bsdf.models import BsdfModel
from photograd.types import Array

_EVEN = (0.7548776662466927, 0.5698402909980532)  # 1/x and 1/x^2 of x^3 = x + 1: multiples fill


def furnace_curve(
    model: BsdfModel, parameters: dict[str, Any], cosines: Array, *, samples: int = 1024
) -> Array:
    """The part of the light that leaves, for views of these cosines: a ball in a white room.

    Estimated with the model's own samples, as the mean of f cos / pdf; what is refracted counts by
    power, which is radiance over the squared index.

    Args:
        model: of the registry.
        parameters: one row of values.
        cosines: (C,), of the angles between view and normal, above 0.
        samples: for each cosine, spread evenly.

    Returns:
        (C, 3), one channel each.
    """
    u2 = np.mod(0.5 + np.arange(samples)[:, None] * np.array(_EVEN), 1.0)
    inside = model.index_inside(parameters)
    found = []
    for cosine in np.asarray(cosines, np.float64):
        wo = np.tile([np.sqrt(1.0 - cosine**2), 0.0, cosine], (samples, 1))
        wi = model.sample(parameters, wo, u2)
        pdf = model.pdf(parameters, wo, wi)[:, None]
        power = np.abs(wi[:, 2:]) * np.where(wi[:, 2:] < 0.0, inside**2, 1.0)
        weight = np.where(pdf > 0, power / np.where(pdf > 0, pdf, 1.0), 0.0)
        found.append((model.f(parameters, wo, wi) * weight).mean(axis=0))
    return np.array(found)


def derivatives(
    model: BsdfModel, parameters: dict[str, Any], wo: Array, wi: Array
) -> dict[str, Array]:
    """How the mean of the channels of f changes with each parameter, (N,) for N pairs.

    All three channels of a colour change together.
    """
    rows = {
        name: np.broadcast_to(value, (len(wo), *np.shape(value)))
        for name, value in parameters.items()
    }
    slopes = model.f_backward(rows, wo, wi, np.full((len(wo), 3), 1.0 / 3.0))
    return {name: s.sum(axis=1) if s.ndim == 2 else s for name, s in slopes.items()}
