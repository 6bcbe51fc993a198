"""Options of `photograd frame`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

from photograd._checks import typed
from photograd.commands.shared import out_option
from photograd.errors import RangeError, message
from photograd.frame.meshlets import Culling
from photograd.frame.options import FrameOptions, Shading, SkyVisibility, Transparency
from photograd.frame.panels import PANELS
from photograd.frame.shadows import ShadowSettings
from photograd.frame.tone_mapping import TONE_CURVES, ToneCurve

OutOption = Annotated[
    Path, out_option("The picture: .exr, .hdr or .pfm of radiance, with a .png beside it, or .png.")
]
ShowOption = Annotated[
    list[str] | None,
    typer.Option(
        "--show",
        metavar="BUFFER",
        help="Write a buffer beside the picture, the passes as a 'graph', or 'all': "
        f"{', '.join(PANELS)}. May be repeated.",
    ),
]
AgainstOption = Annotated[
    str, typer.Option("--against", help="'path' compares each kind of light with path tracing.")
]
ShadingOption = Annotated[str, typer.Option("--shading", help="deferred or forward.")]
PrepassOption = Annotated[
    bool,
    typer.Option(
        "--depth-prepass", help="Forward shading draws depths first, lights what is seen."
    ),
]
CullingOption = Annotated[
    str,
    typer.Option(
        "--culling",
        help="Clusters of triangles that are left out: none; frustum, what is outside of the view; "
        "facing, also what turns its back.",
    ),
]
DetailOption = Annotated[
    float,
    typer.Option(
        "--detail", min=0.0, help="Pixels by which coarser meshes may be off; 0 keeps all."
    ),
]
SkyOption = Annotated[
    str,
    typer.Option(
        "--sky-visibility", help=f"What hides the sky: {', '.join(get_args(SkyVisibility))}."
    ),
]
GatherOption = Annotated[
    int,
    typer.Option(
        "--gather", min=0, help="Directions a pixel in which the frame and the sky are gathered."
    ),
]
TransparencyOption = Annotated[
    str,
    typer.Option(
        "--transparency",
        help=f"How what covers in part is blended: {', '.join(get_args(Transparency))}.",
    ),
]
FogOption = Annotated[float, typer.Option("--fog", min=0.0, help="Extinction of fog, 1/m.")]
FogColorOption = Annotated[
    str, typer.Option("--fog-color", metavar="R,G,B", help="Radiance of infinitely deep fog.")
]
PointsOption = Annotated[
    int, typer.Option("--surface-points", min=0, help="Points that stand for surfaces that emit.")
]
DirectionsOption = Annotated[
    int, typer.Option("--sky-directions", min=0, help="Directions that stand for a sky.")
]
ShadowSizeOption = Annotated[
    int, typer.Option("--shadow-size", min=1, max=16384, help="Texels of a shadow map's edge.")
]
SupersamplingOption = Annotated[
    int, typer.Option("--supersampling", min=1, max=16, help="Samples along a pixel's edge.")
]
ToneOption = Annotated[str, typer.Option("--tone-curve", help=f"none, {', '.join(TONE_CURVES)}.")]
ExposureOption = Annotated[float, typer.Option("--exposure", help="In stops.")]
BloomOption = Annotated[
    float, typer.Option("--bloom", min=0.0, max=1.0, help="Part of the light that spreads.")
]
FocusOption = Annotated[
    int,
    typer.Option("--depth-of-field", min=0, help="Samples of the lens's blur a pixel; 0 for none."),
]
AberrationOption = Annotated[
    float, typer.Option("--aberration", help="Relative difference of the sizes of red and blue.")
]
VignetteOption = Annotated[
    float, typer.Option("--vignette", min=0.0, max=1.0, help="Part of the natural vignetting.")
]
FxaaOption = Annotated[bool, typer.Option("--fxaa", help="Blend across edges afterwards.")]
DitherOption = Annotated[
    bool, typer.Option("--dither", help="Noise of one step in the .png, against bands.")
]


CHOICES = {
    "shading": Shading,
    "culling": Culling,
    "sky_visibility": SkyVisibility,
    "transparency": Transparency,
}
SAME = (
    *(
        "depth_prepass",
        "surface_points",
        "sky_directions",
        "fog",
        "supersampling",
        "exposure",
        "depth_of_field",
    ),
    *("aberration", "vignette", "fxaa"),
)
"""Named alike in `FrameOptions`."""
BLOOM_LEVELS = 6


def options_of(given: Mapping[str, Any]) -> FrameOptions:
    """The options of a frame, from those of the command.

    Args:
        given: the command's parameters, by name.

    Raises:
        RangeError: a choice that there is not, or numbers out of range.
    """
    chosen = {
        name: typed("frame", f"--{name.replace('_', '-')}", choices, given[name])
        for name, choices in CHOICES.items()
    }
    curve, bloom = given["tone_curve"], given["bloom"]
    if curve != "none":
        chosen["tone_curve"] = typed("frame", "--tone-curve", ToneCurve, curve)
    return FrameOptions(
        **chosen,
        **{name: given[name] for name in SAME},
        shadows=ShadowSettings(size=given["shadow_size"]),
        gather_samples=given["gather"],
        fog_color=_three_numbers("--fog-color", given["fog_color"]),
        bloom_weights=(bloom / BLOOM_LEVELS,) * BLOOM_LEVELS if bloom else (),
        dither_levels=256 if given["dithered"] else 0,
        dither_seed=given["seed"],
    )


def _three_numbers(option: str, text: str) -> tuple[float, float, float]:
    try:
        red, green, blue = (float(part) for part in text.split(","))
    except ValueError as failure:
        raise RangeError(message("frame", option, "three numbers R,G,B", text)) from failure
    return red, green, blue
