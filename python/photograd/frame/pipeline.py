"""The passes of a frame, as a graph: what `photograd frame` runs.

    scene = FrameScene(builtin_scene("cornell-box"))
    frame = frame_graph(scene, FrameOptions(tone_curve="agx")).run({"camera": scene.scene.camera})
    frame["display"]  # (H, W, 3), linear

Buffers, in the order in which they are made:

    samples         the camera with several pixels in the place of one
    visibility      of what covers whole, and
    gbuffer         its surfaces
    shadows         shadow maps of the lights
    occlusion       of the sky
    direct          light of points, spots, directions and surfaces that emit
    sky_light       light of the sky, of environment maps and suns
    gathered        light that surfaces reflect of the frame, and of the sky behind it
    background      radiance behind everything, where no surface is
    opaque          all of these
    layered         with surfaces before it that cover in part
    fogged          seen through fog
    focused         blurred by the depth of field
    velocity        pixels since the last frame, with motion blur or temporal antialiasing
    blurred         by motion while the shutter is open
    radiance        of the pixels
    accumulated     the mean over frames; with it, history: what the next frame goes on with
    bloom, lens     with bloom; with the lens's aberration and vignette
    toned, smoothed tone mapped; with edges blended
    display         the same, dithered where options ask for it

Motion needs a second input, "last": the `LastFrame`.
"""

from __future__ import annotations

from photograd._typed import typed_call
from photograd.frame._light_passes import LightPasses
from photograd.frame._post_passes import PostPasses
from photograd.frame.graph import Pass, PassGraph
from photograd.frame.options import FrameOptions
from photograd.frame.scene import FrameScene


@typed_call
def frame_graph(scene: FrameScene, options: FrameOptions) -> PassGraph:
    """The passes that make a picture of a scene.

    Args:
        scene: that is drawn; its numbers may change between runs, its lights stay where they are.
        options: which passes, and how.

    Returns:
        A graph with the input "camera", and "last" where options ask for motion, and the buffers
        above.

    Raises:
        RangeError: what an option's settings refuse.
    """
    moves = options.shutter > 0 or options.temporal > 0
    light, post = LightPasses(scene, options), PostPasses(scene, options)
    inputs = ["camera", "last"] if moves else ["camera"]
    return PassGraph([*_lit(light, post, tuple(inputs)), *_shown(post, moves)], inputs)


def _lit(light: LightPasses, post: PostPasses, inputs: tuple[str, ...]) -> list[Pass]:
    surfaces = ("gbuffer", "visibility")
    sums = ("gbuffer", "direct", "sky_light", "gathered", "background")
    return [
        Pass("samples", post.samples, inputs, ("samples",)),
        Pass("surfaces", light.surfaces, ("samples",), ("visibility", "gbuffer")),
        Pass("shadows", light.shadows, (), ("shadows",)),
        Pass("occlusion", light.occlusion, ("gbuffer",), ("occlusion",)),
        Pass("direct", light.direct, (*surfaces, "shadows"), ("direct",)),
        Pass("sky light", light.sky_light, ("gbuffer", "shadows", "occlusion"), ("sky_light",)),
        Pass("gather", light.gather, ("gbuffer", "direct", "sky_light", "shadows"), ("gathered",)),
        Pass("background", light.background, ("samples", "gbuffer"), ("background",)),
        Pass("opaque", light.opaque, sums, ("opaque",)),
        Pass("layers", light.layers, ("samples", "visibility", "opaque", "shadows"), ("layered",)),
    ]


def _shown(post: PostPasses, moves: bool) -> list[Pass]:
    passes = [
        Pass("fog", post.fog, ("samples", "visibility", "layered"), ("fogged",)),
        Pass("focus", post.focus, ("samples", "visibility", "fogged"), ("focused",)),
    ]
    whole = "radiance"
    if moves:
        whole = "accumulated"
        passes += [
            Pass("velocity", post.velocity, ("gbuffer", "visibility", "last"), ("velocity",)),
            Pass("motion blur", post.motion_blur, ("focused", "velocity"), ("blurred",)),
            Pass("resolve", post.resolve, ("blurred",), ("radiance",)),
            Pass(
                "accumulate",
                post.accumulate,
                ("radiance", "velocity", "last"),
                ("accumulated", "history"),
            ),
        ]
    else:
        passes.append(Pass("resolve", post.resolve, ("focused",), ("radiance",)))
    return [
        *passes,
        Pass("bloom", post.bloom, (whole,), ("bloom",)),
        Pass("lens", post.lens, ("camera", "bloom"), ("lens",)),
        Pass("tone map", post.tone_map, ("lens",), ("toned",)),
        Pass("fxaa", post.fxaa, ("toned",), ("smoothed",)),
        Pass("dither", post.dither, ("smoothed",), ("display",)),
    ]
