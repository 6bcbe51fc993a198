"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Tolerance
from photograd_course.grading.generators import random_rotation

# Evidence: worst of the solution and three alternatives, against the nearest of all named wrong
# solutions.
EXACT = Tolerance(
    1e-10, "right ones differ by at most 9e-15, the nearest wrong one (blend_back_T_end) by 1.3e-7"
)
GATE = Tolerance(
    1e-6, "finite differences leave 1e-9, the nearest wrong one (alpha_back_held_passes) 6e-4"
)
SCENE = ("means", "log_scales", "quats", "opacity_logits", "colors")


def some_camera(rng):
    """A camera anywhere, whose pictures are not square."""
    pose = np.concatenate([random_rotation(rng), rng.normal(size=(3, 1))], axis=1)
    return {
        "camera_from_world": pose,
        "focal": np.array([18.0, 22.0]),
        "center": np.array([9.0, 8.0]),
        "width": 20,
        "height": 14,
    }


def in_world(camera, t):
    """Points of the camera's frame, in the world."""
    pose = camera["camera_from_world"]
    return (t - pose[:, 3]) @ pose[:, :3]


def ahead(rng, n):
    """Points in front of the camera that it sees, no two equally deep; (n, 3)."""
    z = 2.0 + 0.25 * rng.permutation(n)
    side = rng.uniform(-0.25, 0.25, (n, 2))
    return np.concatenate([side * z[:, None], z[:, None]], axis=1)


def spread(t, q, s):
    """The values of `covariance`."""
    return t.call("adapters.covariance", q, s, returns=Array((len(q), 3, 3)))


EARLIER = ("covariance", "project", "screen_alpha", "composite_splats")


def some_scene(rng, camera, n, size=0.8):
    """Gaussians that the middle of the picture sees, none of them clamped or dropped there."""
    return {
        "means": in_world(camera, ahead(rng, n) * [0.5, 0.5, 1]),
        "log_scales": np.log(size) + rng.uniform(-0.3, 0.3, (n, 3)),
        "quats": rng.normal(size=(n, 4)),
        "opacity_logits": rng.uniform(-1.0, 1.0, n),
        "colors": rng.uniform(0.0, 1.0, (n, 3)),
    }
