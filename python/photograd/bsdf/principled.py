"""The principled reflectance model at millions of pairs of directions: values and derivatives.

The model is `photograd.bsdf`'s "principled" (cpp/photograd/bsdf/principled.h); here its values are
worked out sixteen at a time, in float32. One row of parameters serves all evaluations, or a
picture's texels serve in turn: evaluation n takes row n mod T.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd._compiled import _core
from photograd.types import Array


def rows(base_color: Any, metalness: Any, roughness: Any) -> Array:
    """Parameters as rows (T, 5) float32, the order that `evaluate` wants.

    Args:
        base_color: (3,) or (..., 3).
        metalness, roughness: numbers, or arrays like base_color without its last axis; an axis of
            size 1 in its place is allowed.

    Raises:
        ValueError: shapes that do not fit together.
    """
    color = np.asarray(base_color, np.float32).reshape(-1, 3)
    found = np.empty((len(color), 5), np.float32)
    found[:, :3] = color
    found[:, 3] = np.asarray(metalness, np.float32).reshape(-1)
    found[:, 4] = np.asarray(roughness, np.float32).reshape(-1)
    return found


def evaluate(
    parameters: Array, wo: Array, wi: Array, *, cosine: bool = False, out: Array | None = None
) -> Array:
    """f(wo, wi), with or without the cosine.

    Args:
        parameters: (T, 5) float32, see `rows`.
        wo, wi: (N, 3) float32 unit vectors in the shading frame.
        cosine: whether values are times the cosine of wi.
        out: (N, 3), overwritten; by default a new array.

    Returns:
        (N, 3), `out` where it is given; 0 unless both directions are above the surface.

    Raises:
        DtypeError, RangeError, ShapeError: arrays other than these.
    """
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
        DtypeError, RangeError, ShapeError: arrays other than these.
    """
    d_parameters = np.zeros(np.shape(parameters), np.float32) if out is None else out
    _core.principled_values_backward(parameters, wo, wi, cosine, d_values, d_parameters)
    return d_parameters
