"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from photograd_course.viz.handout import subplots


def _ring_rays(module, width, height, focal):
    """Rays of a camera above the ring that looks down."""
    pose = np.array([[1, 0, 0, 0], [0, -0.8, -0.6, 3.3], [0, 0.6, -0.8, 4.4]])
    return module.camera_rays(width, height, focal, focal, width / 2, height / 2, pose)


def draw(module):
    """A ball of glass over a floor, and a ring of triangles, by your functions."""
    width, height, radius = 300, 216, 1.2
    level = np.array([[1, 0, 0, 0], [0, -1, 0, 0.3], [0, 0, -1, 3.6]])
    center = np.array([0.0, 0.3, 0.0])
    place, way = module.camera_rays(width, height, 210.0, 210.0, width / 2, height / 2, level)
    inside, touched = np.zeros(len(way), bool), np.zeros(len(way), bool)
    for bounce in range(4):
        t = module.hit_sphere(place, way, center, radius)
        on = np.isfinite(t) & (inside | (bounce == 0))
        place[on] += t[on, None] * way[on]
        way[on], through = module.refract(way[on], (place[on] - center) / radius, 1.5)
        inside[on] ^= through
        touched |= on
    glass = np.clip(module.floor_and_sky(place, way), 0, 1).reshape(height, width, 3)
    blue = (glass[..., 2] - glass[..., 0]).reshape(2, -1)
    upper, lower = (blue[k, half].mean() for k, half in enumerate(touched.reshape(2, -1)))
    ring, across, down = module.ring(24, 12), 120, 86
    origins, ways = _ring_rays(module, across, down, 80.0)
    t, number = module.trace_mesh(ring, origins, ways)
    a, b, c = np.moveaxis(ring, 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    shade = 0.15 + 0.85 * np.abs(np.sum(normal[number] * ways, axis=1))
    shade[number < 0] = 1.0
    claims = {
        "every ray leaves the ball": not inside.any() and touched.any(),
        "in the ball the sky is below": lower - upper,
        "the ring is hit": np.isfinite(t).mean(),
    }
    figure, (left, right) = subplots(7.0, 2.75, 1, 2)
    left.imshow(np.round(glass * 40) / 40)
    right.imshow(shade.reshape(down, across), cmap="gray", vmin=0, vmax=1)
    left.set(xticks=[], yticks=[], title="a ball of glass")
    right.set(xticks=[], yticks=[], title=f"{len(ring)} triangles")
    return figure, claims
