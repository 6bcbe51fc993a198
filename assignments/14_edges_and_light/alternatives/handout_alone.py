"""Written from the handout alone, formula by formula."""

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
    n_x, n_y = np.cos(angle), np.sin(angle)
    a, b = np.sort(np.abs([n_x, n_y]), axis=0)[::-1]
    s, e = np.abs(offset), (a + b) / 2 - np.abs(offset)
    level = s <= (a - b) / 2
    cut = (e > 0) & ~level
    missing = np.zeros(len(s))
    missing[level] = 0.5 - s[level] / a[level]
    missing[cut] = e[cut] ** 2 / (2 * a[cut] * b[cut])
    length = np.zeros(len(s))
    length[level] = 1 / a[level]
    length[cut] = e[cut] / (a[cut] * b[cut])
    # The middle of the edge in the pixel, along m = (-n_y, n_x).
    place = np.zeros(len(s))
    steep = level & (np.abs(n_x) >= np.abs(n_y))
    gentle = level & ~steep
    place[steep] = (-offset * n_y / np.where(steep, n_x, 1.0))[steep]
    place[gentle] = (offset * n_x / np.where(gentle, n_y, 1.0))[gentle]
    sign_x, sign_y = np.sign(offset * n_x), np.sign(offset * n_y)
    x, y = sign_x / 2, sign_y / 2
    x[cut] -= (sign_x * e / np.abs(np.where(cut, n_x, 1.0)) / 2)[cut]
    y[cut] -= (sign_y * e / np.abs(np.where(cut, n_y, 1.0)) / 2)[cut]
    place[cut] = (n_x * y - n_y * x)[cut]
    return np.where(offset >= 0, 1 - missing, missing), length, -length * place


def edge_sampling_backward(vertices, inside, outside, d_image, u):
    count, total = len(vertices), np.zeros(vertices.shape)
    after = vertices[np.arange(1, count + 1) % count]
    lengths = np.linalg.norm(after - vertices, axis=1)
    perimeter, covered = lengths.sum(), 0.0
    for k in range(count):
        mine = (u * perimeter >= covered) & (u * perimeter < covered + lengths[k])
        if k == count - 1:
            mine = u * perimeter >= covered
        if lengths[k] == 0:
            continue
        t = (u[mine] * perimeter - covered) / lengths[k]
        covered += lengths[k]
        x = (1 - t)[:, None] * vertices[k] + t[:, None] * after[k]
        n = np.array([after[k, 1] - vertices[k, 1], vertices[k, 0] - after[k, 0]]) / lengths[k]
        cell = np.floor(x).astype(int)
        limits = np.array([d_image.shape[1], d_image.shape[0]])
        valid = ((cell >= 0) & (cell < limits)).all(axis=1)
        x, t, cell = x[valid], t[valid], cell[valid]
        if len(x) == 0:
            continue
        g = np.einsum("nc,nc->n", d_image[cell[:, 1], cell[:, 0]], inside(x) - outside(x))
        total[k] += perimeter / len(u) * np.sum(g * (1 - t)) * n
        total[(k + 1) % count] += perimeter / len(u) * np.sum(g * t) * n
    return total


def stroke_backward(curve, width, d_alpha):
    p = pixel_centers(d_alpha.shape[0], d_alpha.shape[1])
    t, d = nearest_on_curve(curve, p)
    c_near, c_far = round_coverage(width / 2 - d)[1], round_coverage(-width / 2 - d)[1]
    g = d_alpha.reshape(-1)
    d_width = g @ (c_near / 2 + c_far / 2)
    d_distance = g * (c_far - c_near)
    unit = np.where(d[:, None] > 0, (p - bezier(curve, t)) / np.where(d > 0, d, 1.0)[:, None], 0.0)
    d_curve = np.zeros((3, 2))
    for i, b in enumerate(((1 - t) * (1 - t), 2 * t - 2 * t * t, t * t)):
        d_curve[i] = np.sum((-d_distance * b)[:, None] * unit, axis=0)
    return d_curve, float(d_width)


