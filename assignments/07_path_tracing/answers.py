"""Right answers to the generated questions, worked out with the solution."""

import numpy as np


def density_of_the_middle(reference, width, depth, height, aside):
    """Of the direction to the middle of the one lamp."""
    corner = [-width / 2, height, -depth / 2]
    lamp = reference.rectangle(corner, [width, 0, 0], [0, 0, depth], emission=1.0)
    to = np.array([[-aside, height, 0.0]])
    far = np.linalg.norm(to, axis=1)
    scene = reference.assemble([lamp])
    return float(reference.light_pdf(scene, np.array([0]), to / far[:, None], far)[0])


def share_of_a_sample(reference, lamp, material, value):
    """What a sample adds that the lamp has drawn."""
    weight = reference.mis_weight(np.array([float(lamp)]), np.array([float(material)]))
    return float(weight[0] * value / lamp)


def radiance_of_the_room(reference, shine, albedo, depth):
    """A geometric series; asked of the solution only which lamps the room would have."""
    del reference
    return float(shine * sum(albedo**k for k in range(int(depth))))
