"""Photon mapping: particles kept where they land, and pictures read off their density.

The mathematics is in cpp/photograd/render/light/photon_map.h.
"""

from __future__ import annotations

import numpy as np

from photograd._compiled import _core
from photograd.errors import RangeError, ShapeError, message
from photograd.transport.accumulation import Accumulation
from photograd.transport.particles import PARTICLES, ParticleOptions, scene_arguments
from photograd.transport.tracer import DEFAULTS, PathOptions, PathTracer
from photograd.types import Array


class PhotonMap:
    """What particles brought to the surfaces of a scene that are not specular.

    The estimate is biased by a blur of the radius, whatever the number of particles; in a smaller
    radius fewer of them count, and it is noisier.

    Attributes:
        tracer: the scene. A map does not change with its params: build another one.
        radius: of the disc over which photons are counted, metres.
    """

    def __init__(
        self, tracer: PathTracer, particles: int, *, radius: float, seed: int,
        options: ParticleOptions = PARTICLES, direct: bool = True,
    ) -> None:  # fmt: skip
        """Follow the particles.

        Args:
            tracer: the scene, at its present params.
            particles: how many leave the lights.
            radius: metres.
            seed: of all random numbers; the same one gives the same bits on any threads.
            options: how far particles are followed.
            direct: whether to keep what comes straight from a light.

        Raises:
            RangeError: particles below 1, a radius that is not above 0 and finite, or a scene
                without lights.
            SceneError: shapes that move.
        """
        if particles < 1:
            raise RangeError(message("PhotonMap", "particles", "at least 1", particles))
        self.tracer = tracer
        self.radius = radius
        self._map = _core.PhotonMap(
            **scene_arguments("PhotonMap", tracer),
            options=options.numbers(seed), count=particles, radius=radius, direct=direct,
        )  # fmt: skip

    def __len__(self) -> int:
        """Number of photons kept."""
        return len(self._map)

    def irradiance(self, points: Array, normals: Array) -> Array:
        """(N, 3) W/m^2 at points (N, 3) of surfaces with geometric normals (N, 3), in the world.

        Raises:
            ShapeError: arrays of other shapes.
        """
        places, sides = (np.ascontiguousarray(rows, np.float64) for rows in (points, normals))
        for name, rows in (("points", places), ("normals", sides)):
            if rows.ndim != 2 or rows.shape[1] != 3 or len(rows) != len(places):
                expected = "shape (N, 3)"
                raise ShapeError(message("PhotonMap.irradiance", name, expected, rows.shape))
        found: Array = self._map.irradiance(places, sides)
        return found

    def add_samples(
        self, sums: Accumulation, spp: int, *, seed: int, options: PathOptions = DEFAULTS
    ) -> None:
        """Add the next `spp` samples of the scene's camera to `sums` (H, W, 3), in place.

        A camera path goes through specular surfaces, and through media, to the first surface that
        is not specular; all the light there is read from the map. Light that media scatter is path
        traced.

        Raises:
            RangeError: spp below 1.
            ShapeError: sums of another size than the picture.
            Error: radiance that is not finite; names the pixel.
        """
        view = self.tracer.scene.camera
        sums.check_call("PhotonMap.add_samples", (view.height, view.width), spp)
        self._map.trace(
            **self.tracer.wide_arguments(), options=options.numbers(seed),
            first=sums.count, count=spp, radiance=sums.radiance, squares=sums.squares,
        )  # fmt: skip
        sums.count += spp
        sums.check_finite("PhotonMap.add_samples")

    def render(self, *, spp: int, seed: int, options: PathOptions = DEFAULTS) -> Accumulation:
        """A picture of `spp` samples a pixel; arguments and errors as `add_samples`."""
        view = self.tracer.scene.camera
        sums = Accumulation.empty(view.height, view.width)
        self.add_samples(sums, spp, seed=seed, options=options)
        return sums
