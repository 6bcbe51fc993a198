"""Two explicit blocks that only look at lit rows; paths by recursion; sums by matrices."""

from __future__ import annotations

import numpy as np
from path_tracing import (
    ALWAYS,
    brdf,
    brdf_backward,
    brdf_pdf,
    dot,
    emitted,
    lamps,
    sample_brdf,
    sample_light,
    see,
    some,
)


def light_pdf(scene, thing, wi, distance):
    """How densely `sample_light` draws directions, by solid angle.

    Args:
        scene: with K lamps.
        thing: (N,), what lies in the direction wi; -1 for nothing.
        wi: (N, 3), from the point towards it.
        distance: (N,), how far away it is, in meters.

    Returns:
        (N,), in 1/sr; exactly 0 where the thing is no lamp, or its front is not seen. Handout
        equations (5) and (6).
    """
    cross = np.cross(scene["edges_u"], scene["edges_v"])  # as long as the area
    flat = len(cross)
    shines = np.zeros(len(scene["matte"]), bool)
    shines[lamps(scene)] = True
    wanted = (thing >= 0) & shines[thing]
    seen_area = np.zeros(len(thing))
    index = np.where(wanted & (thing < flat), thing, 0)
    seen_area[wanted] = -np.einsum("ni,ni->n", wi, cross[index])[wanted]
    wanted &= seen_area > 0
    return (
        np.where(
            wanted, np.where(wanted, distance, 0.0) ** 2 / np.where(wanted, seen_area, 1.0), 0.0
        )
        / shines.sum()
    )


def mis_weight(pdf, other):
    """How much a sample of one strategy counts, when another could have drawn it as well.

    Args:
        pdf: (N,), the density of the strategy that has drawn it, 0 or more, in 1/sr.
        other: (N,), that of the other one, likewise. Both go from 0 to 1e200.

    Returns:
        (N,), 0 to 1, by the power heuristic: handout equation (7). 0 where `pdf` is 0.
    """
    with np.errstate(divide="ignore", over="ignore"):
        ratio = np.where(pdf > 0, other / np.where(pdf > 0, pdf, 1.0), np.inf)
        ratio = np.minimum(ratio, 1e150)
        return np.where(pdf > 0, 1 / (1 + ratio * ratio), 0.0)


def direct_light(scene, hit, u_light, u_surface, proposal=None):
    """The light that comes straight from lamps and leaves the surface to the viewer.

    Args:
        scene: with at least one lamp.
        hit: N places; something is seen in every row.
        u_light: (N, 3), for `sample_light`: one direction for each row.
        u_surface: (N, 3), for `sample_brdf`: another one.
        proposal: the scene by which directions, densities and weights are made; None for `scene`
            itself. Both scenes have the same shapes and lamps, materials may differ. What is seen
            along a direction, and how the surface reflects it, is always that of `scene`.

    Returns:
        (N, 3), an estimate of the radiance, what the place emits by itself not included. Handout
        equations (8) to (10).
    """
    chooser = proposal or scene
    sent = np.zeros((len(hit["thing"]), 3))

    def add(rows, wi, there, numerator, denominator):
        part, seen = some(hit, rows), some(there, rows)
        c = dot(part["normals"], wi[rows])
        weight = mis_weight(numerator[rows], denominator[rows]) * c / numerator[rows]
        sent[rows] += brdf(scene, part, wi[rows]) * emitted(scene, seen) * weight[:, None]

    wi, _, lamp = sample_light(chooser, hit["points"], u_light)
    there = see(scene, hit["points"], wi)
    p, q = light_pdf(chooser, there["thing"], wi, there["t"]), brdf_pdf(chooser, hit, wi)
    add(np.flatnonzero((there["thing"] == lamp) & (p > 0) & (q > 0)), wi, there, p, q)
    wi = sample_brdf(chooser, hit, u_surface)
    there = see(scene, hit["points"], wi)
    p, q = light_pdf(chooser, there["thing"], wi, there["t"]), brdf_pdf(chooser, hit, wi)
    add(np.flatnonzero((p > 0) & (q > 0)), wi, there, q, p)
    return sent


