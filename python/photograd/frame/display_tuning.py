"""What comes after the light, found by descent: the tone curve, and how far bloom spreads.

    tone curve    mean over pixels of (tone_map(radiance) - target)^2
    bloom         mean over pixels of (bloom(color) - target)^2

Gradients are those of `tone_map_backward` and `bloom_backward`. Parameters that have to stay above
a bound descend as logarithms of what they are above it; exposure, in stops, descends as it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from photograd_course.optim import Adam
from photograd_course.portable_math import exp, log

from photograd._arrays import Arguments
from photograd._checks import typed
from photograd._typed import typed_call
from photograd.frame.bloom import bloom, bloom_backward
from photograd.frame.tone_mapping import DEFAULT_TONES, ToneCurve, tone_map, tone_map_backward
from photograd.types import Array, FloatArray

BOUNDS = {"slope": 1.31, "white": 1e-6, "power": 1e-6, "e": 1e-6}
"""Of parameters of tone curves, of which others stay above 0."""
LEAST = 1e-6
"""What a weight of bloom starts with at least."""


@typed_call
@dataclass(frozen=True, eq=False)
class TunedToneCurve:
    """What was found.

    Attributes:
        exposure: in stops.
        params: of the curve.
        before, after: root of the mean squared difference from the target, of the start and of what
            was found.
        history: (steps + 1,) of the loss.
    """

    exposure: float
    params: Mapping[str, float]
    before: float
    after: float
    history: FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class TunedBloom:
    """What was found.

    Attributes:
        weights: (L,) of the levels.
        before, after: root of the mean squared difference from the target, of the start and of what
            was found.
        history: (steps + 1,) of the loss.
    """

    weights: FloatArray
    before: float
    after: float
    history: FloatArray


@typed_call
def tune_tone_curve(
    radiance: Array,
    target: Array,
    curve: ToneCurve = "agx",
    *,
    steps: int = 200,
    rate: float = 0.02,
) -> TunedToneCurve:
    """Exposure and parameters with which a picture is displayed most like another one.

    Args:
        radiance: (H, W, 3) of at least 0, linear.
        target: (H, W, 3) as displayed, linear.
        curve: of the display.
        steps: of Adam, from the curve's defaults.
        rate: of a step.

    Raises:
        DtypeError, ShapeError, RangeError: arrays or numbers of other kinds.
    """
    call = Arguments("tune_tone_curve", np.float64)
    radiance = call.array("radiance", radiance, ("H", "W", 3), min_length=1, low=0.0)
    target = call.array("target", target, radiance.shape)
    call.integer("steps", steps, low=1)
    rate = call.number("rate", rate, above=0.0)
    typed("tune_tone_curve", "curve", ToneCurve, curve)
    bound = {name: BOUNDS.get(name, 0.0) for name in DEFAULT_TONES[curve]}
    x = {name: log(np.array([value - bound[name]])) for name, value in DEFAULT_TONES[curve].items()}
    x["exposure"] = np.zeros(1)
    optimizer, history = Adam(), []
    best, least = (0.0, dict(DEFAULT_TONES[curve])), np.inf
    for _ in range(steps + 1):
        params = {name: bound[name] + float(exp(x[name])[0]) for name in bound}
        exposure = float(x["exposure"][0])
        shown = tone_map(radiance, curve, exposure=exposure, params=params)
        difference = shown - target
        history.append(float(np.mean(difference * difference)))
        if history[-1] < least:
            best, least = (exposure, params), history[-1]
        d_out = 2.0 * difference / difference.size
        _, d = tone_map_backward(radiance, d_out, curve, exposure=exposure, params=params)
        d_x = {name: np.array([d[name] * (params[name] - bound[name])]) for name in bound}
        d_x["exposure"] = np.array([d["exposure"]])
        optimizer.step(x, d_x, rate)
    before, after = float(np.sqrt(history[0])), float(np.sqrt(least))
    return TunedToneCurve(best[0], best[1], before, after, np.array(history))


@typed_call
def tune_bloom(
    color: Array, target: Array, weights: Array, *, steps: int = 200, rate: float = 0.05
) -> TunedBloom:
    """Weights of the levels of bloom with which a picture is most like another one.

    Args:
        color: (H, W, 3) linear radiance.
        target: (H, W, 3), such as `color` behind a lens that scatters light.
        weights: (L,) to start from, of which each is raised to 1e-6.
        steps: of Adam.
        rate: of the logarithms, a step.

    Raises:
        DtypeError, ShapeError, RangeError: arrays or numbers of other kinds.
    """
    call = Arguments("tune_bloom", np.float64)
    color = call.array("color", color, ("H", "W", 3), min_length=1)
    target = call.array("target", target, color.shape)
    start = call.array("weights", weights, ("L",), min_length=1, low=0.0, high=1.0)
    call.integer("steps", steps, low=1)
    rate = call.number("rate", rate, above=0.0)
    x = {"weights": log(np.maximum(start, LEAST))}
    optimizer, history, best, least = Adam(), [], start, np.inf
    for _ in range(steps + 1):
        found = exp(x["weights"])
        found = found / max(float(found.sum()), 1.0)  # no more than all light is spread
        difference = bloom(color, found) - target
        history.append(float(np.mean(difference * difference)))
        if history[-1] < least:
            best, least = found, history[-1]
        _, d, _ = bloom_backward(color, found, 2.0 * difference / difference.size)
        optimizer.step(x, {"weights": d * found}, rate)
    before, after = float(np.sqrt(history[0])), float(np.sqrt(least))
    return TunedBloom(best, before, after, np.array(history))
