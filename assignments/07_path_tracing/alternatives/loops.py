"""Loops over single rows where that is cheap; one strategy after the other."""

import numpy as np
from path_tracing import (
    ALWAYS,
    brdf,
    brdf_backward,
    brdf_pdf,
    closest_hit,
    emitted,
    emitters,
    sample_brdf,
    sample_light,
    take,
)


def light_pdf(scene, primitive, wi, distance):
    shining = emitters(scene)
    out = np.zeros(len(primitive))
    for what in shining:
        normal = np.cross(scene["edges_u"][what], scene["edges_v"][what])
        size = np.sqrt(normal @ normal)
        c = -(wi @ normal) / size
        for n in np.flatnonzero((primitive == what) & (c > 0)):
            out[n] = distance[n] * distance[n] / c[n] / size / len(shining)
    return out


def mis_weight(pdf, other):
    out = np.zeros(len(pdf))
    for n in range(len(pdf)):
        p, q = float(pdf[n]), float(other[n])
        if p >= q and p > 0:
            out[n] = 1 / (1 + (q / p) ** 2)
        elif p > 0:
            out[n] = (p / q) ** 2 / (1 + (p / q) ** 2)
    return out


def direct_light(scene, hit, u_light, u_surface, proposal=None):
    if proposal is None:
        proposal = scene
    points, normals = hit["points"], hit["normals"]

    def one(direction, wanted):
        there = closest_hit(scene, points, direction)
        p_light = light_pdf(proposal, there["primitive"], direction, there["t"])
        p_surface = brdf_pdf(proposal, hit, direction)
        if wanted is None:
            weight, p = mis_weight(p_surface, p_light), p_surface
        else:
            weight, p = mis_weight(p_light, p_surface), p_light
            weight = weight * (there["primitive"] == wanted)
        value = brdf(scene, hit, direction) * emitted(scene, there)
        c = np.sum(direction * normals, axis=1)
        good = (p > 0) & (c > 0) & (p_light > 0)
        scale = np.zeros(len(c))
        scale[good] = weight[good] * c[good] / p[good]
        return value * scale[:, None]

    direction, _, wanted = sample_light(proposal, points, u_light)
    total = one(direction, wanted)
    return total + one(sample_brdf(proposal, hit, u_surface), None)


def roulette(beta, u):
    out, alive = np.zeros_like(beta), np.zeros(len(u), bool)
    for n in range(len(u)):
        chance = min(1.0, float(max(beta[n])))
        if u[n] < chance:
            alive[n] = True
            out[n] = beta[n] / chance
    return out, alive


def trace_paths(scene, origins, directions, depth, rng):
    n = len(origins)
    radiance, beta = np.zeros((n, 3)), np.ones((n, 3))
    running, hit = np.ones(n, bool), closest_hit(scene, origins, directions)
    radiance += emitted(scene, hit)
    running &= hit["primitive"] >= 0
    for piece in range(2, depth + 1):
        if not running.any():
            break
        rows = np.flatnonzero(running)
        here = take(hit, rows)
        got = direct_light(scene, here, rng.random((len(rows), 3)), rng.random((len(rows), 3)))
        radiance[rows] += beta[rows] * got
        if piece == depth:
            break
        wi = sample_brdf(scene, here, rng.random((len(rows), 3)))
        pdf = brdf_pdf(scene, here, wi)
        c = np.sum(wi * here["normals"], axis=1)
        good = (pdf > 0) & (c > 0)
        factor = np.zeros((len(rows), 3))
        factor[good] = brdf(scene, take(here, good), wi[good]) * (c[good] / pdf[good])[:, None]
        beta[rows] *= factor
        if piece - 2 >= ALWAYS:
            beta[rows], good = roulette(beta[rows], rng.random(len(rows)))
        after = closest_hit(scene, here["points"], wi)
        for name in hit:
            hit[name][rows] = after[name]
        running[rows] = good & (after["primitive"] >= 0)
    return radiance


def direct_light_backward(scene, hit, u_light, u_surface, d_radiance):
    d_base_color, d_roughness = (
        np.zeros_like(scene["base_color"]),
        np.zeros_like(scene["roughness"]),
    )
    points = hit["points"]
    wi, _, light = sample_light(scene, points, u_light)
    for from_lamp in (True, False):
        if not from_lamp:
            wi = sample_brdf(scene, hit, u_surface)
        there = closest_hit(scene, points, wi)
        p_light = light_pdf(scene, there["primitive"], wi, there["t"])
        p_surface = brdf_pdf(scene, hit, wi)
        p, q = (p_light, p_surface) if from_lamp else (p_surface, p_light)
        good = (p > 0) & (q > 0)
        if from_lamp:
            good &= there["primitive"] == light
        c = np.sum(wi * hit["normals"], axis=1)
        scale = np.zeros(len(c))
        scale[good] = mis_weight(p, q)[good] * c[good] / p[good]
        d_f = d_radiance * emitted(scene, there) * scale[:, None]
        colors, roughs = brdf_backward(scene, hit, wi, d_f)
        for primitive in np.unique(hit["primitive"]):
            mine = hit["primitive"] == primitive
            d_base_color[primitive] += colors[mine].sum(axis=0)
            d_roughness[primitive] += roughs[mine].sum()
    return d_base_color, d_roughness