def roulette(beta, u):
    """End paths that carry little; let the others carry more for it.

    Args:
        beta: (N, 3), what a path's light is multiplied with on its way to the viewer, 0 or more.
        u: (N,), uniform in [0, 1).

    Returns:
        (beta (N, 3), alive (N,) of bool): the new factors, zeros where the path has ended, and
        which paths go on. Handout equations (11) and (12).
    """
    brightest = np.max(beta, axis=1)
    chance = np.where(brightest < 1, brightest, 1.0)
    alive = chance > u
    after = np.zeros(beta.shape)
    after[alive] = beta[alive] / chance[alive, None]
    return after, alive


def trace_paths(scene, origins, directions, depth, rng):
    """The radiance that comes along rays, light over several surfaces included.

    Args:
        scene: with at least one lamp.
        origins, directions: (N, 3), of the viewer's rays; unit directions.
        depth: 1 or more: how many straight pieces a path may have, from the lamp to the viewer.
            1 is what things emit towards the viewer, 2 has direct light as well, and so on.
        rng: a generator; each ray gets random numbers of its own.

    Returns:
        (N, 3), one estimate for each ray; 0 where a ray sees nothing. Handout equations (13) to
        (15).
    """

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
        there = see(scene, hit["points"], wi)
        good &= there["thing"] >= 0
        total[good] += arriving(some(there, good), beta[good], bounce + 1)
        return total

    first = see(scene, origins, directions)
    result = emitted(scene, first)
    met = first["thing"] >= 0
    result[met] += arriving(some(first, met), np.ones((met.sum(), 3)), 0)
    return result


def direct_light_backward(scene, hit, u_light, u_surface, d_radiance):
    """The adjoint of `direct_light`, by what things are made of.

    Directions, densities and weights are held fixed: it is the derivative of
    `direct_light(scene, hit, u_light, u_surface, proposal)` by `scene` alone, where `proposal` is a
    copy of `scene` that stays as it is.

    Args:
        scene, hit, u_light, u_surface: as for `direct_light`.
        d_radiance: (N, 3), the derivative of some loss by each number that `direct_light` returned.

    Returns:
        (d_base_color (T, 3), d_roughness (T,)), one row for each thing of the scene, zero for
        things that the hit does not contain. Handout equations (16) to (18).
    """
    colors, roughs, things = [], [], []

    def add(rows, wi, there, numerator, denominator):
        part, seen = some(hit, rows), some(there, rows)
        c = dot(part["normals"], wi[rows])
        weight = mis_weight(numerator[rows], denominator[rows]) * c / numerator[rows]
        pull = d_radiance[rows] * emitted(scene, seen) * weight[:, None]
        by_color, by_roughness = brdf_backward(scene, part, wi[rows], pull)
        colors.append(by_color)
        roughs.append(by_roughness)
        things.append(part["thing"])

    wi, _, lamp = sample_light(scene, hit["points"], u_light)
    there = see(scene, hit["points"], wi)
    p, q = light_pdf(scene, there["thing"], wi, there["t"]), brdf_pdf(scene, hit, wi)
    add(np.flatnonzero((there["thing"] == lamp) & (p > 0) & (q > 0)), wi, there, p, q)
    wi = sample_brdf(scene, hit, u_surface)
    there = see(scene, hit["points"], wi)
    p, q = light_pdf(scene, there["thing"], wi, there["t"]), brdf_pdf(scene, hit, wi)
    add(np.flatnonzero((p > 0) & (q > 0)), wi, there, q, p)
    belongs = np.arange(len(scene["matte"]))[:, None] == np.concatenate(things)
    return belongs @ np.concatenate(colors), belongs @ np.concatenate(roughs)
