"""Written from the handout alone, formula by formula."""

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
    front_normals,
    sample_brdf,
    sample_light,
    take,
)


def light_pdf(scene, primitive, wi, distance):
    u, v = scene["edges_u"], scene["edges_v"]
    areas = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    numbers = emitters(scene)
    pdf = np.zeros(len(primitive))
    for k in numbers:
        cosine = -(wi @ front_normals(scene)[k])
        rows = (primitive == k) & (cosine > 0)
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
    radiance = np.zeros((len(hit["primitive"]), 3))
    # A place on a light.
    wi, distance, primitive = sample_light(proposal, hit["points"], u_light)
    there = closest_hit(scene, hit["points"], wi)
    p = light_pdf(proposal, primitive, wi, distance)
    q = brdf_pdf(proposal, hit, wi)
    cosine = np.maximum(dot(hit["normals"], wi), 0)
    ok = (there["primitive"] == primitive) & (p > 0)
    weight = mis_weight(p, q) * cosine / np.where(ok, p, 1) * ok
    radiance += weight[:, None] * brdf(scene, hit, wi) * emitted(scene, there)
    # A direction of the material.
    wi = sample_brdf(proposal, hit, u_surface)
    there = closest_hit(scene, hit["points"], wi)
    p = light_pdf(proposal, there["primitive"], wi, there["t"])
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
    hit = closest_hit(scene, origins, directions)
    radiance = emitted(scene, hit)
    ray = np.arange(len(origins))
    beta = np.ones((len(origins), 3))
    for j in range(depth - 1):
        keep = hit["primitive"] >= 0
        hit, ray, beta = take(hit, keep), ray[keep], beta[keep]
        n = len(ray)
        radiance[ray] += beta * direct_light(scene, hit, rng.random((n, 3)), rng.random((n, 3)))
        wi = sample_brdf(scene, hit, rng.random((n, 3)))
        pdf = brdf_pdf(scene, hit, wi)
        keep = pdf > 0
        hit, ray, beta, wi, pdf = take(hit, keep), ray[keep], beta[keep], wi[keep], pdf[keep]
        beta = beta * brdf(scene, hit, wi) * (dot(hit["normals"], wi) / pdf)[:, None]
        if j >= ALWAYS:
            beta, keep = roulette(beta, rng.random(len(ray)))
            hit, ray, beta, wi = take(hit, keep), ray[keep], beta[keep], wi[keep]
        hit = closest_hit(scene, hit["points"], wi)
    return radiance


def direct_light_backward(scene, hit, u_light, u_surface, d_radiance):
    primitives = len(scene["roughness"])
    d_base_color, d_roughness = np.zeros((primitives, 3)), np.zeros(primitives)
    wi, distance, primitive = sample_light(scene, hit["points"], u_light)
    there = closest_hit(scene, hit["points"], wi)
    p, q = light_pdf(scene, primitive, wi, distance), brdf_pdf(scene, hit, wi)
    ok = (there["primitive"] == primitive) & (p > 0)
    weight = mis_weight(p, q) * np.maximum(dot(hit["normals"], wi), 0) / np.where(ok, p, 1) * ok
    d_f = weight[:, None] * emitted(scene, there) * d_radiance
    first = brdf_backward(scene, hit, wi, d_f)
    wi = sample_brdf(scene, hit, u_surface)
    there = closest_hit(scene, hit["points"], wi)
    p, q = light_pdf(scene, there["primitive"], wi, there["t"]), brdf_pdf(scene, hit, wi)
    ok = q > 0
    weight = mis_weight(q, p) * np.maximum(dot(hit["normals"], wi), 0) / np.where(ok, q, 1) * ok
    d_f = weight[:, None] * emitted(scene, there) * d_radiance
    second = brdf_backward(scene, hit, wi, d_f)
    for by_color, by_roughness in (first, second):
        for c in range(3):
            d_base_color[:, c] += np.bincount(hit["primitive"], by_color[:, c], primitives)
        d_roughness += np.bincount(hit["primitive"], by_roughness, primitives)
    return d_base_color, d_roughness
