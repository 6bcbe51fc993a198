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

from photograd._compiled import _core
from photograd.bsdf.models import Parameter, Parameters, checked_directions, pack_rows, unpack_rows
from photograd.errors import ShapeError, message
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
    parameters: tuple[Parameter, ...]
    lobe_count: int
    core: Any

    def lobes(self, parameters: Parameters, wo: Array) -> tuple[Array, Array]:
        """Directions wi and weights, (N, L, 3) each: L(wo) = sum_k weight_k L(wi_k).

        The cosine and the change of radiance from one medium to another are in the weight. A
        lobe that does not exist (total reflection) has weight 0 and wi = 0.

        Raises:
            DtypeError, ShapeError: wo not float32 or float64, or not (N, 3).
        """
        (wo,) = checked_directions(wo)
        rows = pack_rows(self.name, self.parameters, parameters, wo.dtype)
        wi, weight = self.core.lobes(rows, wo)
        return wi, weight

    def lobes_backward(
        self, parameters: Parameters, wo: Array, d_wi: Array, d_weight: Array
    ) -> dict[str, Array]:
        """dL/dparameters of dL/dwi and dL/dweight (N, L, 3), as {name: (N,) or (N, size)}.

        Raises:
            ShapeError: a cotangent that is not (N, L, 3).
        """
        (wo,) = checked_directions(wo)
        shape = (len(wo), self.lobe_count, 3)
        for name, array in (("d_wi", d_wi), ("d_weight", d_weight)):
            if np.shape(array) != shape:
                raise ShapeError(message(self.name, name, f"shape {shape}", np.shape(array)))
        rows = pack_rows(self.name, self.parameters, parameters, wo.dtype)
        cotangents = (np.ascontiguousarray(d, wo.dtype) for d in (d_wi, d_weight))
        d_rows = self.core.lobes_backward(rows, wo, *cotangents, np.zeros_like(rows))
        return unpack_rows(self.parameters, d_rows)


def registry(core: ModuleType | Any = _core) -> dict[str, DeltaModel]:
    """All specular surfaces of a compiled module, by name."""
    return {
        name: DeltaModel(
            name, tuple(Parameter(*row) for row in model.parameters()), model.lobe_count(), model
        )
        for name, model in core.delta_bsdfs.items()
    }
