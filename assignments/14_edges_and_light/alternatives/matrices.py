"""Antiderivatives and matrices: sums over uses are products."""

import numpy as np
from edges_and_light import (
    DISTANCE,
    ETA,
    bezier,
    brdf_backward,
    closest_hit,
    direct_light,
    direct_light_backward,
    emitted,
    nearest_on_curve,
    next_vertex,
    path_numbers,
    path_radiance,
    pixel_centers,
    round_coverage,
    take,
)


def edge_coverage(angle, offset):
    # The four corners of the pixel as seen along n, with the coordinate along m.
    n = np.stack([np.cos(angle), np.sin(angle)])
    signs = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    depth = signs @ n
    aside = signs @ np.stack([-n[1], n[0]])
    level = offset - depth
    low, high = np.full(len(angle), np.inf), np.full(len(angle), -np.inf)
    for k in range(4):
        j = (k + 1) % 4
        crossed = (level[k] < 0) != (level[j] < 0)
        t = level[k] / np.where(crossed, level[k] - level[j], 1.0)
        place = aside[k] + t * (aside[j] - aside[k])
        low = np.where(crossed, np.minimum(low, place), low)
        high = np.where(crossed, np.maximum(high, place), high)
    through = high > low
    d_offset = np.where(through, high - low, 0.0)
    with np.errstate(invalid="ignore"):
        moment = np.where(through, (high + low) / 2, 0.0) * d_offset
    # The area is a polynomial between corners: sum its pieces from the lowest corner up.
    order = np.sort(depth, axis=0)
    a = np.maximum(np.abs(n[0]), np.abs(n[1]))
    up = np.clip(offset, order[0], order[1]) - order[0]
    flat = np.clip(offset, order[1], order[2]) - order[1]
    down = np.clip(offset, order[2], order[3]) - order[2]
    ramp = np.maximum(order[1] - order[0], 1e-300)
    area = (up**2 / ramp / 2 + flat + down - down**2 / ramp / 2) / a
    return area, d_offset, -moment


def edge_sampling_backward(vertices, inside, outside, d_image, u):
    count = len(vertices)
    step = np.roll(np.eye(count), 1, axis=1) - np.eye(count)
    d = step @ vertices
    length = np.sqrt(np.einsum("ki,ki->k", d, d))
    bounds = np.concatenate([[0.0], np.cumsum(length)])
    s = u * bounds[-1]
    k = np.clip(np.digitize(s, bounds) - 1, 0, count - 1)
    t = (s - bounds[k]) / length[k]
    hats = np.zeros((len(u), count))
    rows = np.arange(len(u))
    hats[rows, k] += 1 - t
    hats[rows, (k + 1) % count] += t
    x = hats @ vertices
    padded = np.pad(d_image, ((1, 1), (1, 1), (0, 0)))
    limits = np.array(d_image.shape[:2]) + 1
    cell = np.clip(np.floor(x[:, ::-1]).astype(int) + 1, 0, limits)
    g = np.einsum("nc,nc->n", padded[tuple(cell.T)], inside(x) - outside(x))
    out = d[k] @ np.array([[0.0, -1.0], [1.0, 0.0]]) / length[k, None]
    return hats.T @ (g[:, None] * out) * bounds[-1] / len(u)


def stroke_backward(curve, width, d_alpha):
    t, distance = nearest_on_curve(curve, pixel_centers(*d_alpha.shape))
    sign = np.array([[1.0], [-1.0]])
    chords = round_coverage(sign * width / 2 - distance)[1]
    weights = d_alpha.ravel() * chords
    bernstein = np.stack([1 - 2 * t + t**2, 2 * (t - t**2), t**2])
    away = pixel_centers(*d_alpha.shape) - bezier(curve, t)
    norm = np.hypot(*away.T)
    away = np.divide(away, norm[:, None], out=np.zeros_like(away), where=norm[:, None] > 0)
    return bernstein * (weights[0] - weights[1]) @ away, float(weights.sum() / 2)


