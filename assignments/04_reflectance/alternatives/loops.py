"""Scalar loops: one pair of directions at a time, by angles and tangents."""

import math

import numpy as np
from reflectance import hemisphere

PI = math.pi


def furnace(f, cosines):
    wi, angles = hemisphere()
    result = []
    for z in cosines.tolist():
        wo = np.array([[math.sqrt(1 - z * z), 0.0, z]] * len(wi))
        total = 0.0
        for row, values in enumerate(f(wo, wi)):
            total = total + values * (wi[row, 2] * angles[row])
        result.append(total)
    return np.array(result)


def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(a):
    length = math.sqrt(_dot(a, a))
    return [x / length for x in a]


def _half(o, i):
    return _unit([a + b for a, b in zip(o, i, strict=True)])


def _tan2(w):
    return (w[0] * w[0] + w[1] * w[1]) / (w[2] * w[2])


def _D(h, alpha):
    return alpha * alpha / (PI * h[2] ** 4 * (alpha * alpha + _tan2(h)) ** 2)


def _Lambda(w, alpha):
    return (math.sqrt(1 + alpha * alpha * _tan2(w)) - 1) / 2


def _each(function, *arrays):
    rows = zip(*(a.tolist() for a in arrays), strict=True)
    return [function(*row) for row in rows]


def _value(o, i, roughness):
    if o[2] <= 0 or i[2] <= 0:
        return 0.0
    alpha = roughness * roughness
    G2 = 1 / (1 + _Lambda(o, alpha) + _Lambda(i, alpha))
    return _D(_half(o, i), alpha) * G2 / (4 * o[2] * i[2])


def _density(o, i, roughness):
    if o[2] <= 0 or i[2] <= 0:
        return 0.0
    alpha = roughness * roughness
    return _D(_half(o, i), alpha) / (1 + _Lambda(o, alpha)) / (4 * o[2])


def ggx_lobe(wo, wi, roughness):
    return np.array(_each(_value, wo, wi, roughness))


def ggx_pdf(wo, wi, roughness):
    return np.array(_each(_density, wo, wi, roughness))


def _drawn(o, roughness, u):
    alpha = roughness * roughness
    v = _unit([alpha * o[0], alpha * o[1], o[2]])
    z = 1 - u[0] * (1 + v[2])
    r = math.sqrt(max(1 - z * z, 0.0))
    c = [r * math.cos(2 * PI * u[1]), r * math.sin(2 * PI * u[1]), z]
    h = _unit([alpha * (c[0] + v[0]), alpha * (c[1] + v[1]), c[2] + v[2]])
    return [2 * _dot(o, h) * a - b for a, b in zip(h, o, strict=True)]


def sample_ggx(wo, roughness, u2):
    return np.array(_each(_drawn, wo, roughness, u2))


def _material(o, i, color, m, roughness):
    if o[2] <= 0 or i[2] <= 0:
        return [0.0] * 3
    lobe = _value(o, i, roughness)
    ramp = (1 - _dot(o, _half(o, i))) ** 5
    F = 0.04 + 0.96 * ramp
    result = []
    for b in color:
        matte = (1 - F) * b / PI + F * lobe
        result.append((1 - m) * matte + m * (b + (1 - b) * ramp) * lobe)
    return result


def gltf(wo, wi, base_color, metalness, roughness):
    return np.array(_each(_material, wo, wi, base_color, metalness, roughness))


def _pull(o, i, color, m, roughness, g):
    if o[2] <= 0 or i[2] <= 0:
        return [0.0] * 3, 0.0, 0.0
    alpha = roughness * roughness
    h = _half(o, i)
    lobe = _value(o, i, roughness)
    ramp = (1 - _dot(o, h)) ** 5
    F = 0.04 + 0.96 * ramp
    d_color, d_m, d_lobe = [], 0.0, 0.0
    for b, pull in zip(color, g, strict=True):
        d_color.append(pull * ((1 - m) * (1 - F) / PI + m * (1 - ramp) * lobe))
        metal = b + (1 - b) * ramp
        d_m += pull * (metal * lobe - (1 - F) * b / PI - F * lobe)
        d_lobe += pull * ((1 - m) * F + m * metal)
    t = _tan2(h)
    log_D = 2 / alpha - 4 * alpha / (alpha * alpha + t)
    G2 = 1 / (1 + _Lambda(o, alpha) + _Lambda(i, alpha))
    log_G = 0.0
    for w in (o, i):
        log_G -= G2 * alpha * _tan2(w) / (2 * math.sqrt(1 + alpha * alpha * _tan2(w)))
    return d_color, d_m, d_lobe * lobe * (log_D + log_G) * 2 * roughness


def gltf_backward(wo, wi, base_color, metalness, roughness, d_f):
    rows = _each(_pull, wo, wi, base_color, metalness, roughness, d_f)
    return tuple(np.array(part) for part in zip(*rows, strict=True))
