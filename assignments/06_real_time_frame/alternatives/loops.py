"""Loops over pixels, texels and samples, one number at a time."""

import math

import numpy as np
from real_time_frame import BIAS, LUMINANCE, REACH, local, pixel_block, project, unproject
from reflectance import gltf


def rasterize(corners, height, width):
    face = np.full((height, width), -1)
    weights = np.zeros((height, width, 3))
    depth = np.full((height, width), np.inf)
    for f, ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) in enumerate(corners.tolist()):
        twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if twice == 0:
            continue
        sides = ((bx, by, cx, cy), (cx, cy, ax, ay), (ax, ay, bx, by))
        block, _, _ = pixel_block(corners[f], height, width)
        for v in range(block[0].start, block[0].stop):
            for u in range(block[1].start, block[1].stop):
                x, y = u + 0.5, v + 0.5
                e = []
                for side in sides:
                    px, py, qx, qy = side if twice > 0 else (*side[2:], *side[:2])
                    value = (qx - px) * (y - py) - (qy - py) * (x - px)
                    top_left = qy < py or (qy == py and qx > px)
                    if value < 0 or (value == 0 and not top_left):
                        break
                    e.append(value / abs(twice))
                else:
                    z = 1 / (e[0] / az + e[1] / bz + e[2] / cz)
                    if z < depth[v, u]:
                        face[v, u], depth[v, u] = f, z
                        weights[v, u] = e[0] / az * z, e[1] / bz * z, e[2] / cz * z
    return face, weights, depth


def shadow_test(points, normals, depth, focal, pose, bias):
    S = len(depth)
    out = np.zeros(len(points))
    for i in range(len(points)):
        (x, y, z) = project((points[i] + bias * normals[i])[None], focal, pose, S, S)[0]
        total = 0
        for r in range(math.floor(y) - 1, math.floor(y) + 2):
            for c in range(math.floor(x) - 1, math.floor(x) + 2):
                if r < 0 or c < 0 or r >= S or c >= S or depth[r, c] >= z:
                    total += 1
        out[i] = total / 9
    return out


def light_surfaces(gbuffer, focal, pose, lights, lit, open_sky):
    H, W = lit.shape
    out = np.zeros((H, W, 4))
    sun = pose[:, :3].T @ lights["to_sun"]
    for v in range(H):
        for u in range(W):
            if gbuffer["depth"][v, u] == np.inf:
                continue
            eye = -np.array([(u + 0.5 - W / 2) / focal, (v + 0.5 - H / 2) / focal, 1.0])
            eye /= math.sqrt(eye @ eye)
            pixel = {name: values[v, u] for name, values in gbuffer.items()}
            n = pixel["normal"]
            radiance = pixel["emission"] + open_sky[v, u] * lights["sky"] * pixel["base_color"]
            if n @ sun > 0 and n @ eye > 0:
                f = gltf(
                    local(n[None], eye[None]),
                    local(n[None], sun[None]),
                    pixel["base_color"][None],
                    pixel["metalness"][None],
                    pixel["roughness"][None],
                )[0]
                radiance = radiance + lit[v, u] * (n @ sun) * f * lights["sun"]
            out[v, u, :3], out[v, u, 3] = radiance * pixel["alpha"], pixel["alpha"]
    return out


def bloom(radiance, threshold, sigma, strength):
    H, W, _ = radiance.shape
    n = math.ceil(3 * sigma)
    g = [math.exp(-((k / sigma) ** 2) / 2) for k in range(-n, n + 1)]
    bright = np.where(radiance > threshold, radiance - threshold, 0.0)
    rows, both = np.zeros_like(bright), np.zeros_like(bright)
    for v in range(H):
        for k in range(max(-n, -v), min(n, H - 1 - v) + 1):
            rows[v] += g[k + n] / sum(g) * bright[v + k]
    for u in range(W):
        for k in range(max(-n, -u), min(n, W - 1 - u) + 1):
            both[:, u] += g[k + n] / sum(g) * rows[:, u + k]
    return (1 - strength) * bright + strength * both + np.minimum(radiance, threshold)


def tone_map(radiance, settings, d_shown):
    e, w = settings.tolist()
    shown, back = np.zeros_like(radiance), np.zeros_like(radiance)
    d_e = d_w = 0.0
    for v in range(radiance.shape[0]):
        for u in range(radiance.shape[1]):
            x, g = radiance[v, u] * 2**e, d_shown[v, u]
            lum = x @ LUMINANCE
            s = (lum / (w * w) + 1) / (lum + 1)
            ds = 1 / (w * w) / (lum + 1) - s / (lum + 1)
            shown[v, u] = s * x
            d_x = s * g + ds * (x @ g) * LUMINANCE
            back[v, u] = d_x * 2**e
            d_e += math.log(2) * (x @ d_x)
            d_w += (x @ g) * lum / (lum + 1) * -2 / w**3
    return shown, back, np.array([d_e, d_w])


def ambient_occlusion(depth, normals, focal, offsets, settings, d_open):
    H, W, S, _ = offsets.shape
    radius, falloff, strength = settings.tolist()
    out, d_settings = np.ones((H, W)), np.zeros(3)
    where = unproject(depth, focal)
    for v in range(H):
        for u in range(W):
            if not math.isfinite(depth[v, u]):
                continue
            p, n, scale = where[v, u], normals[v, u], REACH * focal / depth[v, u]
            for dx, dy in offsets[v, u].tolist():
                c, r = math.floor(u + 0.5 + scale * dx), math.floor(v + 0.5 + scale * dy)
                if (r, c) == (v, u) or not (0 <= r < H and 0 <= c < W):
                    continue
                if depth[r, c] == np.inf:
                    continue
                d = where[r, c] - p
                far = math.sqrt(d @ d)
                up, t = d @ n / far - BIAS, 1 - (far / radius) ** 2
                if up <= 0 or t <= 0:
                    continue
                hides = up * t**falloff / S
                out[v, u] -= strength * hides
                d_settings[2] -= d_open[v, u] * hides
                d_settings[1] -= d_open[v, u] * strength * hides * math.log(t)
                d_t = strength * falloff * hides / t
                d_settings[0] -= d_open[v, u] * d_t * 2 * far**2 / radius**3
    return out, d_settings