def replay_backward(scene, origins, directions, depth, seed, radiance, d_radiance):
    n = len(origins)
    hit = closest_hit(scene, origins, directions)
    ids = np.arange(n)[hit["primitive"] >= 0]
    hit, beta = take(hit, hit["primitive"] >= 0), np.ones((n, 3))
    passed = np.zeros((n, 3))
    passed[ids] = emitted(scene, hit)
    rows, colors, roughs = [], [], []
    base = np.zeros(scene["base_color"].shape), np.zeros(len(scene["roughness"]))
    for bounce in range(1, depth):
        u = path_numbers(seed, bounce - 1, n)
        own = [u[k, ids] for k in range(3)]
        shine = beta[ids] * direct_light(scene, hit, own[0], own[1])
        passed[ids] = passed[ids] + shine
        weights = beta[ids] * d_radiance[ids]
        more = direct_light_backward(scene, hit, own[0], own[1], weights)
        base = base[0] + more[0], base[1] + more[1]
        wi, f, factor, there = next_vertex(scene, hit, own[2])
        ratio = np.zeros(f.shape)
        np.divide(radiance[ids] - passed[ids], f, out=ratio, where=f != 0)
        each = brdf_backward(scene, hit, wi, ratio * d_radiance[ids])
        rows.append(hit["primitive"])
        colors.append(each[0])
        roughs.append(each[1])
        beta[ids] = beta[ids] * f * factor[:, None]
        on = there["primitive"] >= 0
        ids, hit = ids[on], take(there, on)
    if rows:
        belongs = np.concatenate(rows) == np.arange(len(base[1]))[:, None]
        more = belongs @ np.concatenate(colors), belongs @ np.concatenate(roughs)
        return base[0] + more[0], base[1] + more[1]
    return base
    return base


def noisy_loss_and_grad(scene, origins, directions, picture, depth, samples, seeds):
    n = len(picture)
    o = np.broadcast_to(origins[:, None], (n, samples, 3)).reshape(-1, 3)
    d = np.broadcast_to(directions[:, None], (n, samples, 3)).reshape(-1, 3)
    seen = np.stack([path_radiance(scene, o, d, depth, seed) for seed in seeds])
    off = seen.reshape(2, n, samples, 3).mean(axis=2) - picture
    weight = 1 / (3 * n * np.square(picture + 0.1))
    back = weight * off[::-1] / samples
    back = np.broadcast_to(back[:, :, None], (2, n, samples, 3)).reshape(2, -1, 3)
    halves = [replay_backward(scene, o, d, depth, seeds[k], seen[k], back[k]) for k in range(2)]
    d_base_color, d_roughness = (np.sum(parts, axis=0) for parts in zip(*halves, strict=True))
    return float(np.einsum("nc,nc,nc->", weight, off[0], off[1])), d_base_color, d_roughness


def landing_backward(heights, d_points):
    m = len(heights) - 1
    mean = (np.eye(m, m + 1) + np.eye(m, m + 1, 1)) / 2
    rise = (np.eye(m, m + 1, 1) - np.eye(m, m + 1)) * m
    level, p_x, p_y = mean @ heights @ mean.T, mean @ heights @ rise.T, rise @ heights @ mean.T
    q = p_x**2 + p_y**2
    root = np.sqrt(1 - (ETA**2 - 1) * q)
    # tan = (eta - root) / (eta q + root), which is -k / (eta + k) with k = (root - eta) / (1 + q).
    under = ETA * q + root
    tan = (ETA - root) / under
    root_q = (1 - ETA**2) / (2 * root)
    tan_q = -(root_q + tan * (ETA + root_q)) / under
    g = d_points.reshape(m, m, 2)
    along = g[..., 0] * p_x + g[..., 1] * p_y
    reach = DISTANCE - level
    back_x = reach * (g[..., 0] * tan + 2 * along * tan_q * p_x)
    back_y = reach * (g[..., 1] * tan + 2 * along * tan_q * p_y)
    found = mean.T @ back_x @ rise + rise.T @ back_y @ mean
    return found - mean.T @ (along * tan) @ mean
