"""Written from the handout alone: barycentric coordinates, world space, convolutions by FFT."""

import numpy as np
from real_time_frame import BIAS, LUMINANCE, REACH, local, pixel_block, unproject
from reflectance import gltf


def rasterize(corners, height, width):
    face = -np.ones((height, width), dtype=np.int64)
    depth = np.inf * np.ones((height, width))
    weights = np.zeros((height, width, 3))
    for i in range(len(corners)):
        a, b, c = corners[i]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        order = [0, 1, 2]
        if area == 0:
            continue
        if area < 0:
            b, c, order = c, b, [0, 2, 1]
        block, x, y = pixel_block(corners[i], height, width)
        if block[0].start >= block[0].stop or block[1].start >= block[1].stop:
            continue
        x, y = x[:, 0], y[:, :, 0]

        def edge(p, q, x=x, y=y):
            E = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])
            if q[1] - p[1] < 0:  # left
                return E, E >= 0
            if q[1] == p[1] and q[0] - p[0] > 0:  # top
                return E, E >= 0
            return E, E > 0

        (ea, ina), (eb, inb), (ec, inc) = edge(b, c), edge(c, a), edge(a, b)
        covered_here = ina & inb & inc
        with np.errstate(divide="ignore", invalid="ignore"):
            wa, wb, wc = ea / a[2], eb / b[2], ec / c[2]
            z = abs(area) / (wa + wb + wc)
            w = np.stack([wa, wb, wc], axis=-1) / (wa + wb + wc)[..., np.newaxis]
        closer = covered_here & (np.where(covered_here, z, np.inf) < depth[block])
        f, d, ws = face[block], depth[block], weights[block]
        f[closer] = i
        d[closer] = z[closer]
        for k in range(3):
            ws[..., order[k]][closer] = w[..., k][closer]
    return face, weights, depth


def shadow_test(points, normals, depth, focal, pose, bias):
    size = depth.shape[0]
    shifted = points + bias * normals
    camera = (shifted - pose[:, 3]) @ pose[:, :3]
    z = camera[:, 2]
    u = np.floor(focal * camera[:, 0] / z + size / 2)
    v = np.floor(focal * camera[:, 1] / z + size / 2)
    border = np.full((size + 6, size + 6), np.inf)
    border[3:-3, 3:-3] = depth
    u = np.minimum(np.maximum(u, -2), size + 1).astype(np.int64) + 3
    v = np.minimum(np.maximum(v, -2), size + 1).astype(np.int64) + 3
    answers = [border[v + dv, u + du] >= z for dv in (-1, 0, 1) for du in (-1, 0, 1)]
    return np.array(answers, dtype=float).sum(axis=0) / 9.0


def light_surfaces(gbuffer, focal, pose, lights, lit, open_sky):
    height, width = gbuffer["depth"].shape
    R = pose[:, :3]
    result = np.zeros((height, width, 4))
    rows, columns = np.nonzero(np.isfinite(gbuffer["depth"]))
    if len(rows) == 0:
        return result
    p = unproject(gbuffer["depth"], focal)[rows, columns]
    wo = (-p / np.linalg.norm(p, axis=1)[:, None]) @ R.T
    n = gbuffer["normal"][rows, columns] @ R.T
    wi = np.repeat(lights["to_sun"][None, :], len(n), axis=0)
    base = gbuffer["base_color"][rows, columns]
    metal, rough = gbuffer["metalness"][rows, columns], gbuffer["roughness"][rows, columns]
    brdf = gltf(local(n, wo), local(n, wi), base, metal, rough)
    cos_theta = np.clip((n * wi).sum(axis=1), 0, 1)
    E = lit[rows, columns] * cos_theta
    L = brdf * np.outer(E, lights["sun"])
    L = L + base * np.outer(open_sky[rows, columns], lights["sky"])
    L = L + gbuffer["emission"][rows, columns]
    alpha = gbuffer["alpha"][rows, columns]
    result[rows, columns, 0:3] = L * alpha[:, None]
    result[rows, columns, 3] = alpha
    return result


def bloom(radiance, threshold, sigma, strength):
    n = int(np.ceil(3 * sigma))
    g = np.array([np.exp(-(k**2) / (2.0 * sigma**2)) for k in range(-n, n + 1)])
    g = g / np.sum(g)
    b = np.maximum(0.0, radiance - threshold)
    blurred = np.empty_like(b)
    for channel in range(3):
        first = np.array([np.convolve(line, g)[n:-n] for line in b[:, :, channel]])
        blurred[:, :, channel] = np.array([np.convolve(line, g)[n:-n] for line in first.T]).T
    return radiance + strength * blurred - strength * b


def tone_map(radiance, settings, d_shown):
    e, w = settings
    factor = np.exp2(e)
    R, G, B = (factor * radiance[..., k] for k in range(3))
    Y = LUMINANCE[0] * R + LUMINANCE[1] * G + LUMINANCE[2] * B
    top, bottom = 1 + Y / w**2, 1 + Y
    s = top / bottom
    shown = np.stack([s * R, s * G, s * B], axis=2)
    d_s = d_shown[..., 0] * R + d_shown[..., 1] * G + d_shown[..., 2] * B
    d_Y = d_s * (bottom / w**2 - top) / bottom**2
    d_c = [s * d_shown[..., k] + LUMINANCE[k] * d_Y for k in range(3)]
    d_radiance = factor * np.stack(d_c, axis=2)
    d_e = sum(np.sum(d * x) for d, x in zip(d_c, (R, G, B), strict=True)) * np.log(2)
    d_w = np.sum(d_s * Y / bottom) * (-2) * w ** (-3)
    return shown, d_radiance, np.array([d_e, d_w])


def ambient_occlusion(depth, normals, focal, offsets, settings, d_open):
    height, width = depth.shape
    r, k, strength = settings
    points = unproject(depth, focal)
    count = offsets.shape[2]
    open_sky, d_r, d_k, d_strength = np.ones((height, width)), 0.0, 0.0, 0.0
    v, u = np.nonzero(np.isfinite(depth))
    p, n, weight = points[v, u], normals[v, u], d_open[v, u]
    for i in range(count):
        pixels = REACH * focal / depth[v, u]
        x = np.floor(u + 0.5 + pixels * offsets[v, u, i, 0]).astype(np.int64)
        y = np.floor(v + 0.5 + pixels * offsets[v, u, i, 1]).astype(np.int64)
        inside = (x >= 0) & (x <= width - 1) & (y >= 0) & (y <= height - 1)
        which = np.flatnonzero(inside)
        which = which[np.isfinite(depth[y[which], x[which]])]
        q = points[y[which], x[which]]
        away = q - p[which]
        d2 = away[:, 0] ** 2 + away[:, 1] ** 2 + away[:, 2] ** 2
        some = (d2 > 0) & (d2 < r**2)
        which, away, d2 = which[some], away[some], d2[some]
        elevation = (away * n[which]).sum(axis=1) / d2**0.5
        e = np.where(elevation > BIAS, elevation - BIAS, 0.0)
        fade = 1 - d2 / r**2
        amount = e * fade**k
        open_sky[v[which], u[which]] -= strength / count * amount
        g = -weight[which] / count
        d_strength += (g * amount).sum()
        d_k += (g * strength * amount * np.log(fade)).sum()
        d_r += (g * strength * e * k * fade ** (k - 1) * 2 * d2 / r**3).sum()
    return open_sky, np.array([d_r, d_k, d_strength])
