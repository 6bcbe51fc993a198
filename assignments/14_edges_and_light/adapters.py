"""Between the checks and your files: a generator, and what functions of points need.

Runs beside your file; do not change or submit it.
"""

import edges_and_light as yours
import numpy as np
import path_tracing


def traced(scene, origins, directions, depth, seed):
    """`trace_paths` of your assignment 07, with a generator of this seed."""
    rng = np.random.default_rng(seed)
    return path_tracing.trace_paths(scene, origins, directions, depth, rng)


def both_passes(scene, origins, directions, depth, seed, d_radiance):
    """`replay_backward` for what `path_radiance` returns."""
    radiance = yours.path_radiance(scene, origins, directions, depth, seed)
    return yours.replay_backward(scene, origins, directions, depth, seed, radiance, d_radiance)


def sampled_edges(vertices, colors, d_image, u):
    """`edge_sampling_backward` for colors that are linear in the point.

    `colors` (2, C, 3) holds for inside and outside a constant and the slopes along x and y.
    """
    paints = [lambda points, k=k: colors[k, :, 0] + points @ colors[k, :, 1:].T for k in (0, 1)]
    return yours.edge_sampling_backward(vertices, *paints, d_image, u)


def triangle_found(picture, vertices, steps, seed):
    """The vertices that `recover_polygon` finds with your gradient."""
    return yours.recover_polygon(picture, vertices, steps, seed)[0]


def outline_found(picture, vertices, steps, seed):
    """The same for an outline of many vertices, which are kept evenly spaced."""
    return yours.recover_polygon(picture, vertices, steps, seed, 800, 0.3)[0]


def material_found(scene, origins, directions, picture, depth, steps, seed):
    """(base color, roughness) of primitive 0 that `recover_material` finds with your gradient."""
    return yours.recover_material(scene, 0, origins, directions, picture, depth, steps, seed)[:2]


def lens_found(target, cells, steps):
    """Heights of the lens that `design_caustic` finds with your gradient."""
    return yours.design_caustic(target, cells, steps)[0]
