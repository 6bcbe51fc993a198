"""Reflectance models: what part of light from wi a surface sends towards wo, and the derivatives.

All models come from the core's registry (cpp/photograd/bsdf/registry.h); everything here, and the
proofs in the tests, iterates over it. Directions are (N, 3) unit vectors in the shading frame,
normal +Z, both leaving the surface; `f` does not contain the cosine.

Models that follow an extension of glTF name its parameters as the extension does, in snake_case:
`iridescence_factor`, `iridescence_ior` and `iridescence_thickness` (nm) of `gltf_iridescence`,
`sheen_color_factor` and `sheen_roughness_factor` of `gltf_sheen`. Its ior is `eta` here, as in all
models of glass: the index inside over outside, at the d line where `dispersion` (20 / Abbe's
number) parts the colours. `gltf_layered` has all of its layers at once, and `gltf_layered_volume`
those of a body; `..._conserving` keep white from returning more than came. `gltf_transmission` is
a sheet, `gltf_refraction` a body. The sliders of `disney` are those of [Burley2012]; his metallic
is `metalness`, as in all models here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._compiled import _core
from photograd.errors import DtypeError, RangeError, ShapeError, message
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


Parameters = Mapping[str, Any]
"""{name: value}; a value is a number or (3,), or one for each of N rows: (N,) or (N, 3)."""
SMOOTH = "surfaces without roughness are models of their own: mirror, glass, thin_glass"


@dataclass(frozen=True)
class Parameter:
    """A continuous parameter: `size` numbers that make sense in [lo, hi], in `unit`."""

    name: str
    size: int
    lo: float
    hi: float
    unit: str


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
    parameters: tuple[Parameter, ...]
    energy: tuple[str, float]
    reciprocal: bool
    transmits: bool
    core: Any

    def pack(self, parameters: Parameters, dtype: npt.DTypeLike = np.float64) -> Array:
        """Parameters as rows (1, P) or (N, P) of scalars in the core's order.

        Raises:
            RangeError: a name that is missing or unknown, values that are not finite, or one of 0
                or less where the model has none: a roughness of 0 is that of `specular`.
            ShapeError: a value of another shape, or different numbers of rows.
        """
        return pack_rows(self.name, self.parameters, parameters, dtype)

    def unpack(self, rows: Array) -> dict[str, Array]:
        """Rows (N, P) as {name: (N,) or (N, size)}."""
        return unpack_rows(self.parameters, rows)

    def f(self, parameters: Parameters, wo: Array, wi: Array) -> Array:
        """Value (N, 3) without the cosine, in the dtype of `wo`.

        Raises:
            DtypeError, ShapeError: directions not float32 or float64, or not (N, 3).
        """
        wo, wi = checked_directions(wo, wi)
        value: Array = self.core.f(self.pack(parameters, wo.dtype), wo, wi)
        return value

    def f_backward(
        self, parameters: Parameters, wo: Array, wi: Array, d_f: Array
    ) -> dict[str, Array]:
        """dL/dparameters of d_f (N, 3) as {name: (N,) or (N, size)}; (1, ...) for shared values."""
        wo, wi = checked_directions(wo, wi)
        rows = self.pack(parameters, wo.dtype)
        d_f = np.ascontiguousarray(d_f, wo.dtype)
        return self.unpack(self.core.f_backward(rows, wo, wi, d_f, np.zeros_like(rows)))

    def sample(self, parameters: Parameters, wo: Array, u2: Array) -> Array:
        """Directions wi (N, 3), drawn from uniform u2 (N, 2) with the density `pdf`."""
        (wo,) = checked_directions(wo)
        u2 = np.ascontiguousarray(u2, wo.dtype)
        wi: Array = self.core.sample(self.pack(parameters, wo.dtype), wo, u2)
        return wi

    def pdf(self, parameters: Parameters, wo: Array, wi: Array) -> Array:
        """Density (N,) of `sample` over solid angle."""
        wo, wi = checked_directions(wo, wi)
        density: Array = self.core.pdf(self.pack(parameters, wo.dtype), wo, wi)
        return density

    def index_inside(self, parameters: Parameters) -> Array:
        """Refractive index below the surface over that above, per channel, (1, 3) or (N, 3).

        It is 1 in models that do not transmit, and in sheets.
        """
        index: Array = self.core.index_inside(self.pack(parameters))
        return index

    def at(self, fraction: float) -> dict[str, Array]:
        """All parameters at a fraction of their range; channels of colours differ a little."""
        values = {}
        for parameter in self.parameters:
            spread = np.linspace(0.9, 1.1, parameter.size) if parameter.size > 1 else np.ones(1)
            part = np.clip(fraction * spread, 0.0, 1.0)
            value = parameter.lo + (parameter.hi - parameter.lo) * part
            values[parameter.name] = value if parameter.size > 1 else value[0]
        return values


def pack_rows(
    model: str, described: tuple[Parameter, ...], values: Parameters, dtype: npt.DTypeLike
) -> Array:
    """Named values as rows (1, P) or (N, P) of scalars in the order of the description."""
    names = [parameter.name for parameter in described]
    if set(values) != set(names):
        raise RangeError(message(model, "parameters", f"exactly {names}", sorted(values)))
    columns = [_column(model, parameter, values[parameter.name]) for parameter in described]
    rows = max(len(column) for column in columns)
    if any(len(column) not in (1, rows) for column in columns):
        counts = [len(column) for column in columns]
        raise ShapeError(message(model, "parameters", "one number of rows", counts))
    wide = [np.broadcast_to(column, (rows, column.shape[1])) for column in columns]
    return np.ascontiguousarray(np.concatenate(wide, axis=1), dtype)


def unpack_rows(described: tuple[Parameter, ...], rows: Array) -> dict[str, Array]:
    """Rows (N, P) as {name: (N,) or (N, size)}."""
    ends = np.cumsum([parameter.size for parameter in described])[:-1]
    return {
        parameter.name: part[:, 0] if parameter.size == 1 else part
        for parameter, part in zip(described, np.split(rows, ends, axis=1), strict=True)
    }


def _column(model: str, parameter: Parameter, value: Any) -> Array:
    try:
        column = np.asarray(value, np.float64)
    except (TypeError, ValueError) as failure:
        text = repr(value)
        got = text if len(text) <= 60 else f"{text[:57]}..."
        raise DtypeError(message(model, parameter.name, "numbers", got)) from failure
    one = (parameter.size,) if parameter.size > 1 else ()
    if column.shape != one and (column.ndim != len(one) + 1 or column.shape[1:] != one):
        expected = f"shape {one} or {('N', *one)}"
        raise ShapeError(message(model, parameter.name, expected, column.shape))
    if not np.isfinite(column).all():
        raise RangeError(message(model, parameter.name, "finite numbers", "NaN or infinity"))
    if parameter.lo > 0 and not (column > 0).all():
        # A lobe without width has no value, and an index of 0 none, either.
        got, remedy = column.min(), SMOOTH if "roughness" in parameter.name else None
        raise RangeError(message(model, parameter.name, "above 0", got, remedy))
    rows: Array = column.reshape(-1, parameter.size)
    return rows


def registry(core: ModuleType | Any = _core) -> dict[str, BsdfModel]:
    """All reflectance models of a compiled module, by name."""
    return {
        name: BsdfModel(
            name,
            tuple(Parameter(*row) for row in model.parameters()),
            model.energy(),
            model.reciprocal(),
            model.transmits(),
            model,
        )
        for name, model in core.bsdfs.items()
    }


def checked_directions(*arrays: Array) -> tuple[Array, ...]:
    """The arrays, contiguous, if they are directions (N, 3) of one shape and floating dtype."""
    for array in arrays:
        if not isinstance(array, np.ndarray) or array.dtype not in (np.float32, np.float64):
            got = getattr(array, "dtype", type(array).__name__)
            raise DtypeError(message("bsdf", "wo, wi", "float32 or float64 arrays", got))
        if array.ndim != 2 or array.shape[1] != 3 or array.shape != arrays[0].shape:
            raise ShapeError(message("bsdf", "wo, wi", "shape (N, 3), both", array.shape))
        if array.dtype != arrays[0].dtype:
            raise DtypeError(message("bsdf", "wo, wi", "one dtype", array.dtype))
    return tuple(np.ascontiguousarray(array) for array in arrays)
