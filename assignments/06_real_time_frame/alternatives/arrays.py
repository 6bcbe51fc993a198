"""Whole arrays: matrices in place of loops over samples, texels and rows."""

import numpy as np
from real_time_frame import BIAS, LUMINANCE, REACH, local, pixel_block, project, unproject
from reflectance import gltf


def rasterize(corners, height, width):
    shape = height * width
    number, shares, closest = np.full(shape, -1), np.zeros((shape, 3)), np.full(shape, np.inf)
    grid = np.arange(shape).reshape(height, width)
    for index in range(len(corners)):
        block, px, py = pixel_block(corners[index], height, width)
        cells = grid[block].ravel()
        if not len(cells):
            continue
        flat = corners[index, :, :2]
        spot = np.stack(np.broadcast_arrays(px[None, :, 0], py[..., 0]), axis=-1).reshape(-1, 1, 2)
        start, end = flat[[1, 2, 0]], flat[[2, 0, 1]]
        way = end - start
        doubled = way[2, 0] * way[0, 1] - way[2, 1] * way[0, 0]
        if doubled == 0:
            continue
        side = way[:, 0] * (spot - start)[..., 1] - way[:, 1] * (spot - start)[..., 0]
        if doubled < 0:
            side, way = -side, -way
        mine = np.logical_or(way[:, 1] < 0, np.logical_and(way[:, 1] == 0, way[:, 0] > 0))
        kept = np.all(np.where(mine, side >= 0, side > 0), axis=1)
        cells, linear = cells[kept], side[kept] / abs(doubled)
        inverse = linear @ (1 / corners[index, :, 2])
        first = 1 / inverse < closest[cells]
        cells = cells[first]
        number[cells], closest[cells] = index, 1 / inverse[first]
        shares[cells] = linear[first] / corners[index, :, 2] / inverse[first, None]
    shape = height, width
    return number.reshape(shape), shares.reshape(*shape, 3), closest.reshape(shape)


def shadow_test(points, normals, depth, focal, pose, bias):
    side = depth.shape[0]
    moved = project(points + normals * bias, focal, pose, side, side)
    steps = np.arange(-1, 2)
    across = np.floor(moved[:, 0]).astype(int)[:, None, None] + steps
    along = np.floor(moved[:, 1]).astype(int)[:, None, None] + steps[:, None]
    beyond = np.logical_or.reduce(
        np.broadcast_arrays(across < 0, across >= side, along < 0, along >= side)
    )
    texels = depth[along % side, across % side]
    texels[beyond] = np.inf
    return np.mean(texels >= moved[:, 2, None, None], axis=(1, 2))


def light_surfaces(gbuffer, focal, pose, lights, lit, open_sky):
    covers = gbuffer["depth"] < np.inf
    count = covers.size
    world = pose[:, :3]
    facing = (gbuffer["normal"] @ world.T).reshape(count, 3)
    facing[~covers.ravel()] = [0.0, 1.0, 0.0]
    slopes = unproject(np.ones(covers.shape), focal).reshape(count, 3) @ world.T
    viewer = -slopes / np.sqrt((slopes**2).sum(axis=1))[:, None]
    way = np.broadcast_to(lights["to_sun"], (count, 3))
    flat = {key: values.reshape(count, *values.shape[2:]) for key, values in gbuffer.items()}
    reflect = gltf(
        local(facing, viewer),
        local(facing, way),
        flat["base_color"],
        flat["metalness"],
        np.maximum(flat["roughness"], 0.05) if not covers.all() else flat["roughness"],
    )
    falling = (facing @ lights["to_sun"] * lit.ravel())[:, None] * lights["sun"]
    total = flat["emission"] + reflect * falling
    total = total + open_sky.reshape(-1, 1) * flat["base_color"] * lights["sky"]
    picture = np.concatenate([total, np.ones((count, 1))], axis=1) * flat["alpha"][:, None]
    return np.where(covers[..., None], picture.reshape(*covers.shape, 4), 0.0)


def bloom(radiance, threshold, sigma, strength):
    def band(size):
        apart = np.abs(np.subtract.outer(np.arange(size), np.arange(size)))
        longest = np.ceil(3 * sigma)
        whole = np.exp(-(np.arange(-longest, longest + 1) ** 2) / (2 * sigma**2)).sum()
        return np.where(apart <= longest, np.exp(-(apart**2) / (2 * sigma**2)) / whole, 0.0)

    surplus = np.clip(radiance - threshold, 0, None)
    blurred = np.einsum("ij,jkc,kl->ilc", band(len(radiance)), surplus, band(radiance.shape[1]))
    return radiance - strength * surplus + strength * blurred


def tone_map(radiance, settings, d_shown):
    gain, limit = 2 ** settings[0], settings[1]
    bright = radiance * gain
    light = np.einsum("hwc,c->hw", bright, LUMINANCE)
    curve = (1 + light / limit**2) / (1 + light)
    steep = (1 / limit**2 - curve) / (1 + light)
    shown = bright * curve[:, :, None]
    jacobian = curve[:, :, None, None] * np.eye(3)
    jacobian = jacobian + np.einsum("hw,hwi,j->hwij", steep, bright, LUMINANCE)
    d_bright = np.einsum("hwij,hwi->hwj", jacobian, d_shown)
    by_limit = np.einsum("hwc,hwc,hw->", d_shown, bright, light / (1 + light)) * -2 * limit**-3
    by_gain = np.vdot(d_bright, radiance)
    return shown, gain * d_bright, np.array([by_gain * gain * np.log(2), by_limit])


def ambient_occlusion(depth, normals, focal, offsets, settings, d_open):
    size = np.array(depth.shape)
    spots = unproject(depth, focal)
    own = np.moveaxis(np.indices(depth.shape), 0, -1)[:, :, None]
    step = (REACH * focal / depth)[:, :, None, None] * offsets[..., ::-1]
    cell = np.floor(own + 0.5 + step).astype(int)
    use = np.logical_and(cell >= 0, cell < size).all(axis=3)
    row, column = np.moveaxis(np.where(use[..., None], cell, own), 3, 0)
    use &= np.isfinite(depth)[row, column]
    way = spots[row, column] - spots[:, :, None]
    length = np.sqrt(np.einsum("hwsc,hwsc->hws", way, way))
    use &= length > 0
    length[~use] = 1.0
    rise = np.einsum("hwsc,hwc->hws", way, normals) / length - BIAS
    left = 1 - (length / settings[0]) ** 2
    use &= (rise > 0) & (left > 0)
    rise, left = np.where(use, rise, 0.0), np.where(use, left, 1.0)
    each = rise * left ** settings[1]
    slopes = [
        settings[1] * rise * left ** (settings[1] - 1) * 2 * length**2 / settings[0] ** 3,
        each * np.log(left),
        each / settings[2],
    ]
    backward = [-settings[2] * np.vdot(d_open, slope.mean(axis=2)) for slope in slopes]
    return 1 - settings[2] * each.mean(axis=2), np.array(backward)
