"""Right answers to the generated questions, worked out with the solution."""

import numpy as np


def density_of_the_middle(reference, width, depth, height, aside):
    """Density of the direction to the center of the one light."""
    corner = [-width / 2, height, -depth / 2]
    light = reference.rectangle(corner, [width, 0, 0], [0, 0, depth], emission=1.0)
    to = np.array([[-aside, height, 0.0]])
    far = np.linalg.norm(to, axis=1)
    scene = reference.assemble([light])
    return float(reference.light_pdf(scene, np.array([0]), to / far[:, None], far)[0])


def share_of_a_sample(reference, p_light, q_bsdf, value):
    """Contribution of a sample from light sampling."""
    weight = reference.mis_weight(np.array([float(p_light)]), np.array([float(q_bsdf)]))
    return float(weight[0] * value / p_light)


def radiance_of_the_room(reference, shine, albedo, depth):
    """A geometric series."""
    del reference
    return float(shine * sum(albedo**k for k in range(int(depth))))
