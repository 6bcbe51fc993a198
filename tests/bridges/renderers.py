"""Renderers with inputs in double, for the bridges to PyTorch and JAX, and their adjoints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from photograd import builtin_scene
from photograd._bridges import Pair, representation_pair, splat_pair, tracer_pair
from photograd.capture.frames import invert_rigid
from photograd.fields import DenseGrid, GaussianScene, HashGrid
from photograd.fields.gaussians_2d import Gaussians2D
from photograd.representation import RenderOptions, Representation
from photograd.splats.splatting import SplatOptions
from photograd.transport.path_options import DEFAULTS
from photograd.transport.tracer import PathTracer
from photograd.types import Array

from tests.splat import oracle

SMOOTH = SplatOptions().smooth()


@dataclass(frozen=True)
class Case:
    """A renderer of a bridge.

    Attributes:
        inputs: arrays in double, by name.
        pair: it, as NumPy functions of these names.
        call: the same through `photograd.torch` or `photograd.jax`: (module, arrays) -> outputs.
    """

    inputs: dict[str, Array]
    pair: Callable[[tuple[str, ...]], Pair]
    call: Callable[[Any, Any], tuple[Any, ...]]


def of_field(kind: type[Representation], names: tuple[str, ...]) -> Case:
    field = kind.example(seed=1)
    batch = field.example_batch(seed=1)
    given = {**field.params, **{n: getattr(batch, n) for n in names if hasattr(batch, n)}}
    options = RenderOptions(jitter=True)
    numbers = {"seed": 3, "step": 5, "options": options}
    return Case(
        {name: np.array(given[name], np.float64) for name in names},
        lambda chosen: representation_pair("test", field, chosen, batch, **numbers),
        lambda module, arrays: module.render(field, arrays, batch, **numbers),
    )


def of_splats() -> Case:
    g, camera = oracle.cloud(7, 1, degree=1), replace(oracle.camera(), width=12, height=10)
    pose = np.ascontiguousarray(invert_rigid(camera.world_from_camera)[:3])
    more = {"background": np.array([0.2, 0.5, 0.3]), "camera_from_world": pose}
    return Case(
        {**g.arrays(), **more},
        lambda chosen: splat_pair("test", chosen, camera, SMOOTH),
        lambda module, arrays: module.splat(arrays, camera, options=SMOOTH),
    )


def of_tracer() -> Case:
    tracer = PathTracer(builtin_scene("cornell-box", 6), dtype=np.float64)
    names = [name for name in tracer.params if name.endswith("red.albedo")]
    names += [name for name in tracer.params if name.startswith("emission.")]
    paths = {"spp": 8, "seed": 4, "backward_seed": None, "options": DEFAULTS, "camera": None}
    return Case(
        {name: np.array(tracer.params[name]) for name in names},
        lambda chosen: tracer_pair("test", tracer, chosen, **paths),  # type: ignore[arg-type]
        lambda module, arrays: (module.trace(tracer, arrays, **paths),),
    )


CASES: dict[str, Callable[[], Case]] = {
    "grid": lambda: of_field(DenseGrid, ("values", "origins", "directions")),
    "networks": lambda: of_field(HashGrid, ("density", "table")),
    "gaussians": lambda: of_field(GaussianScene, ("means", "sh_constant", "camera_from_world")),
    "canvas": lambda: of_field(Gaussians2D, tuple(Gaussians2D.example(seed=1).params)),
    "splats": of_splats,
    "paths": of_tracer,
}


@cache
def case(name: str) -> Case:
    return CASES[name]()


def cotangents(pair: Pair) -> dict[str, Array]:
    """dL/d each output: other numbers everywhere, and none zero."""
    found = {}
    for k, (name, shape) in enumerate(pair.shapes.items()):
        count = int(np.prod(shape))
        found[name] = (0.3 + np.cos(1.7 * k + 0.9 * np.arange(count))).reshape(shape)
    return found


def adjoint(name: str) -> dict[str, Array]:
    """dL/d each input, by the project's own backward pass."""
    this = case(name)
    pair = this.pair(tuple(this.inputs))
    _, context = pair.forward(this.inputs)
    return dict(pair.backward(context, cotangents(pair)))
