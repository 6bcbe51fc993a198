"""The principled reflectance model at millions of pairs of directions: values and derivatives.

The model is `photograd.bsdf`'s "principled" (cpp/photograd/bsdf/principled.h); here its values are
worked out sixteen at a time, in float32. One row of parameters serves all evaluations, or a
picture's texels serve in turn: evaluation n takes row n mod T.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd.types import Array


def rows(base_color: Any, metalness: Any, roughness: Any) -> Array:
    """Parameters as rows (T, 5) float32, the order that `evaluate` wants.

    Args:
        base_color: (3,) or (..., 3).
        metalness, roughness: numbers, or arrays like base_color without its last axis; an axis of
            size 1 in its place is allowed.

    Raises:
        DtypeError, RangeError: not numbers, or not finite.
        ShapeError: shapes that do not fit together.
    """
    call = Arguments("principled.rows", np.float32)
    color = call.array("base_color", base_color, (..., 3)).reshape(-1, 3)
    found = np.empty((len(color), 5), np.float32)
    found[:, :3] = color
    for column, (name, value) in enumerate((("metalness", metalness), ("roughness", roughness))):
        numbers = call.array(name, value).reshape(-1)
        found[:, 3 + column] = call.array(name, numbers, (1,), (len(color),))
    return found


def evaluate(
    parameters: Array, wo: Array, wi: Array, *, cosine: bool = False, out: Array | None = None
) -> Array:
    """f(wo, wi), with or without the cosine.

    Args:
        parameters: (T, 5) float32, T at least 1, see `rows`.
        wo, wi: (N, 3) float32 unit vectors in the shading frame.
        cosine: whether values are times the cosine of wi.
        out: (N, 3), overwritten; by default a new array.

    Returns:
        (N, 3), `out` where it is given; 0 unless both directions are above the surface.

    Raises:
        DtypeError, ShapeError: arrays other than these.
    """
    parameters, wo, wi = _float32("principled.evaluate", parameters, wo=wo, wi=wi)
    values = np.empty(wo.shape, np.float32) if out is None else out
    _core.principled_values(parameters, wo, wi, cosine, values)
    return values


def evaluate_backward(
    parameters: Array,
    wo: Array,
    wi: Array,
    d_values: Array,
    *,
    cosine: bool = False,
    out: Array | None = None,
) -> Array:
    """dL/dparameters (T, 5) for dL/dvalues (N, 3).

    Sums over the evaluations of one row among several are taken in float32, in order; those of a
    single row in blocks that are added up in float64.

    Args:
        parameters, wo, wi, cosine: as for `evaluate`.
        d_values: (N, 3) float32.
        out: (T, 5), added to; by default a new array.

    Raises:
        DtypeError, ShapeError: arrays other than these.
    """
    parameters, wo, wi, d_values = _float32(
        "principled.evaluate_backward", parameters, wo=wo, wi=wi, d_values=d_values
    )
    d_parameters = np.zeros(np.shape(parameters), np.float32) if out is None else out
    _core.principled_values_backward(parameters, wo, wi, cosine, d_values, d_parameters)
    return d_parameters


def _float32(function: str, parameters: Array, **rows: Array) -> tuple[Array, ...]:
    """Parameters (T, 5) and rows (N, 3), all float32: so many are not converted."""
    call = Arguments(function, np.float32, convert=False)
    parameters = call.array("parameters", parameters, ("T", 5), finite=False, min_length=1)
    arrays = (call.array(name, array, ("N", 3), finite=False) for name, array in rows.items())
    return (parameters, *arrays)
