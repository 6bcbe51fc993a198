"""What a frame is put together from, and how."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from photograd._arrays import Arguments
from photograd._checks import require_choices
from photograd.frame.occlusion import SsaoSettings
from photograd.frame.shadows import ShadowSettings
from photograd.frame.tone_mapping import ToneCurve

SkyVisibility = Literal["occlusion", "shadow_maps", "none"]
Shading = Literal["deferred", "forward"]


@dataclass(frozen=True)
class FrameOptions:
    """The passes of a frame.

    Attributes:
        shading: "deferred" keeps surfaces in a G-buffer and lights them afterwards, "forward"
            lights the surfaces of each shape as it is drawn, seen in the end or not; both make the
            same picture.
        surface_points: points that stand for the surfaces that emit, all together; each has a
            shadow map. 0 leaves their light out.
        sky_directions: directions that stand for each light at infinity. 0 leaves it out.
        sky_visibility: what is in the way of that light: ambient "occlusion" in screen space, the
            same from all sides, "shadow_maps", one a direction, or "none", nothing.
        shadows: of all shadow maps.
        occlusion: of the ambient occlusion.
        occlusion_samples: a pixel.
        layers: of surfaces that cover a part, by depth peeling; what lies behind further ones is
            left out.
        supersampling: samples along a side of a pixel; radiance is averaged before it is shown.
        depth_of_field: samples of the blur that the scene's lens makes, a pixel; 0 for a pinhole.
        bloom_weights: the part of the light that each level of the bloom spreads; () for none.
        bloom_threshold: radiance above which light spreads.
        aberration: relative difference of the sizes of red and blue.
        vignette: part of the natural fall of light towards the corners, 0 to 1.
        tone_curve: of the display; None shows radiance as it is.
        exposure: in stops.
        fxaa: whether edges of the display are blended afterwards.

    Raises:
        DtypeError, RangeError: a value of another kind, or out of range.
    """

    shading: Shading = "deferred"
    surface_points: int = 16
    sky_directions: int = 32
    sky_visibility: SkyVisibility = "occlusion"
    shadows: ShadowSettings = field(default_factory=ShadowSettings)
    occlusion: SsaoSettings = field(default_factory=SsaoSettings)
    occlusion_samples: int = 16
    layers: int = 8
    supersampling: int = 1
    depth_of_field: int = 0
    bloom_weights: tuple[float, ...] = ()
    bloom_threshold: float = 0.0
    aberration: float = 0.0
    vignette: float = 0.0
    tone_curve: ToneCurve | None = None
    exposure: float = 0.0
    fxaa: bool = False

    def __post_init__(self) -> None:
        require_choices(self)
        call = Arguments("FrameOptions")
        for name in ("surface_points", "sky_directions"):
            call.integer(name, getattr(self, name), low=0, high=4096)
        call.integer("occlusion_samples", self.occlusion_samples, low=1, high=256)
        call.integer("layers", self.layers, low=0, high=64)
        call.integer("supersampling", self.supersampling, low=1, high=16)
        call.integer("depth_of_field", self.depth_of_field, low=0, high=4096)
        call.number("aberration", self.aberration, above=-0.5, below=0.5)
        call.number("vignette", self.vignette, low=0.0, high=1.0)
        call.number("exposure", self.exposure, low=-64.0, high=64.0)
