"""What `photograd trace` can estimate: samples of each, added to sums."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from photograd.errors import RangeError, message
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.write import write_png, write_radiance
from photograd.transport.accumulation import Accumulation
from photograd.transport.derivative import add_derivative_samples, direction_of
from photograd.transport.incomplete import require_whole
from photograd.transport.particles import PhotonMap
from photograd.transport.path_options import PathOptions
from photograd.transport.tracer import PathTracer

INTEGRATORS = ("path", "direct", "occlusion", "photon")
CLIPPED = 0.01
"""Share of pixels whose color may lie beyond the ends of a signed scale."""

DerivativeOption = Annotated[
    str,
    typer.Option(
        "--derivative",
        metavar="PARAMETER",
        help="Draw the derivative with respect to this parameter, such as "
        "materials.red.albedo[0] or textures.wood, whose texels then rise together. Refused where "
        "it is incomplete: eta of smooth glass, a mask's alpha.",
    ),
]
PhotonsOption = Annotated[
    int, typer.Option("--photons", min=1, help="Particles that the lights send, for photon.")
]


@dataclass(frozen=True)
class Estimate:
    """What is drawn; names and units as of the options of `photograd trace`.

    Raises:
        RangeError: no such integrator, no derivative of this one, or a map without a radius.
    """

    integrator: str
    options: PathOptions
    seed: int
    radius: float
    photons: int
    derivative: str

    def __post_init__(self) -> None:
        if self.integrator not in INTEGRATORS:
            raise RangeError(message("trace", "--integrator", INTEGRATORS, self.integrator))
        if self.derivative and self.integrator not in ("path", "direct"):
            got = self.integrator
            raise RangeError(message("trace", "--integrator", "path or direct", got))
        if self.integrator == "photon" and not np.isfinite(self.radius):
            remedy = "for example --radius 0.05"
            raise RangeError(
                message("trace", "--radius", "meters to count photons in", self.radius, remedy)
            )

    @property
    def key(self) -> dict[str, object]:
        """What sums depend on beside the path's options, if it is not the plain picture."""
        found: dict[str, object] = {}
        if self.derivative:
            found["derivative"] = self.derivative
        if self.integrator == "photon":
            found["photons"] = self.photons
        return found

    def adder(self, tracer: PathTracer, sums: Accumulation) -> Callable[[int], None]:
        """What adds samples to `sums`, from where they stand.

        Raises:
            RangeError: no such parameter, one whose derivative is incomplete, or photons without
                lights.
        """
        if self.derivative:
            return self._add_derivative(tracer, sums)
        if self.integrator == "photon":
            photons = PhotonMap(tracer, self.photons, radius=self.radius, seed=self.seed)
            return lambda n: photons.add_samples(sums, n, seed=self.seed, options=self.options)
        if self.integrator == "occlusion":
            return lambda n: tracer.add_occlusion(sums, n, seed=self.seed, radius=self.radius)
        return lambda n: tracer.add_samples(sums, n, seed=self.seed, options=self.options)

    def _add_derivative(self, tracer: PathTracer, sums: Accumulation) -> Callable[[int], None]:
        along = direction_of(tracer.params, self.derivative)
        require_whole("trace", "--derivative", along, tracer.incomplete)
        picture = Accumulation.empty(*sums.radiance.shape[:2])
        picture.count = sums.count
        return lambda n: add_derivative_samples(
            tracer, picture, sums, along, n, seed=self.seed, options=self.options
        )


def write_derivative(sums: Accumulation, out: Path) -> None:
    """The mean unless `out` is a .png, and the channels' sum in signed colors as PNG."""
    from photograd_course.viz import style

    mean = sums.mean
    if out.suffix.lower() in LINEAR_SUFFIXES:
        write_radiance(out, mean.astype(np.float32))
    slope = mean.sum(axis=2)
    limit = float(np.quantile(np.abs(slope), 1.0 - CLIPPED)) or float(np.abs(slope).max()) or 1.0
    colors = style.signed_color_map()(style.symmetric_scale(limit)(slope))
    write_png(out.with_suffix(".png"), np.asarray(colors)[..., :3].astype(np.float32))
