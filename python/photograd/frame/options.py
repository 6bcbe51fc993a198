"""What a frame is put together from, and how."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from photograd._arrays import Arguments
from photograd._checks import require_choices
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.frame.horizon import HorizonSettings
from photograd.frame.meshlets import Culling
from photograd.frame.occlusion import SsaoSettings
from photograd.frame.screen_rays import ScreenRaySettings
from photograd.frame.shadows import ShadowSettings
from photograd.frame.tone_mapping import ToneCurve

SkyVisibility = Literal["occlusion", "horizon", "disks", "directional", "shadow_maps", "none"]
Transparency = Literal["peeled", "sorted", "weighted"]
Shading = Literal["deferred", "forward"]


@typed_call
@dataclass(frozen=True)
class FrameOptions:
    """The passes of a frame.

    Attributes:
        shading: "deferred" keeps surfaces in a G-buffer and lights them afterwards, "forward"
            lights the surfaces of each shape as it is drawn, seen in the end or not; both make the
            same picture.
        depth_prepass: whether forward shading draws depths first, and lights only what is visible.
        culling: of clusters of triangles before the camera draws them: "frustum" those outside of
            its view, which changes nothing, "facing" also those that show it their backs alone.
        surface_points: points that stand for the surfaces that emit, all together; each has a
            shadow map. 0 leaves their light out.
        sky_directions: directions that stand for each light at infinity. 0 leaves it out.
        sky_visibility: what is in the way of that light. The same from all sides: ambient
            "occlusion" in screen space, "horizon", from the horizons there, or "disks", which stand
            for all surfaces. For each direction: "directional", rays in screen space, or
            "shadow_maps". "none" hides nothing.
        shadows: of all shadow maps.
        occlusion: of the ambient occlusion.
        occlusion_samples: a pixel.
        horizon: of the occlusion from horizons.
        disk_edge: meters; faces with longer edges become several disks.
        screen_rays: of all rays in screen space.
        gather_samples: directions a pixel in which the reflectance looks for light that the frame
            shows, or for the sky behind it: screen-space irradiance and reflections; and, with
            deferred shading, for surfaces that emit. 0 for none.
        gather_frame: whether light that the frame shows is gathered; if not, that of the sky and of
            surfaces that emit alone.
        transparency: how surfaces that cover a part are blended: "peeled", exactly, "sorted" by
            shapes, or "weighted", in any order.
        layers: of such surfaces; what lies behind further ones is left out.
        fog: extinction of homogeneous fog, 1/m.
        fog_color: radiance of infinitely deep fog.
        supersampling: samples along a side of a pixel; radiance is averaged before it is shown.
        depth_of_field: samples of the blur that the scene's lens makes, a pixel; 0 for a pinhole.
        shutter: part of the time between two frames for which the shutter is open; 0 for none.
        shutter_samples: along the way of each pixel.
        temporal: weight of a frame in the mean over frames; 0 for single frames.
        bloom_weights: the part of the light that each level of the bloom spreads; () for none.
        bloom_threshold: radiance above which light spreads.
        aberration: relative difference of the sizes of red and blue.
        vignette: part of the natural fall of light towards the corners, 0 to 1.
        tone_curve: of the display; None shows radiance as it is.
        exposure: in stops.
        fxaa: whether edges of the display are blended afterwards.
        dither_levels: of the display's encoded colors, to which they are rounded after noise of one
            step; 0 for none.
        dither_seed: of that noise.

    Raises:
        DtypeError, RangeError: a value of another kind, or out of range.
    """

    shading: Shading = "deferred"
    depth_prepass: bool = False
    culling: Culling = "frustum"
    surface_points: int = 16
    sky_directions: int = 32
    sky_visibility: SkyVisibility = "occlusion"
    shadows: ShadowSettings = field(default_factory=ShadowSettings)
    occlusion: SsaoSettings = field(default_factory=SsaoSettings)
    occlusion_samples: int = 16
    horizon: HorizonSettings = field(default_factory=HorizonSettings)
    disk_edge: float = 0.1
    screen_rays: ScreenRaySettings = field(default_factory=ScreenRaySettings)
    gather_samples: int = 0
    gather_frame: bool = True
    transparency: Transparency = "peeled"
    layers: int = 8
    fog: float = 0.0
    fog_color: tuple[float, float, float] = (0.5, 0.5, 0.5)
    supersampling: int = 1
    depth_of_field: int = 0
    shutter: float = 0.0
    shutter_samples: int = 16
    temporal: float = 0.0
    bloom_weights: tuple[float, ...] = ()
    bloom_threshold: float = 0.0
    aberration: float = 0.0
    vignette: float = 0.0
    tone_curve: ToneCurve | None = None
    exposure: float = 0.0
    fxaa: bool = False
    dither_levels: int = 0
    dither_seed: int = 0

    def __post_init__(self) -> None:
        require_choices(self)
        call = Arguments("FrameOptions")
        for name in ("surface_points", "sky_directions"):
            call.integer(name, getattr(self, name), low=0, high=4096)
        call.integer("occlusion_samples", self.occlusion_samples, low=1, high=256)
        call.number("disk_edge", self.disk_edge, above=0.0)
        call.integer("gather_samples", self.gather_samples, low=0, high=4096)
        call.number("fog", self.fog, low=0.0)
        call.array("fog_color", self.fog_color, (3,), low=0.0)
        call.integer("layers", self.layers, low=0, high=64)
        call.integer("supersampling", self.supersampling, low=1, high=16)
        call.integer("depth_of_field", self.depth_of_field, low=0, high=4096)
        call.number("shutter", self.shutter, low=0.0, high=1.0)
        call.integer("shutter_samples", self.shutter_samples, low=1, high=4096)
        call.number("temporal", self.temporal, low=0.0, high=1.0)
        call.number("aberration", self.aberration, above=-0.5, below=0.5)
        call.number("vignette", self.vignette, low=0.0, high=1.0)
        call.number("exposure", self.exposure, low=-64.0, high=64.0)
        if call.integer("dither_levels", self.dither_levels, low=0, high=65536) == 1:
            raise RangeError(message("FrameOptions", "dither_levels", "0, or 2 to 65536", "1"))
        call.integer("dither_seed", self.dither_seed, low=0, high=2**64 - 1)
