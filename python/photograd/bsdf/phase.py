"""Phase functions: how a particle of fog, smoke or dust spreads light over directions.

All come from the core's registry (cpp/photograd/medium/registry.h). cos_theta is the cosine of the
angle by which light is turned, 1 straight on: <ray, sun> for a camera ray and the unit direction
towards the sun.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._compiled import _core
from photograd.bsdf.models import Parameter
from photograd.errors import RangeError, message
from photograd.types import Array


@dataclass(frozen=True)
class PhaseModel:
    """One registered phase function.

    Attributes:
        name: in the registry.
        parameters: in the order in which arrays (P,) hold them.
        core: its functions on arrays, in the core.
    """

    name: str
    parameters: tuple[Parameter, ...]
    core: Any

    def p(self, parameters: Array, cos_theta: Array) -> Array:
        """Density over solid angle, (N,) in 1/sr, of parameters (P,) and cos_theta (N,).

        Both are of one dtype, float32 or float64.
        """
        density: Array = self.core.p(parameters, np.ascontiguousarray(cos_theta))
        return density

    def p_backward(self, parameters: Array, cos_theta: Array, d_p: Array) -> tuple[Array, Array]:
        """dL/dparameters (P,) and dL/dcos_theta (N,) of dL/dp (N,)."""
        d_parameters, d_cos_theta = np.zeros_like(parameters), np.zeros_like(cos_theta)
        self.core.p_backward(
            parameters,
            np.ascontiguousarray(cos_theta),
            np.ascontiguousarray(d_p),
            d_parameters,
            d_cos_theta,
        )
        return d_parameters, d_cos_theta


def registry() -> dict[str, PhaseModel]:
    """All phase functions of the core, by name."""
    models: Mapping[str, Any] = _core.phases
    return {
        name: PhaseModel(name, tuple(Parameter(*row) for row in core.parameters()), core)
        for name, core in models.items()
    }


def phase_function(name: str) -> PhaseModel:
    """The phase function of that name. Raises RangeError, which lists all, for another one."""
    known = registry()
    if name not in known:
        expected = f"one of {sorted(known)}"
        raise RangeError(message("phase_function", "name", expected, repr(name)))
    return known[name]
