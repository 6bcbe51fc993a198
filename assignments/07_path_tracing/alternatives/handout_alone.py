"""Written from the handout alone, formula by formula."""

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
    larger = np.maximum(np.maximum(pdf, other), 1e-300)
    p, q = pdf / larger, other / larger
    weight = np.zeros(len(pdf))
    rows = pdf > 0
    weight[rows] = p[rows] ** 2 / (p[rows] ** 2 + q[rows] ** 2)
    return weight


def direct_light(scene, hit, u_light, u_surface, proposal=None):
    if proposal is None:
        proposal = scene
    radiance = np.zeros((len(hit["thing"]), 3))
    # A place on a light.
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
    q = np.clip(np.max(beta, axis=1), 0, 1)
    alive = u < q
    q = np.where(q > 0, q, 1)
    return beta / q[:, None] * alive[:, None], alive


def trace_paths(scene, origins, directions, depth, rng):
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
