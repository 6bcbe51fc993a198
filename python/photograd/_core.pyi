# Generated from the compiled module by tools/stubs.py. Do not edit.
"""
photograd's C++ core. Use the typed faces in the package photograd instead.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Bvh",
    "MarchSettings",
    "Op",
    "exp",
    "expm1",
    "instruction_set",
    "log1p_unit",
    "march",
    "march_backward",
    "ops",
    "philox4x32",
    "place_samples",
    "set_thread_count",
    "thread_count",
    "tiny_network_parameters",
    "uniform",
]

class Op:
    """
    A differentiable op as a flat function, for the proofs.
    """
    def backward(self, x: numpy.ndarray, d_y: numpy.ndarray, d_x: numpy.ndarray) -> numpy.ndarray:
        """
        Adds J^T d_y to d_x and returns it.
        """
    def forward(self, x: numpy.ndarray) -> numpy.ndarray:
        """
        y of the flat inputs x, in float32 or float64.
        """
    def jvp(self, x: numpy.ndarray, v: numpy.ndarray) -> numpy.ndarray:
        """
        J v, exactly, by dual numbers (float64).
        """
    @property
    def inputs(self) -> list[tuple[str, int, float, float]]:
        """
        Differentiable groups: (name, size, lo, hi).
        """
    @property
    def name(self) -> str: ...
    @property
    def outputs(self) -> int: ...

class MarchSettings:
    """
    Box, step and policies of a march.
    """
    def __init__(
        self,
        box: typing.Annotated[
            collections.abc.Sequence[
                typing.Annotated[
                    collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
                    "FixedSize(3)",
                ]
            ],
            "FixedSize(2)",
        ],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        stop: typing.SupportsFloat | typing.SupportsIndex,
        lattice: typing.SupportsInt | typing.SupportsIndex,
        quadrature: typing.SupportsInt | typing.SupportsIndex,
        border: typing.SupportsInt | typing.SupportsIndex,
        density_activation: typing.SupportsInt | typing.SupportsIndex,
        color_activation: typing.SupportsInt | typing.SupportsIndex,
        density_scale: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class Bvh:
    """
    Meshes and their instances, ready to be traced.
    """
    def __init__(
        self,
        meshes: collections.abc.Sequence[tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray | None]],
        mesh_index: numpy.ndarray,
        world_from_object: numpy.ndarray,
    ) -> None:
        """
        Meshes as (vertices (V, 3) float32, faces (F, 3) uint32, uv (V, 2) float32 or None);
        instances as mesh_index (N,) int32 and world_from_object (N, 3, 4) float64.
        """
    def occluded(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: numpy.ndarray,
        t_max: numpy.ndarray,
    ) -> numpy.typing.NDArray[numpy.bool]:
        """
        Whether anything lies within [t_min, t_max] of each ray: (R,) bool.
        """
    def surface_points(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        primitive: numpy.ndarray,
        instance: numpy.ndarray,
    ) -> tuple[typing.Any, ...]:
        """
        t (R,), barycentrics (R, 2), uv (R, 2), position (R, 3), normal (R, 3) of known hits.
        """
    def trace(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: numpy.ndarray,
        t_max: numpy.ndarray,
        t: numpy.ndarray,
        primitive: numpy.ndarray,
        instance: numpy.ndarray,
        barycentrics: numpy.ndarray,
    ) -> None:
        """
        Fills t (R,), primitive (R,), instance (R,) int32 and barycentrics (R, 2).
        """
    @property
    def bounds(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        Lower and upper corner (2, 3) of everything.
        """

def exp(x: numpy.ndarray) -> numpy.ndarray:
    """
    The portable exp on a flat array.
    """

def expm1(x: numpy.ndarray) -> numpy.ndarray:
    """
    The portable exp(x) - 1 on a flat array.
    """

def instruction_set() -> str:
    """
    Name of the kernels in use: baseline, v3 or v4.
    """

def log1p_unit(x: numpy.ndarray) -> numpy.ndarray:
    """
    The portable ln(1 + x) for x in [0, 1] on a flat array.
    """

def march(
    field: str,
    parameters: numpy.ndarray,
    settings: MarchSettings,
    origins: numpy.ndarray,
    directions: numpy.ndarray,
    t0: numpy.ndarray,
    samples: numpy.ndarray,
    fused: bool = True,
) -> tuple[typing.Any, ...]:
    """
    Colour without background (R, 3), transmittance (R,) and depth (R,).
    """

def march_backward(
    field: str,
    parameters: numpy.ndarray,
    settings: MarchSettings,
    origins: numpy.ndarray,
    directions: numpy.ndarray,
    t0: numpy.ndarray,
    samples: numpy.ndarray,
    color: numpy.ndarray,
    transmittance: numpy.ndarray,
    depth: numpy.ndarray,
    d_color: numpy.ndarray,
    d_transmittance: numpy.ndarray,
    d_depth: numpy.ndarray,
    d_parameters: numpy.ndarray,
    d_origins: numpy.ndarray | None = None,
    d_directions: numpy.ndarray | None = None,
    fused: bool = True,
) -> None:
    """
    Adds to d_parameters and, where given, to d_origins and d_directions.
    """

def philox4x32(counter: numpy.ndarray, key: numpy.ndarray) -> numpy.typing.NDArray[numpy.uint32]:
    """
    Philox4x32-10 words (N, 4) uint32 of counters (N, 4) under keys (N, 2).
    """

def place_samples(
    settings: MarchSettings,
    origins: numpy.ndarray,
    directions: numpy.ndarray,
    jitter: numpy.ndarray | None = None,
) -> tuple[typing.Any, ...]:
    """
    Per ray: t0 (R,) and the number of samples (R,) int32.
    """

def set_thread_count(threads: typing.SupportsInt | typing.SupportsIndex) -> None:
    """
    Upper limit on threads; 0 restores the default, all cores.
    """

def thread_count() -> int: ...
def uniform(
    seed: typing.SupportsInt | typing.SupportsIndex,
    step: typing.SupportsInt | typing.SupportsIndex,
    pixel: numpy.ndarray,
    sample: typing.SupportsInt | typing.SupportsIndex,
    dimension: typing.SupportsInt | typing.SupportsIndex,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Uniform numbers (N,) in [0, 1) for pixels (N,), as photograd_course.random defines them.
    """

__version__: str = "0.1.0"
ops: dict[str, typing.Any]
tiny_network_parameters: int = 132
