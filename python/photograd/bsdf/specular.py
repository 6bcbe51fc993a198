"""Specular surfaces: mirrors and panes, whose reflectance is a delta function.

They have no value for a given wi and no density, so they are not among `photograd.bsdf`'s models.
Each names the few directions it sends light from, and their weights; a path follows one of them
with a weight of 1 in multiple importance sampling. Directions are (N, 3) unit vectors in the
shading frame, normal +Z, both leaving the surface; wo may lie on either side.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._registry import ModelParameters, Registry, Values
from photograd.types import Array


@dataclass(frozen=True)
class DeltaModel:
    """One registered specular surface.

    Attributes:
        name: in the registry.
        parameters: in the order in which the core packs them.
        lobe_count: L, the directions it may send light from.
        core: its functions on arrays, in the core.
    """

    name: str
    parameters: ModelParameters
    lobe_count: int
    core: Any

    def lobes(self, values: Values, wo: Array) -> tuple[Array, Array]:
        """Directions wi and weights, (N, L, 3) each: L(wo) = sum_k weight_k L(wi_k).

        The cosine and the change of radiance from one medium to another are in the weight. A
        lobe that does not exist (total reflection) has weight 0 and wi = 0.

        Args:
            values: of the parameters: {name: value}, or packed rows.
            wo: (N, 3), float32 or float64.

        Raises:
            DtypeError, RangeError, ShapeError: other directions or values.
        """
        call = Arguments("DeltaModel.lobes")
        wo = call.array("wo", wo, ("N", 3))
        wi, weight = self.core.lobes(self.parameters.pack(call, self.name, values), wo)
        return wi, weight

    def lobes_backward(
        self, values: Values, wo: Array, d_wi: Array, d_weight: Array
    ) -> dict[str, Array]:
        """dL/dparameters of dL/dwi and dL/dweight (N, L, 3), as {name: (N,) or (N, size)}.

        Raises:
            DtypeError, RangeError, ShapeError: as `lobes`, or a cotangent that is not (N, L, 3).
        """
        call = Arguments("DeltaModel.lobes_backward")
        wo = call.array("wo", wo, ("N", 3))
        shape = ("N", self.lobe_count, 3)
        d_wi, d_weight = (
            call.array(name, d, shape) for name, d in (("d_wi", d_wi), ("d_weight", d_weight))
        )
        rows = self.parameters.pack(call, self.name, values)
        d_rows = self.core.lobes_backward(rows, wo, d_wi, d_weight, np.zeros_like(rows))
        return self.parameters.unpack(d_rows)


def registry(core: ModuleType | Any = _core) -> Registry[DeltaModel]:
    """All specular surfaces of a compiled module, by name."""
    models = {
        name: DeltaModel(name, ModelParameters.of(model.parameters()), model.lobe_count(), model)
        for name, model in core.delta_bsdfs.items()
    }
    return Registry("specular surface", models)
