"""Two explicit blocks that only look at lit rows; paths by recursion; sums by matrices."""

import numpy as np
from path_tracing import (
    ALWAYS,
    brdf,
    brdf_backward,
    brdf_pdf,
    closest_hit,
    dot,
    emitted,
    emitters,
    sample_brdf,
    sample_light,
    take,
)


def light_pdf(scene, primitive, wi, distance):
    cross = np.cross(scene["edges_u"], scene["edges_v"])  # as long as the area
    flat = len(cross)
    shines = np.zeros(len(scene["matte"]), bool)
    shines[emitters(scene)] = True
    wanted = (primitive >= 0) & shines[primitive]
    seen_area = np.zeros(len(primitive))
    index = np.where(wanted & (primitive < flat), primitive, 0)
    seen_area[wanted] = -np.einsum("ni,ni->n", wi, cross[index])[wanted]
    wanted &= seen_area > 0
    return (
        np.where(
            wanted, np.where(wanted, distance, 0.0) ** 2 / np.where(wanted, seen_area, 1.0), 0.0
        )
        / shines.sum()
    )


def mis_weight(pdf, other):
    with np.errstate(divide="ignore", over="ignore"):
        ratio = np.where(pdf > 0, other / np.where(pdf > 0, pdf, 1.0), np.inf)
        ratio = np.minimum(ratio, 1e150)
        return np.where(pdf > 0, 1 / (1 + ratio * ratio), 0.0)


def direct_light(scene, hit, u_light, u_surface, proposal=None):
    chooser = proposal or scene
    sent = np.zeros((len(hit["primitive"]), 3))

    def add(rows, wi, there, numerator, denominator):
        part, seen = take(hit, rows), take(there, rows)
        c = dot(part["normals"], wi[rows])
        weight = mis_weight(numerator[rows], denominator[rows]) * c / numerator[rows]
        sent[rows] += brdf(scene, part, wi[rows]) * emitted(scene, seen) * weight[:, None]

    wi, _, light = sample_light(chooser, hit["points"], u_light)
    there = closest_hit(scene, hit["points"], wi)
    p, q = light_pdf(chooser, there["primitive"], wi, there["t"]), brdf_pdf(chooser, hit, wi)
    add(np.flatnonzero((there["primitive"] == light) & (p > 0) & (q > 0)), wi, there, p, q)
    wi = sample_brdf(chooser, hit, u_surface)
    there = closest_hit(scene, hit["points"], wi)
    p, q = light_pdf(chooser, there["primitive"], wi, there["t"]), brdf_pdf(chooser, hit, wi)
    add(np.flatnonzero((p > 0) & (q > 0)), wi, there, q, p)
    return sent


def roulette(beta, u):
    brightest = np.max(beta, axis=1)
    chance = np.where(brightest < 1, brightest, 1.0)
    alive = chance > u
    after = np.zeros(beta.shape)
    after[alive] = beta[alive] / chance[alive, None]
    return after, alive


def trace_paths(scene, origins, directions, depth, rng):

    def arriving(hit, beta, bounce):
        """What leaves these places to where they are seen from, by reflection, times beta."""
        if bounce == depth - 1 or len(beta) == 0:
            return np.zeros((len(beta), 3))
        n = len(beta)
        total = beta * direct_light(scene, hit, rng.random((n, 3)), rng.random((n, 3)))
        wi = sample_brdf(scene, hit, rng.random((n, 3)))
        pdf, c = brdf_pdf(scene, hit, wi), dot(wi, hit["normals"])
        good = pdf > 0
        beta = beta * brdf(scene, hit, wi) * np.where(good, c / np.where(good, pdf, 1), 0)[:, None]
        if bounce >= ALWAYS:
            beta, alive = roulette(beta, rng.random(n))
            good &= alive
        there = closest_hit(scene, hit["points"], wi)
        good &= there["primitive"] >= 0
        total[good] += arriving(take(there, good), beta[good], bounce + 1)
        return total

    first = closest_hit(scene, origins, directions)
    result = emitted(scene, first)
    met = first["primitive"] >= 0
    result[met] += arriving(take(first, met), np.ones((met.sum(), 3)), 0)
    return result


def direct_light_backward(scene, hit, u_light, u_surface, d_radiance):
    colors, roughs, primitives = [], [], []

    def add(rows, wi, there, numerator, denominator):
        part, seen = take(hit, rows), take(there, rows)
        c = dot(part["normals"], wi[rows])
        weight = mis_weight(numerator[rows], denominator[rows]) * c / numerator[rows]
        pull = d_radiance[rows] * emitted(scene, seen) * weight[:, None]
        by_color, by_roughness = brdf_backward(scene, part, wi[rows], pull)
        colors.append(by_color)
        roughs.append(by_roughness)
        primitives.append(part["primitive"])

    wi, _, light = sample_light(scene, hit["points"], u_light)
    there = closest_hit(scene, hit["points"], wi)
    p, q = light_pdf(scene, there["primitive"], wi, there["t"]), brdf_pdf(scene, hit, wi)
    add(np.flatnonzero((there["primitive"] == light) & (p > 0) & (q > 0)), wi, there, p, q)
    wi = sample_brdf(scene, hit, u_surface)
    there = closest_hit(scene, hit["points"], wi)
    p, q = light_pdf(scene, there["primitive"], wi, there["t"]), brdf_pdf(scene, hit, wi)
    add(np.flatnonzero((p > 0) & (q > 0)), wi, there, q, p)
    belongs = np.arange(len(scene["matte"]))[:, None] == np.concatenate(primitives)
    return belongs @ np.concatenate(colors), belongs @ np.concatenate(roughs)