def replay_backward(scene, origins, directions, depth, seed, radiance, d_radiance):
    count = len(scene["matte"])
    colors, roughs = np.zeros((count, 3)), np.zeros(count)
    hit = closest_hit(scene, origins, directions)
    alive = np.flatnonzero(hit["primitive"] >= 0)
    hit = take(hit, alive)
    remaining = radiance[alive] - emitted(scene, hit)
    throughput, g = np.ones((len(alive), 3)), d_radiance[alive]
    for k in range(depth - 1):
        u_light, u_surface, u_path = path_numbers(seed, k, len(origins))[:, alive]
        c, r = direct_light_backward(scene, hit, u_light, u_surface, throughput * g)
        remaining = remaining - throughput * direct_light(scene, hit, u_light, u_surface)
        wi, f, factor, after = next_vertex(scene, hit, u_path)
        d_f = np.where(f > 0, g * remaining / np.where(f > 0, f, 1.0), 0.0)
        rows_c, rows_r = brdf_backward(scene, hit, wi, d_f)
        for i in range(count):
            mine = hit["primitive"] == i
            c[i] += rows_c[mine].sum(axis=0)
            r[i] += rows_r[mine].sum()
        colors += c
        roughs += r
        keep = after["primitive"] >= 0
        throughput = (throughput * f * factor[:, None])[keep]
        remaining, g, alive, hit = remaining[keep], g[keep], alive[keep], take(after, keep)
        if len(alive) == 0:
            break
    return colors, roughs


def noisy_loss_and_grad(scene, origins, directions, picture, depth, samples, seeds):
    n = len(picture)
    rays = np.repeat(origins, samples, axis=0), np.repeat(directions, samples, axis=0)
    a = path_radiance(scene, *rays, depth, seeds[0])
    b = path_radiance(scene, *rays, depth, seeds[1])
    r_a = a.reshape(n, samples, 3).sum(axis=1) / samples - picture
    r_b = b.reshape(n, samples, 3).sum(axis=1) / samples - picture
    weight = (picture + 0.1) ** -2 / (3 * n)
    to_a = np.repeat(weight * r_b, samples, axis=0) / samples
    to_b = np.repeat(weight * r_a, samples, axis=0) / samples
    from_a = replay_backward(scene, *rays, depth, seeds[0], a, to_a)
    from_b = replay_backward(scene, *rays, depth, seeds[1], b, to_b)
    loss = float((weight * r_a * r_b).sum())
    return loss, from_a[0] + from_b[0], from_a[1] + from_b[1]


def landing_backward(heights, d_points):
    m = len(heights) - 1
    a, b = heights[:-1, :-1], heights[:-1, 1:]
    c, d = heights[1:, :-1], heights[1:, 1:]
    s_x, s_y = m / 2 * (b - a + d - c), m / 2 * (c - a + d - b)
    z = DISTANCE - (a + b + c + d) / 4
    q = s_x * s_x + s_y * s_y
    r = np.sqrt(1 + q - ETA**2 * q)
    k = (r - ETA) / (1 + q)
    tau = -k / (ETA + k)
    k_q = (1 - ETA**2) / (2 * r * (1 + q)) - k / (1 + q)
    tau_q = -ETA * k_q / (ETA + k) ** 2
    g_x, g_y = d_points[:, 0].reshape(m, m), d_points[:, 1].reshape(m, m)
    w = g_x * s_x + g_y * s_y
    d_x = z * (tau * g_x + 2 * tau_q * w * s_x) * m / 2
    d_y = z * (tau * g_y + 2 * tau_q * w * s_y) * m / 2
    d_z = -tau * w / 4
    out = np.zeros((m + 1, m + 1))
    out[:-1, :-1] += d_z - d_x - d_y
    out[:-1, 1:] += d_z + d_x - d_y
    out[1:, :-1] += d_z - d_x + d_y
    out[1:, 1:] += d_z + d_x + d_y
    return out
