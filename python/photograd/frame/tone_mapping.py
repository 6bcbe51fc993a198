"""Tone mapping: from radiance without a limit to what a display shows, with derivatives.

All curves are monotone and 0 at 0; pictures on both sides are linear Rec. 709. `encode` of
`photograd.images` makes what a file stores. Formulas: cpp/photograd/ops/tone_curve.h.

    extended Reinhard [Reinhard2002]    {"white": 4.0}, the radiance that is shown as 1
    a rational fit of ACES [Narkowicz2016]     {"a", "b", "c", "d", "e"}
    AgX [Sobotka2022]                   {"slope": 2.4, "power": 1.5} of its contrast
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal, get_args

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import typed
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array, FloatArray

ToneCurve = Literal["reinhard", "aces", "agx"]
TONE_CURVES: tuple[ToneCurve, ...] = get_args(ToneCurve)
DEFAULT_TONES: Mapping[ToneCurve, Mapping[str, float]] = MappingProxyType(
    {
        "reinhard": {"white": 4.0},
        "aces": {"a": 2.51, "b": 0.03, "c": 2.43, "d": 0.59, "e": 0.14},
        "agx": {"slope": 2.4, "power": 1.5},
    }
)


@typed_call
def tone_map(
    color: Array,
    curve: ToneCurve = "agx",
    *,
    exposure: float = 0.0,
    params: Mapping[str, float] | None = None,
) -> Array:
    """A picture as a display shows it.

    Args:
        color: (..., 3) radiance of at least 0, linear Rec. 709, float32 or float64.
        curve: by which.
        exposure: in stops: radiance is multiplied by 2^exposure first.
        params: of the curve; those that are left out have the defaults (`DEFAULT_TONES`).

    Returns:
        (..., 3) of the same dtype, linear. Values above 1 are left to the display.

    Raises:
        DtypeError, ShapeError: color of another dtype or shape.
        RangeError: another curve, radiance below 0 or not finite, or parameters that make no curve.
    """
    call = Arguments("tone_map")
    flat, numbers, scale = _arguments(call, color, curve, exposure, params)
    out = np.empty_like(flat)
    call.run(_core.tone_map, flat * scale, TONE_CURVES.index(curve), numbers, out)
    return out.reshape(np.shape(color))


@typed_call
def tone_map_backward(
    color: Array,
    d_out: Array,
    curve: ToneCurve = "agx",
    *,
    exposure: float = 0.0,
    params: Mapping[str, float] | None = None,
) -> tuple[Array, dict[str, float]]:
    """Derivatives of a loss after tone mapping with respect to what `tone_map` read.

    Args:
        color: as for `tone_map`.
        d_out: dL/d(its result), of the shape of `color`.
        curve, exposure, params: as for `tone_map`.

    Returns:
        dL/dcolor, and {name: dL/dvalue} of "exposure" and the curve's parameters.

    Raises:
        DtypeError, ShapeError, RangeError: as for `tone_map`.
    """
    call = Arguments("tone_map_backward")
    flat, numbers, scale = _arguments(call, color, curve, exposure, params)
    d_flat = call.array("d_out", d_out, (..., 3)).reshape(-1, 3)
    if d_flat.shape != flat.shape:
        call.array("d_out", d_out, np.shape(color))
    d_scaled, d_numbers = np.zeros_like(flat), np.zeros_like(numbers)
    number = TONE_CURVES.index(curve)
    call.run(_core.tone_map_backward, flat * scale, number, numbers, d_flat, d_scaled, d_numbers)
    d_color = d_scaled * scale
    d_params = dict(zip(DEFAULT_TONES[curve], d_numbers.tolist(), strict=True))
    d_params["exposure"] = float(np.vdot(d_color, flat)) * float(np.log(2.0))
    return d_color.reshape(np.shape(color)), d_params


def _arguments(
    call: Arguments,
    color: Array,
    curve: ToneCurve,
    exposure: float,
    params: Mapping[str, float] | None,
) -> tuple[Array, Array, Array]:
    """Colors (N, 3), the curve's numbers and the factor of the exposure, of one dtype."""
    typed(call.function, "curve", ToneCurve, curve)
    flat = call.array("color", color, (..., 3), low=0.0).reshape(-1, 3)
    exposure = call.number("exposure", exposure, low=-64.0, high=64.0)
    known = dict(DEFAULT_TONES[curve])
    for name in (params or {}).keys() - known.keys():
        expected = f"parameters of '{curve}': {', '.join(known)}"
        raise RangeError(message(call.function, "params", expected, name))
    known.update(params or {})
    for name, value in known.items():
        low = {"slope": 1.31}.get(name, 0.0 if name in "abcd" else 1e-6)
        known[name] = call.number(name, value, low=low, high=1e6)
    numbers: FloatArray = np.array(list(known.values()), flat.dtype)
    return flat, numbers, np.exp2(np.array(exposure, flat.dtype))
