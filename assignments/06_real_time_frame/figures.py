"""The figures of assignment 06, and the facts that their captions claim."""

import figure_parts as parts
import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, figures_of, note, subplots
from photograd_course.viz.style import BLUE, ORANGE, plain_axes


def fig1_frame(module):
    """The final frame, large, and what it is made of."""
    frame, focal = parts.small(module), module.ZOOM * parts.W
    shade = parts.occlusion(module, parts.TUNED)
    bubbles = module.meshes(8, module.BUBBLES, ())
    bubbles = module.draw(bubbles, focal, module.POSE, parts.H, parts.W)
    radiance = module.lit_frame(frame, bubbles, focal, module.POSE, frame["lit"], shade)
    shown = module.develop(radiance, parts.TONES)
    truth = parts.full_bloom(parts.traced_radiance(module))
    error = parts.rms(shown, module.encode(parts.shown_by_formula(module, truth)))
    facts = {
        "differs from the traced one by less than 0.04": Fact(
            error, 0.0, 0.04, red="light_sun_in_world"
        ),
        "something is ten times as bright as a display or more": Fact(
            radiance.max(), 10.0, 100.0, red="light_toned"
        ),
        "more than a tenth of all surfaces lose a fifth of the sky or more": Fact(
            np.mean(shade[np.isfinite(frame["depth"])] < 0.8), 0.1, 0.3, red="occlusion_summed"
        ),
    }
    whole = all(fact.holds for fact in facts.values())
    picture = (
        parts.large(module, 330, 528, 2, parts.TUNED, parts.TONES, rings=11) if whole else shown
    )
    figure = Figure(figsize=(7.0, 3.0))
    axes = parts.place(figure, (0, 0, 528, 330))
    axes.imshow(np.round(picture * 90) / 90, interpolation="nearest", aspect="auto")
    axes.set_axis_off()
    seen = np.isfinite(frame["depth"])[..., None]
    strip = (
        ("normals", np.where(seen, 0.5 + 0.5 * frame["normal"] * [1, -1, -1], 1.0)),
        ("base color", module.encode(frame["base_color"])),
        ("sun that arrives", np.repeat(frame["lit"][..., None], 3, axis=2)),
        ("sky that arrives", np.repeat(shade[..., None], 3, axis=2)),
    )
    for k, (title, each) in enumerate(strip):
        row, column = divmod(k, 2)
        axes = parts.place(figure, (538 + 118 * column, 90 + 105 * row, 113, 70))
        parts.show(axes, np.clip(each, 0, 1), title)
    return figure, facts


def fig2_raster(module):
    """Base colors: your rasterizer, traced, and the ground with two kinds of weights."""
    frame, truth = parts.small(module), parts.truth(module)[0]
    off = np.abs(frame["base_color"] - truth["base_color"]).max(axis=2) > 0.01
    points = module.in_world(truth["depth"], module.ZOOM * parts.W, module.POSE)
    near = (np.abs(points[..., 1]) < 1e-6) & (np.hypot(points[..., 0], points[..., 2]) < 3.5)
    wrong, squares = [], []
    for kind in (False, True):
        square, inside = parts.square_of_tiles(module, kind)
        off_here = np.abs(square - truth["base_color"]).max(axis=2) > 0.01
        wrong.append(off_here[near & inside & (truth["depth"] < 1e6)].mean())
        squares.append(square)
    here = parts.alike(module)
    depth = np.median(np.abs(frame["depth"][here] / truth["depth"][here] - 1))
    facts = {
        "less than 1 % of pixels show another color": Fact(
            off.mean(), 0.0, 0.01, red="raster_farthest"
        ),
        "weights in perspective give the tiles": Fact(
            wrong[0], 0.0, 0.01, red="raster_affine_weights"
        ),
        "affine weights change about half of the tiles": Fact(
            wrong[1], 0.45, 0.53, red="raster_weights_of_next_corner"
        ),
        "half of all depths agree to a ten-thousandth": Fact(
            depth, 0.0, 1e-4, red="raster_affine_depth"
        ),
    }
    mine, theirs = (module.encode(each["base_color"]) for each in (frame, truth))
    figure, panels = subplots(7.0, 3.1, 2, 3)
    parts.show(panels[0, 0], mine, "yours")
    parts.show(panels[0, 1], theirs, "traced")
    detail = np.where(off[..., None], [1.0, 0.0, 1.0], mine)[24:48, 40:79]
    title = f"yours, 3 x; different: {100 * off.mean():.1f} %"
    parts.show(panels[0, 2], detail, title)
    parts.show(panels[1, 0], module.encode(squares[1]), "two triangles, affine")
    parts.show(panels[1, 1], module.encode(squares[0]), "two triangles, with (7)")
    panels[1, 2].set_axis_off()
    return figure, facts


