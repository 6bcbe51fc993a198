"""The protocol that every scene representation speaks, and the registry of those that exist.

One loop (`photograd.fitting.loop`), one command for pictures of gradients and one set of proofs
(`check_gradients`) serve everything that is registered here. What a capture can be fitted with is a
`Fittable`; all others say in `teaching_example` why not. Parameters are NumPy arrays; what is
expensive to rebuild lives in C++ objects.
"""

from photograd.representation.base import (
    FRAMES,
    REGISTERED,
    Gradients,
    ParamSpec,
    Prior,
    Representation,
    dense_gradient,
    register,
)
from photograd.representation.batches import (
    CanvasBatch,
    ImageBatch,
    Outputs,
    RayBatch,
    RenderOptions,
)
from photograd.representation.fittable import (
    COPIES,
    FitInProgress,
    Fittable,
    Memory,
    Start,
    fittable,
)
from photograd.representation.gradients import GradientChecks, GradientProblem, check_gradients

__all__ = [
    "COPIES",
    "FRAMES",
    "REGISTERED",
    "CanvasBatch",
    "FitInProgress",
    "Fittable",
    "GradientChecks",
    "GradientProblem",
    "Gradients",
    "ImageBatch",
    "Memory",
    "Outputs",
    "ParamSpec",
    "Prior",
    "RayBatch",
    "RenderOptions",
    "Representation",
    "Start",
    "check_gradients",
    "dense_gradient",
    "fittable",
    "register",
]
