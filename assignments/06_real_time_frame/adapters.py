"""Between the checks and your `real_time_frame.py`: frames of the scene.

Runs beside your file; do not change or submit it.
"""

import numpy as np
import real_time_frame as frame


def shadows(height, width, size):
    """(lit, traced, alike): sun by the shadow map and by rays; where both see one surface, in sun.

    `alike` (H, W) is the cosine toward the sun, and 0 where depths differ by a percent or more.
    """
    focal, parts = frame.ZOOM * width, frame.meshes(8)
    gbuffer = frame.draw(parts, focal, frame.POSE, height, width)
    truth = frame.traced_surfaces(focal, frame.POSE, height, width)
    lit = frame.sunlight(gbuffer, focal, frame.POSE, parts, size)
    cosine = truth["normal"] @ (frame.LIGHTS["to_sun"] @ frame.POSE[:, :3])
    near = np.minimum(gbuffer["depth"], 1e6) / np.minimum(truth["depth"], 1e6)
    alike = np.where(np.abs(near - 1) < 0.01, cosine, 0.0)
    return lit, frame.traced_sunlight(truth, focal, frame.POSE), alike


def deferred_and_forward(height, width, lit, open_sky):
    """Two layers (H, W, 4): all parts drawn, then lit; and each part drawn and lit by itself."""
    focal, parts = frame.ZOOM * width, frame.meshes(6)
    rest = focal, frame.POSE, frame.LIGHTS, lit, open_sky
    deferred = frame.light_surfaces(frame.draw(parts, *rest[:2], height, width), *rest)
    forward, nearest = np.zeros((height, width, 4)), np.full((height, width), np.inf)
    for part in parts:
        gbuffer = frame.draw([part], *rest[:2], height, width)
        layer, nearer = frame.light_surfaces(gbuffer, *rest), gbuffer["depth"] < nearest
        forward[nearer], nearest[nearer] = layer[nearer], gbuffer["depth"][nearer]
    return deferred, forward


def tuned(height, width, start, steps):
    """(settings, losses) of `tune_occlusion` for the scene, toward the traced sky."""
    focal = frame.ZOOM * width
    gbuffer = frame.draw(frame.meshes(6), focal, frame.POSE, height, width)
    truth = frame.traced_surfaces(focal, frame.POSE, height, width)
    target = frame.traced_sky(truth, focal, frame.POSE, 20)
    return frame.tune_occlusion(gbuffer["depth"], gbuffer["normal"], focal, target, start, steps)
