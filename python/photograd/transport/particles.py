"""Light tracing: particles from the lights, the irradiance where they land, and photon maps.

The mathematics is in cpp/photograd/scene/emit.h (how they leave),
cpp/photograd/render/path/scatter.h (what surfaces do to them),
cpp/photograd/render/path/tracer.h (how they travel) and
cpp/photograd/render/light/irradiance_sensor.h; that of photon maps in
cpp/photograd/render/light/photon_map.h.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import require_bounds
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.transport.accumulation import Accumulation
from photograd.transport.motion import refuse_motion
from photograd.transport.path_options import DEFAULTS, NEVER, PathOptions
from photograd.transport.tracer import PathTracer
from photograd.types import Array


@typed_call
@dataclass(frozen=True)
class ParticleOptions:
    """How far particles are followed.

    Attributes:
        max_depth: segments of the longest way; 1 lands straight from the lights.
        roulette_from: the first surface at which a particle may end by chance; None never ends one.

    Raises:
        RangeError: none of these.
    """

    max_depth: int = 64
    roulette_from: int | None = 4

    def __post_init__(self) -> None:
        require_bounds(self, "max_depth", low=1, high=4096)
        require_bounds(self, "roulette_from", low=0)

    def numbers(self, seed: int) -> tuple[int, int, int]:
        """As the core takes them.

        Args:
            seed: of all random numbers.
        """
        late = NEVER if self.roulette_from is None else self.roulette_from
        return self.max_depth, late, seed


PARTICLES = ParticleOptions()


@typed_call
@dataclass(frozen=True, eq=False)
class IrradianceSensor:
    """A rectangle of cells that counts the light through its front and lets it go on.

    It may lie on a surface. Seen from its front with edge_x to the right and edge_y up, row 0 is on
    top.

    Attributes:
        corner: (3,) meters.
        edge_x, edge_y: (3,) meters, perpendicular; the front is the side of edge_x x edge_y.
        height, width: cells.

    Raises:
        ShapeError: numbers that are not three finite ones.
        RangeError: edges without length or not perpendicular, or no cells.
    """

    corner: Any
    edge_x: Any
    edge_y: Any
    height: int
    width: int

    def __post_init__(self) -> None:
        call = Arguments("IrradianceSensor", np.float64)
        for name in ("corner", "edge_x", "edge_y"):
            object.__setattr__(self, name, np.array(call.array(name, getattr(self, name), (3,))))
        x, y = np.linalg.norm(self.edge_x), np.linalg.norm(self.edge_y)
        if not (x > 0 and y > 0) or abs(float(self.edge_x @ self.edge_y)) > 1e-6 * x * y:
            expected = "perpendicular edges of some length"
            got = f"{self.edge_x} and {self.edge_y}"
            raise RangeError(message("IrradianceSensor", "edge_x, edge_y", expected, got))
        for name in ("height", "width"):
            call.integer(name, getattr(self, name), low=1)

    @property
    def cell_area(self) -> float:
        """m^2."""
        whole = np.linalg.norm(np.cross(self.edge_x, self.edge_y))
        return float(whole) / (self.height * self.width)

    @property
    def rows(self) -> Array:
        """(3, 3) corner and edges, as the core takes them."""
        return np.array([self.corner, self.edge_x, self.edge_y])


@typed_call
def trace_light(
    tracer: PathTracer,
    sensor: IrradianceSensor,
    particles: int,
    *,
    seed: int,
    options: ParticleOptions = PARTICLES,
    sums: Accumulation | None = None,
) -> Accumulation:
    """The irradiance of a sensor, by particles from all lights of the scene.

    `mean` of what is returned is (H, W, 3) in W/m^2, linear Rec. 709, and times `cell_area` the
    watts that each cell gets; `standard_error` is right where a particle seldom comes to a cell
    twice. The same seed gives the same bits on any number of threads. In float64, whatever the
    tracer's dtype.

    Args:
        tracer: the scene, at its present `params`.
        sensor: what is lit.
        particles: how many leave the lights.
        seed: of all random numbers.
        options: how far particles are followed.
        sums: of earlier particles of the same seed, to go on with; changed in place.

    Raises:
        RangeError: particles below 1, or a scene without lights.
        ShapeError: sums of another shape than the sensor.
        SceneError: shapes that move.
    """
    shape = (sensor.height, sensor.width)
    total = Accumulation.empty(*shape) if sums is None else sums
    total.check_call("trace_light", shape, particles, many="particles")
    _core.trace_light(
        **scene_arguments("trace_light", tracer),
        options=options.numbers(seed),
        first=total.count,
        count=particles,
        rectangle=sensor.rows,
        irradiance=total.radiance,
        squares=total.squares,
    )
    total.count += particles
    total.check_finite("trace_light")
    return total


@typed_call
@dataclass(frozen=True, eq=False)
class Emitted:
    """Particles as they leave their lights.

    Attributes:
        origins: (N, 3) meters.
        directions: (N, 3) of unit length, the way the light goes.
        flux: (N, 3) W; its mean over all particles is the power of all lights, of those at infinity
            what falls onto the disc that their particles start from.
        entries: (N,) which light: first those of the list without a surface, in their order, then
            what emits of the shapes, piece by piece.
    """

    origins: Array
    directions: Array
    flux: Array
    entries: Array


@typed_call
def emit_particles(tracer: PathTracer, count: int, *, seed: int, first: int = 0) -> Emitted:
    """The particles that `trace_light` follows, `first` to `first + count - 1`.

    Args:
        tracer: of the scene.
        count: of particles.
        seed: of all random numbers.
        first: number of the first particle.

    Raises:
        RangeError: count below 1, or a scene without lights.
        SceneError: as `trace_light`.
    """
    Arguments("emit_particles").integer("count", count, low=1)
    return Emitted(
        *_core.emit_particles(
            **scene_arguments("emit_particles", tracer), seed=seed, first=first, count=count
        )
    )


def scene_arguments(function: str, tracer: PathTracer) -> dict[str, Any]:
    """The scene as the core's functions take it that have no camera.

    Args:
        function: on whose behalf the error speaks.
        tracer: of the scene.

    Raises:
        SceneError: shapes that move.
    """
    refuse_motion(function, tracer.scene.shapes)
    arguments = tracer.wide_arguments()
    del arguments["camera"]
    return arguments


# Photon mapping: particles kept where they land, and pictures read off their density.


@typed_call
class PhotonMap:
    """What particles brought to the surfaces of a scene that are not specular.

    The estimate is biased by a blur of the radius, whatever the number of particles; in a smaller
    radius fewer of them count, and it is noisier.

    Attributes:
        tracer: the scene. A map does not change with its params: build another one.
        radius: of the disc over which photons are counted, meters.
    """

    def __init__(
        self,
        tracer: PathTracer,
        particles: int,
        *,
        radius: float,
        seed: int,
        options: ParticleOptions = PARTICLES,
        direct: bool = True,
    ) -> None:
        """Follow the particles.

        Args:
            tracer: the scene, at its present params.
            particles: how many leave the lights.
            radius: meters.
            seed: of all random numbers; the same one gives the same bits on any threads.
            options: how far particles are followed.
            direct: whether to keep what comes straight from a light.

        Raises:
            RangeError: particles below 1, a radius that is not above 0 and finite, or a scene
                without lights.
            SceneError: shapes that move.
        """
        Arguments("PhotonMap").integer("particles", particles, low=1)
        self.tracer = tracer
        self.radius = radius
        self._map = _core.PhotonMap(
            **scene_arguments("PhotonMap", tracer),
            options=options.numbers(seed),
            count=particles,
            radius=radius,
            direct=direct,
        )

    def __len__(self) -> int:
        """Number of photons kept."""
        return len(self._map)

    def irradiance(self, points: Array, normals: Array) -> Array:
        """(N, 3) W/m^2 at points (N, 3) of surfaces with geometric normals (N, 3), in the world.

        Raises:
            ShapeError: arrays of other shapes.
        """
        call = Arguments("PhotonMap.irradiance", np.float64)
        points = call.array("points", points, ("N", 3), finite=False)
        normals = call.array("normals", normals, ("N", 3), finite=False)
        found: Array = call.run(self._map.irradiance, points, normals)
        return found

    def add_samples(
        self, sums: Accumulation, spp: int, *, seed: int, options: PathOptions = DEFAULTS
    ) -> None:
        """Add the next `spp` samples of the scene's camera to `sums` (H, W, 3), in place.

        A camera path goes through specular surfaces, and through media, to the first surface that
        is not specular; all the light there is read from the map. Light that media scatter is path
        traced.

        Args:
            sums: of the same seed and options, or empty.
            spp: samples a pixel.
            seed: of all random numbers.
            options: of the path tracer.

        Raises:
            RangeError: spp below 1.
            ShapeError: sums of another size than the picture.
            Error: radiance that is not finite; names the pixel.
        """
        view = self.tracer.scene.camera
        sums.check_call("PhotonMap.add_samples", (view.height, view.width), spp)
        _core.trace_photons(
            map=self._map,
            **self.tracer.wide_arguments(),
            options=options.numbers(seed),
            first=sums.count,
            count=spp,
            radiance=sums.radiance,
            squares=sums.squares,
        )
        sums.count += spp
        sums.check_finite("PhotonMap.add_samples")

    def render(self, *, spp: int, seed: int, options: PathOptions = DEFAULTS) -> Accumulation:
        """A picture of `spp` samples a pixel; `seed`, `options` and errors as of `add_samples`."""
        view = self.tracer.scene.camera
        sums = Accumulation.empty(view.height, view.width)
        self.add_samples(sums, spp, seed=seed, options=options)
        return sums
