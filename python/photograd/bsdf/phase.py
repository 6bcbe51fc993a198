"""Phase functions: how a particle of fog, smoke or dust spreads light over directions.

All come from the core's registry (cpp/photograd/medium/registry.h). cos_theta is the cosine of the
angle by which light is turned, 1 straight on: <ray, sun> for a camera ray and the unit direction
towards the sun.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._registry import ModelParameters, Registry, Values
from photograd.types import Array


@dataclass(frozen=True)
class PhaseModel:
    """One registered phase function.

    Attributes:
        name: in the registry.
        parameters: in the order in which the core packs them.
        core: its functions on arrays, in the core.
    """

    name: str
    parameters: ModelParameters
    core: Any

    def p(self, values: Values, cos_theta: Array) -> Array:
        """Density over solid angle, (N,) in 1/sr.

        Args:
            values: of the parameters: {name: number}, or packed (P,).
            cos_theta: (N,), float32 or float64.

        Raises:
            DtypeError, RangeError, ShapeError: arrays other than these.
        """
        row, cos_theta = self._arguments(Arguments("PhaseModel.p"), values, cos_theta)
        density: Array = self.core.p(row, cos_theta)
        return density

    def p_backward(
        self, values: Values, cos_theta: Array, d_p: Array
    ) -> tuple[dict[str, Array], Array]:
        """dL/dparameters as {name: ()}, and dL/dcos_theta (N,), of dL/dp (N,).

        Raises:
            DtypeError, RangeError, ShapeError: as `p`, or another shape or dtype of d_p.
        """
        call = Arguments("PhaseModel.p_backward")
        row, cos_theta = self._arguments(call, values, cos_theta)
        d_p = call.array("d_p", d_p, ("N",))
        d_row, d_cos_theta = np.zeros_like(row), np.zeros_like(cos_theta)
        self.core.p_backward(row, cos_theta, d_p, d_row, d_cos_theta)
        return self.parameters.unpack(d_row), d_cos_theta

    def _arguments(self, call: Arguments, values: Values, cos_theta: Array) -> tuple[Array, Array]:
        cos_theta = call.array("cos_theta", cos_theta, ("N",))
        return self.parameters.pack_one(call, self.name, values), cos_theta


def registry() -> Registry[PhaseModel]:
    """All phase functions of the core, by name."""
    models = {
        name: PhaseModel(name, ModelParameters.of(core.parameters()), core)
        for name, core in _core.phases.items()
    }
    return Registry("phase function", models)
