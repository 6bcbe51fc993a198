"""Whether the adjoint of a representation is right: three proofs, for one that anybody wrote.

    assert check_gradients(MyField), check_gradients(MyField)

runs what the tests of this package run on each registered class. `GradientProblem` has the same
functions in the form that `photograd_course.gradcheck` takes, for other checks.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.gradcheck import (
    DotProductReport,
    GradientReport,
    TaylorReport,
    check_gradient,
    dot_product_error,
    taylor_slope,
)
from photograd_course.gradcheck.probes import group_scale

from photograd.errors import DtypeError, RangeError, ShapeError, message
from photograd.representation.base import FRAMES, Representation, dense_gradient
from photograd.representation.batches import CanvasBatch, ImageBatch, Outputs, RenderOptions
from photograd.types import Array

JITTERED = RenderOptions(jitter=True)
"""Jitter is a function of seed and step: finite differences do not see it."""
SEED, STEP = 3, 5
"""Of the renderings that are compared."""
STEPS = (1e-3, 1e-4, 1e-5, 1e-6)
"""Of the differences in place of a forward derivative, in root mean squares of each group."""


class GradientProblem:
    """A representation and a batch as functions of {group: array}.

    Attributes:
        field: a copy of the representation, whose `params` each call replaces.
        batch: what it renders.
        params: where the gradient is checked.
        options: of the renderings.
    """

    def __init__(
        self,
        representation: Representation | type[Representation],
        *,
        batch: Any = None,
        seed: int = 0,
        dtype: npt.DTypeLike = np.float64,
        options: RenderOptions = JITTERED,
    ) -> None:
        """Copy the representation, its parameters converted to `dtype`; a class is its `example`.

        Args:
            representation: an instance, or a class.
            batch: what it renders; None takes its `example_batch`.
            seed: of `example` and `example_batch`.
            dtype: float64, or float32 where no differences are taken.
            options: of the renderings.

        Raises:
            DtypeError: no `Representation`.
        """
        kind: Any = np.dtype(dtype).type
        if isinstance(representation, type) and issubclass(representation, Representation):
            self.field = representation.example(seed=seed, dtype=kind)
        elif isinstance(representation, Representation):
            self.field = copy(representation)
        else:
            expected, got = "a Representation or its class", repr(representation)
            raise DtypeError(message("check_gradients", "representation", expected, got))
        _require_described(self.field)
        self.params = {name: np.array(p, kind) for name, p in self.field.params.items()}
        self.field.params = dict(self.params)
        self.batch = self.field.example_batch(seed=seed) if batch is None else batch
        self.options = options

    def render(
        self, params: Mapping[str, Array], batch: Any, options: RenderOptions
    ) -> tuple[Outputs, Any]:
        """What the representation returns with these parameters.

        Args:
            params: by group.
            batch: what is rendered.
            options: of the rendering.
        """
        self.field.params = dict(params)
        found: Any = self.field.render(batch, seed=SEED, step=STEP, options=options)
        if not (isinstance(found, tuple) and len(found) == 2 and isinstance(found[0], Outputs)):
            expected, got = "a pair (Outputs, context)", type(found).__name__
            raise DtypeError(message(f"{self.field.name}.render", "return value", expected, got))
        return found

    def forward(self, params: Mapping[str, Array]) -> dict[str, Array]:
        """The outputs that there are, by name.

        Args:
            params: by group.
        """
        return _named(self.render(params, self.batch, self.options)[0])

    def backward(
        self, params: Mapping[str, Array], d_outputs: Mapping[str, Array]
    ) -> dict[str, Array]:
        """dL/d each group of parameters for dL/d each output.

        Args:
            params: by group.
            d_outputs: by output.
        """
        _, context = self.render(params, self.batch, self.options)
        found = self.field.render_backward(context, Outputs(**d_outputs))
        return {name: dense_gradient(found[name], params[name]) for name in params if name in found}

    def camera(self) -> dict[str, Array]:
        """The arrays of the batch that say where rays, points or the camera are."""
        if isinstance(self.batch, CanvasBatch):
            return {"points": self.batch.points}
        if isinstance(self.batch, ImageBatch):
            pose = self.batch.camera_from_world
            return {} if pose is None else {"camera_from_world": pose}
        return {"origins": self.batch.origins, "directions": self.batch.directions}

    def forward_camera(self, camera: Mapping[str, Array]) -> dict[str, Array]:
        """The outputs with another `camera`.

        Args:
            camera: arrays by name, as `camera` returns them.
        """
        moved: Any = replace(self.batch, **camera)
        return _named(self.render(self.params, moved, self.options)[0])

    def backward_camera(
        self, camera: Mapping[str, Array], d_outputs: Mapping[str, Array]
    ) -> dict[str, Array]:
        """dL/d each array of `camera` for dL/d each output.

        Args:
            camera: arrays by name, as `camera` returns them.
            d_outputs: by output.
        """
        moved: Any = replace(self.batch, **camera)
        options = replace(self.options, camera_adjoint=True)
        _, context = self.render(self.params, moved, options)
        found: Any = self.field.render_backward(context, Outputs(**d_outputs))
        return {name: found[name] for name in camera if name in found}

    def forward_derivative(
        self, params: Mapping[str, Array], directions: Mapping[str, Array], step: float
    ) -> dict[str, Array]:
        """J v by central differences; `step` is in root mean squares of what moves.

        Args:
            params: by group.
            directions: v, by group.
            step: of the differences.
        """
        moving = [name for name, direction in directions.items() if direction.any()]
        width = step * max((group_scale(params[name]) for name in moving), default=1.0)
        ends = [
            self.forward({name: p + side * directions[name] for name, p in params.items()})
            for side in (width, -width)
        ]
        return {name: (ends[0][name] - ends[1][name]) / (2 * width) for name in ends[0]}


def _require_described(field: Representation) -> None:
    """Raise unless `param_groups` describes the arrays of `params`."""
    function = f"{field.name}.param_groups"
    params: Any = getattr(field, "params", None)
    if not isinstance(params, Mapping):
        got = type(params).__name__
        raise DtypeError(message(f"{field.name}", "params", "{group: array}, set in __init__", got))
    groups = field.param_groups()
    if set(groups) != set(params):
        raise RangeError(message(function, "groups", f"{sorted(params)}", f"{sorted(groups)}"))
    for name, spec in groups.items():
        values = np.asarray(params[name])
        if tuple(spec.shape) != values.shape:
            raise ShapeError(message(function, f"shape of {name!r}", values.shape, spec.shape))
        if not (
            spec.range[0] <= values.min(initial=np.inf)
            and values.max(initial=-np.inf) <= spec.range[1]
        ):
            got = f"{values.min():.4g} to {values.max():.4g}"
            raise RangeError(message(function, f"range of {name!r}", f"{spec.range}", got))
        if spec.frame not in FRAMES:
            raise RangeError(message(function, f"frame of {name!r}", FRAMES, repr(spec.frame)))


def _named(outputs: Outputs) -> dict[str, Array]:
    found = {name: getattr(outputs, name) for name in ("color", "opacity", "depth")}
    return {name: value for name, value in found.items() if value is not None}


@dataclass(frozen=True)
class GradientChecks:
    """The reports of `check_gradients`; true only if all passed, and prints as a table.

    Attributes:
        differences: the gradient against central differences.
        dot_product: <J v, w> against <v, J^T w>, J v by central differences.
        taylor: the order of the remainder of the first-order expansion.
        camera: the derivative with respect to the batch; None if it was not asked for.
    """

    differences: GradientReport
    dot_product: DotProductReport
    taylor: TaylorReport
    camera: GradientReport | None = None

    @property
    def passed(self) -> bool:
        """Whether all reports that there are passed."""
        return all(self._reports())

    def _reports(self) -> list[GradientReport | DotProductReport | TaylorReport]:
        camera = [] if self.camera is None else [self.camera]
        return [self.differences, self.dot_product, self.taylor, *camera]

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        return "\n".join(map(str, self._reports()))


def check_gradients(
    representation: Representation | type[Representation],
    *,
    batch: Any = None,
    seed: int = 0,
    tolerance: float = 1e-6,
    camera: bool = False,
) -> GradientChecks:
    """Prove a representation's adjoint by finite differences, dot product and Taylor remainder.

    In float64; the representation stays as it is. Values where `render` has a kink fail.

    Args:
        representation: an instance, or a class, of which `example` is taken.
        batch: what is rendered; None takes `example_batch`.
        seed: of the example, the batch, and of all random directions and cotangents.
        tolerance: largest relative error of the first two; of the remainder the order counts.
        camera: also prove the derivative with respect to the batch, which
            `RenderOptions.camera_adjoint` asks for: origins and directions of rays, points of a
            canvas, or the pose of a camera.

    Returns:
        A report of each proof; it is true if all passed.

    Raises:
        DtypeError: no `Representation`, or outputs or gradients that are not float64.
        ShapeError: a gradient that is missing or has another shape than its parameter.
        RangeError: parameters that are not finite, or that `param_groups` does not describe, or a
            representation that refuses `camera`.

    Example:
        >>> checks = photograd.check_gradients(photograd.DenseGrid, seed=1)
        >>> bool(checks), checks.differences.groups[0].name
        (True, 'values')
    """
    problem = GradientProblem(representation, batch=batch, seed=seed)
    proved: Any = (problem.forward, problem.backward, problem.params)
    differences = check_gradient(*proved, seed=seed, tolerance=tolerance)
    products = [
        dot_product_error(
            lambda p, v, step=step: problem.forward_derivative(p, v, step),  # type: ignore[misc]
            problem.backward,
            problem.params,
            seed=seed,
            tolerance=tolerance,
        )
        for step in STEPS
    ]
    best = min(products, key=lambda report: (not report.passed, report.error))
    taylor = taylor_slope(*proved, seed=seed)
    moved = None
    if camera:
        moved = check_gradient(
            problem.forward_camera,
            problem.backward_camera,
            problem.camera(),
            seed=seed,
            tolerance=tolerance,
            directions=4,
        )
    return GradientChecks(differences, best, taylor, moved)