def fig3_shadow(module):
    """Shadows for three biases, and traced ones."""
    frame, mask = parts.small(module), parts.inside_shadows(module)
    lit, focal = parts.truth(module)[2], module.ZOOM * parts.W
    meshes = module.meshes(10)
    found, wrong = [], []
    for texels in (0.0, 2.2, 20.0):
        found.append(module.sunlight(frame, focal, module.POSE, meshes, 320, texels))
        wrong.append(float((np.abs(found[-1] - lit)[mask] > 0.5).mean()))
    facts = {
        "with a bias of 0 about a third is wrong": Fact(wrong[0], 0.25, 0.45, red="shadow_summed"),
        "with 2.2 texels less than 1 % is": Fact(wrong[1], 0.0, 0.01, red="shadow_bias_0"),
        "with 20 texels shadows are detached: more than with 2.2": Fact(
            wrong[2] > 2 * wrong[1], red="shadow_bias_0"
        ),
        "between 0 and 1 at edges of shadows": Fact(
            np.mean((found[1] > 0) & (found[1] < 1)), 0.01, 0.2, red="shadow_one_texel"
        ),
    }
    figure, panels = subplots(7.0, 1.5, 1, 4)
    for axes, texels, each in zip(panels, (0, 2.2, 20), found, strict=False):
        parts.gray(axes, each, f"bias: {texels} texels")
    parts.gray(panels[3], lit, "traced")
    return figure, facts


def fig4_light(module):
    """The frame with all light but ambient occlusion, traced, and the difference."""
    pair = parts.small(module)["radiance"], parts.traced_radiance(module)
    mine, truth = (module.encode(parts.shown_by_formula(module, each)) for each in pair)
    where, sky = parts.alike(module), parts.truth(module)[3]
    hidden = where & (sky < 0.5)
    free = where & (sky > 0.95) & parts.inside_shadows(module)
    facts = {
        "where the sky is free the two differ by less than 0.02": Fact(
            parts.rms(mine, truth, free), 0.0, 0.02, red="light_sun_in_world"
        ),
        "where more than half of it is hidden yours is lighter": Fact(
            np.mean((mine - truth)[hidden]), 0.03, 0.2, red="light_sky_white"
        ),
    }
    figure, panels = subplots(7.0, 1.85, 1, 3)
    mine, truth = mine[22:, 28:114], truth[22:, 28:114]
    parts.show(panels[0], mine, "yours, the whole sky")
    parts.show(panels[1], truth, "traced")
    parts.difference(panels[2], mine, truth, "yours minus traced", 0.3)
    return figure, facts


