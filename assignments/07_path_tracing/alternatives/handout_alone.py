"""Written from the handout alone, formula by formula."""

from __future__ import annotations

import numpy as np
from path_tracing import (
    ALWAYS,
    brdf,
    brdf_backward,
    brdf_pdf,
    dot,
    emitted,
    front_normals,
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
    u, v = scene["edges_u"], scene["edges_v"]
    areas = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    numbers = lamps(scene)
    pdf = np.zeros(len(thing))
    for k in numbers:
        cosine = -(wi @ front_normals(scene)[k])
        rows = (thing == k) & (cosine > 0)
        pdf[rows] = 1 / (len(numbers) * areas[k]) * distance[rows] ** 2 / cosine[rows]
    return pdf


def mis_weight(pdf, other):
    """How much a sample of one strategy counts, when another could have drawn it as well.

    Args:
        pdf: (N,), the density of the strategy that has drawn it, 0 or more, in 1/sr.
        other: (N,), that of the other one, likewise. Both go from 0 to 1e200.

    Returns:
        (N,), 0 to 1, by the power heuristic: handout equation (7). 0 where `pdf` is 0.
    """
    larger = np.maximum(np.maximum(pdf, other), 1e-300)
    p, q = pdf / larger, other / larger
    weight = np.zeros(len(pdf))
    rows = pdf > 0
    weight[rows] = p[rows] ** 2 / (p[rows] ** 2 + q[rows] ** 2)
    return weight


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
    if proposal is None:
        proposal = scene
    radiance = np.zeros((len(hit["thing"]), 3))
    # A place on a lamp.
    wi, distance, thing = sample_light(proposal, hit["points"], u_light)
    there = see(scene, hit["points"], wi)
    p = light_pdf(proposal, thing, wi, distance)
    q = brdf_pdf(proposal, hit, wi)
    cosine = np.maximum(dot(hit["normals"], wi), 0)
    ok = (there["thing"] == thing) & (p > 0)
    weight = mis_weight(p, q) * cosine / np.where(ok, p, 1) * ok
    radiance += weight[:, None] * brdf(scene, hit, wi) * emitted(scene, there)
    # A direction of the material.
    wi = sample_brdf(proposal, hit, u_surface)
    there = see(scene, hit["points"], wi)
    p = light_pdf(proposal, there["thing"], wi, there["t"])
    q = brdf_pdf(proposal, hit, wi)
    cosine = np.maximum(dot(hit["normals"], wi), 0)
    ok = q > 0
    weight = mis_weight(q, p) * cosine / np.where(ok, q, 1) * ok
    radiance += weight[:, None] * brdf(scene, hit, wi) * emitted(scene, there)
    return radiance


def roulette(beta, u):
    """End paths that carry little; let the others carry more for it.

    Args:
        beta: (N, 3), what a path's light is multiplied with on its way to the viewer, 0 or more.
        u: (N,), uniform in [0, 1).

    Returns:
        (beta (N, 3), alive (N,) of bool): the new factors, zeros where the path has ended, and
        which paths go on. Handout equations (11) and (12).
    """
    q = np.clip(np.max(beta, axis=1), 0, 1)
    alive = u < q
    q = np.where(q > 0, q, 1)
    return beta / q[:, None] * alive[:, None], alive


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
    hit = see(scene, origins, directions)
    radiance = emitted(scene, hit)
    ray = np.arange(len(origins))
    beta = np.ones((len(origins), 3))
    for j in range(depth - 1):
        keep = hit["thing"] >= 0
        hit, ray, beta = some(hit, keep), ray[keep], beta[keep]
        n = len(ray)
        radiance[ray] += beta * direct_light(scene, hit, rng.random((n, 3)), rng.random((n, 3)))
        wi = sample_brdf(scene, hit, rng.random((n, 3)))
        pdf = brdf_pdf(scene, hit, wi)
        keep = pdf > 0
        hit, ray, beta, wi, pdf = some(hit, keep), ray[keep], beta[keep], wi[keep], pdf[keep]
        beta = beta * brdf(scene, hit, wi) * (dot(hit["normals"], wi) / pdf)[:, None]
        if j >= ALWAYS:
            beta, keep = roulette(beta, rng.random(len(ray)))
            hit, ray, beta, wi = some(hit, keep), ray[keep], beta[keep], wi[keep]
        hit = see(scene, hit["points"], wi)
    return radiance


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
    things = len(scene["roughness"])
    d_base_color, d_roughness = np.zeros((things, 3)), np.zeros(things)
    wi, distance, thing = sample_light(scene, hit["points"], u_light)
    there = see(scene, hit["points"], wi)
    p, q = light_pdf(scene, thing, wi, distance), brdf_pdf(scene, hit, wi)
    ok = (there["thing"] == thing) & (p > 0)
    weight = mis_weight(p, q) * np.maximum(dot(hit["normals"], wi), 0) / np.where(ok, p, 1) * ok
    d_f = weight[:, None] * emitted(scene, there) * d_radiance
    first = brdf_backward(scene, hit, wi, d_f)
    wi = sample_brdf(scene, hit, u_surface)
    there = see(scene, hit["points"], wi)
    p, q = light_pdf(scene, there["thing"], wi, there["t"]), brdf_pdf(scene, hit, wi)
    ok = q > 0
    weight = mis_weight(q, p) * np.maximum(dot(hit["normals"], wi), 0) / np.where(ok, q, 1) * ok
    d_f = weight[:, None] * emitted(scene, there) * d_radiance
    second = brdf_backward(scene, hit, wi, d_f)
    for by_color, by_roughness in (first, second):
        for c in range(3):
            d_base_color[:, c] += np.bincount(hit["thing"], by_color[:, c], things)
        d_roughness += np.bincount(hit["thing"], by_roughness, things)
    return d_base_color, d_roughness
