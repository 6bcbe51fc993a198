"""Reflectance models: what part of light from wi a surface sends towards wo, and the derivatives.

All models come from the core's registry (cpp/photograd/bsdf/registry.h); everything here, and the
proofs in the tests, iterates over it. Directions are (N, 3) unit vectors in the shading frame,
normal +Z, both leaving the surface; `f` does not contain the cosine.

Models that follow an extension of glTF name its parameters as the extension does, in snake_case:
`iridescence_factor`, `iridescence_ior` and `iridescence_thickness` (nm) of `gltf_iridescence`,
`sheen_color_factor` and `sheen_roughness_factor` of `gltf_sheen`. Its ior is `eta` here, as in all
models of glass: the index inside over outside, at the d line where `dispersion` (20 / Abbe's
number) parts the colors. `gltf_layered` has all of its layers at once, and `gltf_layered_volume`
those of a body; `..._conserving` keep white from returning more than came. `gltf_transmission` is
a sheet, `gltf_refraction` a body. The sliders of `disney` are those of [Burley2012]; his metallic
is `metalness`, as in all models here.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._registry import ModelParameters, Registry, Values
from photograd._typed import typed_call
from photograd.types import Array

METALS = {
    "copper": {"eta": (0.30, 1.02, 1.24), "k": (3.205, 2.577, 2.397)},
    "gold": {"eta": (0.21, 0.43, 1.38), "k": (3.272, 2.455, 1.914)},
    "silver": {"eta": (0.06, 0.06, 0.04), "k": (4.152, 3.586, 2.657)},
}
"""eta + i k at 617, 549 and 451 nm for red, green and blue, as measured [Johnson1972].

Three wavelengths stand for three channels: a rendering of the whole spectrum would be less
saturated. Values go into a model as they are: `model.f({"roughness": 0.3, **METALS["gold"]}, ...)`.
"""


# Reflectance models: what part of light from wi a surface sends towards wo, and the derivatives.


@typed_call
@dataclass(frozen=True)
class BsdfModel:
    """One registered reflectance model.

    Attributes:
        name: in the registry.
        parameters: in the order in which the core packs them.
        energy: ("conserving" | "lossy" | "gains", bound on the directional albedo).
        reciprocal: whether f(wo, wi) / index(wo)^2 = f(wi, wo) / index(wi)^2; the index is 1
            above the surface, and `index_inside` below it.
        transmits: whether light may pass; wo and wi may then lie on either side.
        core: its functions on arrays, in the core.
    """

    name: str
    parameters: ModelParameters
    energy: tuple[str, float]
    reciprocal: bool
    transmits: bool
    core: Any

    def pack(self, values: Values, dtype: npt.DTypeLike = np.float64) -> Array:
        """Values of the parameters as rows (1, P) or (N, P) in the core's order.

        Raises:
            DtypeError: values that are not numbers.
            RangeError: a name that is missing or unknown, values that are not finite, or one of 0
                or less where the model has none: a roughness of 0 is that of `specular`.
            ShapeError: a value of another shape, or different numbers of rows.
        """
        return self.parameters.pack(Arguments("BsdfModel.pack", dtype), self.name, values, dtype)

    def unpack(self, rows: Array) -> dict[str, Array]:
        """Rows (N, P) as {name: (N,) or (N, size)}."""
        return self.parameters.unpack(rows)

    def f(self, values: Values, wo: Array, wi: Array) -> Array:
        """Value (N, 3) without the cosine, in the dtype of `wo`.

        Args:
            values: of the parameters: {name: value}, or packed rows.
            wo, wi: (N, 3), float32 or float64.

        Raises:
            DtypeError, RangeError, ShapeError: other directions, or what `pack` refuses.
        """
        rows, wo, wi = self._arguments("f", values, wo=wo, wi=wi)
        value: Array = self.core.f(rows, wo, wi)
        return value

    def f_backward(self, values: Values, wo: Array, wi: Array, d_f: Array) -> dict[str, Array]:
        """dL/dparameters of d_f (N, 3) as {name: (N,) or (N, size)}; (1, ...) for shared values."""
        rows, wo, wi, d_f = self._arguments("f_backward", values, wo=wo, wi=wi, d_f=d_f)
        return self.unpack(self.core.f_backward(rows, wo, wi, d_f, np.zeros_like(rows)))

    def sample(self, values: Values, wo: Array, u2: Array) -> Array:
        """Directions wi (N, 3), sampled by uniform u2 (N, 2) with the density `pdf`."""
        rows, wo, u2 = self._arguments("sample", values, wo=wo, u2=u2)
        wi: Array = self.core.sample(rows, wo, u2)
        return wi

    def pdf(self, values: Values, wo: Array, wi: Array) -> Array:
        """Density (N,) of `sample` over solid angle."""
        rows, wo, wi = self._arguments("pdf", values, wo=wo, wi=wi)
        density: Array = self.core.pdf(rows, wo, wi)
        return density

    def index_inside(self, values: Values) -> Array:
        """Refractive index below the surface over that above, per channel, (1, 3) or (N, 3).

        It is 1 in models that do not transmit, and in sheets.
        """
        call = Arguments("BsdfModel.index_inside", np.float64)
        index: Array = self.core.index_inside(self.parameters.pack(call, self.name, values))
        return index

    def _arguments(self, function: str, values: Values, **arrays: Array) -> tuple[Array, ...]:
        """Packed rows, and the arrays (N, 3), or (N, 2) for `u2`, as the core takes them."""
        call = Arguments(f"BsdfModel.{function}")
        rows = [
            call.array(name, array, ("N", 2 if name == "u2" else 3))
            for name, array in arrays.items()
        ]
        return (self.parameters.pack(call, self.name, values), *rows)

    def at(self, fraction: float) -> dict[str, Array]:
        """All parameters at a fraction of their range; channels of colors differ a little."""
        values = {}
        for parameter in self.parameters:
            spread = np.linspace(0.9, 1.1, parameter.size) if parameter.size > 1 else np.ones(1)
            part = np.clip(fraction * spread, 0.0, 1.0)
            value = parameter.lo + (parameter.hi - parameter.lo) * part
            values[parameter.name] = value if parameter.size > 1 else value[0]
        return values


@typed_call
def registry(core: ModuleType | Any = _core) -> Registry[BsdfModel]:
    """All reflectance models of a compiled module, by name."""
    models = {
        name: BsdfModel(
            name,
            ModelParameters.of(model.parameters()),
            model.energy(),
            model.reciprocal(),
            model.transmits(),
            model,
        )
        for name, model in core.bsdfs.items()
    }
    return Registry("reflectance model", models)