def fig5_display(module):
    """Bloom in both orders and tone mapping; beside the traced frame."""
    radiance, zeros = parts.small(module)["radiance"], np.zeros((parts.H, parts.W, 3))
    lens = 2.0, parts.W / 50, 0.6
    bloomed, toned = module.bloom(radiance, *lens), module.tone_map(radiance, parts.TONES, zeros)[0]
    shown = module.tone_map(bloomed, parts.TONES, zeros)[0]
    early = module.bloom(toned, *lens)
    truth = parts.full_bloom(parts.traced_radiance(module))
    truth = module.encode(parts.shown_by_formula(module, truth))
    ember = slice(45, 58), slice(100, 114)
    gray = np.linspace(0, 8, 200)[None, :, None] * np.ones(3)
    curve = module.tone_map(gray, np.array([0.0, 2.5]), 0 * gray)[0][0, :, 0]
    facts = {
        "more than a fifth of all pixels exceed 1": Fact(
            (radiance > 1).any(axis=2).mean(), 0.2, 0.9, red="light_toned"
        ),
        "white is shown as 1": Fact(
            np.interp(2.5, gray[0, :, 0], curve), 0.99, 1.01, red="tone_without_white"
        ),
        "bloom moves light and adds none": Fact(
            bloomed.sum() / radiance.sum(), 0.99, 1.0, red="bloom_added"
        ),
        "around the ember the two agree to 0.05": Fact(
            parts.rms(module.encode(shown)[ember], truth[ember]),
            0.0,
            0.05,
            red="bloom_one_direction",
        ),
        "after tone mapping less than a fifth as much is spread": Fact(
            np.abs(early - toned).sum() / np.abs(bloomed - radiance).sum(),
            0.0,
            0.2,
            red="bloom_everything",
        ),
    }
    figure = Figure(figsize=(7.0, 3.5), layout="constrained")
    panels = np.array([half.subplots(1, 3) for half in figure.subfigures(2, 1)])
    parts.show(panels[0, 0], module.encode(radiance), "cut off at 1")
    parts.show(panels[0, 1], module.encode(shown), "yours: bloom, then tone mapped")
    parts.show(panels[0, 2], truth, "traced, with the full kernel")
    parts.show(panels[1, 0], module.encode(early), "tone mapped, then bloom")
    parts.difference(panels[1, 1], module.encode(shown), truth, "yours minus traced", 0.3)
    axes = panels[1, 2]
    axes.plot(gray[0, :, 0], np.minimum(gray[0, :, 0], 1), color=ORANGE)
    axes.plot(gray[0, :, 0], curve, color=BLUE)
    axes.plot([2.5], [1], "o", color=BLUE, markersize=4)
    note(axes, "white", (2.5, 1), (4, -12), color=BLUE)
    note(axes, "cut off", (6, 1), (0, 4), color=ORANGE)
    axes.set(xlabel="luminance", ylabel="shown", ylim=(0, 2))
    plain_axes(axes)
    return figure, facts


def fig6_occlusion(module):
    """Ambient occlusion before and after descent, traced; errors on the way."""
    frame, (*_, sky), where = parts.small(module), parts.truth(module), parts.alike(module)
    what = frame["depth"], frame["normal"], module.ZOOM * parts.W, sky
    settings, losses = module.tune_occlusion(*what, parts.START, 40)
    before, after = (parts.occlusion(module, each) for each in (parts.START, settings))
    errors = [parts.rms(each, sky, where) for each in (before, after)]
    alike = np.corrcoef(after[where], sky[where])[0, 1]
    deep = where & (sky < 0.2)
    facts = {
        "descent halves the error, nearly": Fact(
            errors[1] / errors[0], 0.0, 0.6, red="occlusion_adjoint_sign"
        ),
        "the correlation is above 0.8 afterwards": Fact(
            alike, 0.8, 1.0, red="occlusion_from_below"
        ),
        "the radius grows beyond REACH": Fact(
            settings[0], module.REACH, 10.0, red="occlusion_adjoint_sign"
        ),
        "in the deepest gaps it stays too light": Fact(
            np.mean((after - sky)[deep]), 0.1, 1.0, red="occlusion_summed"
        ),
    }
    figure, panels = subplots(7.0, 1.6, 1, 4, width_ratios=(1.25, 1.25, 1.25, 1))
    parts.gray(panels[0], before, f"start: error {errors[0]:.2f}")
    parts.gray(panels[1], after, f"after descent: {errors[1]:.2f}")
    parts.gray(panels[2], sky, "traced")
    panels[3].plot(np.sqrt(losses), color=BLUE)
    panels[3].set(xlabel="step", ylabel="error", ylim=(0, None))
    plain_axes(panels[3])
    return figure, facts


FIGURES = figures_of(fig1_frame, fig2_raster, fig3_shadow, fig4_light, fig5_display, fig6_occlusion)
