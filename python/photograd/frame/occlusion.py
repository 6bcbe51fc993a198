"""Ambient occlusion in screen space, from the depths and normals of a frame, with derivatives.

Samples of obscurance on a disk around each pixel [McGuire2011; McGuire2012]; formulas:
cpp/photograd/frame/ssao.h. What the frame does not show hides nothing.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import require_types
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.screen import Intrinsics, screen_arguments
from photograd.types import Array


@typed_call
@dataclass(frozen=True)
class SsaoSettings:
    """Numbers that are searched for by hand in engines, and by descent here.

    Attributes:
        radius: meters; what is further away hides nothing.
        falloff: exponent k of (1 - distance^2 / radius^2)^k.
        bias: sine of the elevation above the surface from which points hide anything.
        distribution: exponent d of the samples' distances, radius ((i + 1/2) / N)^d; 1/2 is uniform
            over the disk, more gathers them at the pixel.
        strength: factor of the occlusion.

    Raises:
        DtypeError, RangeError: no numbers, or out of range.
    """

    radius: float = 0.5
    falloff: float = 1.0
    bias: float = 0.05
    distribution: float = 1.0
    strength: float = 1.5

    def __post_init__(self) -> None:
        require_types(self)
        call = Arguments("SsaoSettings")
        for name in ("radius", "falloff", "distribution"):
            call.number(name, getattr(self, name), above=0.0, high=1e6)
        call.number("bias", self.bias, low=0.0, below=1.0)
        call.number("strength", self.strength, low=0.0, high=1e6)


SSAO_DEFAULTS = SsaoSettings()


@typed_call
def ssao(
    depth: Array,
    normals: Array,
    camera: Camera,
    settings: SsaoSettings = SSAO_DEFAULTS,
    *,
    samples: int = 16,
) -> Array:
    """How much of the sky each pixel sees, before it is limited to [0, 1].

    Args:
        depth: (H, W) along the camera's axis, meters; infinite where nothing is visible.
        normals: (H, W, 3) unit normals in the world, towards the viewer; not read where nothing is
            visible.
        camera: of the frame.
        settings: of the estimate.
        samples: a pixel, 1 to 256. Squares of 4 x 4 pixels share 16 turns of one pattern.

    Returns:
        (H, W) of the dtype of `depth`; 1 on flat walls and where nothing is visible. In corners it
        may fall below 0.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or sizes than the camera's.
    """
    call = Arguments("ssao")
    arguments = _arguments(call, depth, normals, camera, settings)
    out = np.empty_like(arguments[0])
    call.run(_core.ssao, *arguments, call.integer("samples", samples, low=1, high=256), out)
    return out


@typed_call
def ssao_backward(
    depth: Array,
    normals: Array,
    camera: Camera,
    d_out: Array,
    settings: SsaoSettings = SSAO_DEFAULTS,
    *,
    samples: int = 16,
) -> dict[str, float]:
    """{name: dL/dvalue} of the settings; depths and normals are held.

    Args:
        depth, normals, camera, settings, samples: as for `ssao`.
        d_out: (H, W), dL/d(its result).

    Raises:
        DtypeError, ShapeError, RangeError: as for `ssao`.
    """
    call = Arguments("ssao_backward")
    arguments = _arguments(call, depth, normals, camera, settings)
    d_out = call.array("d_out", d_out, ("H", "W"))
    d_settings = np.zeros(5, d_out.dtype)
    count = call.integer("samples", samples, low=1, high=256)
    call.run(_core.ssao_backward, *arguments, count, d_out, d_settings)
    names = [field.name for field in fields(SsaoSettings)]
    return dict(zip(names, d_settings.tolist(), strict=True))


def _arguments(
    call: Arguments, depth: Array, normals: Array, camera: Camera, settings: SsaoSettings
) -> tuple[Array, Array, Intrinsics, Array]:
    screen = screen_arguments(call, depth, normals, camera)
    return *screen, np.array(list(asdict(settings).values()), screen[0].dtype)
