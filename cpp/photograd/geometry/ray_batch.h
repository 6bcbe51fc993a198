// A batch of rays, cut into packets of sixteen in a good order and handed out to the threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"
#include "photograd/core/world_limit.h"
#include "photograd/geometry/bvh.h"

namespace photograd {

/// The rows of the batch that the lanes of a packet hold.
using PacketRows = std::array<std::int64_t, RayPacket::width>;

/// Fills lane k with ray `row`; returns false, leaving the lane inactive, for a ray that is no ray
/// or beyond `reach`.
template <class R>
bool load_lane(const RaySpan<R>& rays, const RayInterval<R>& interval, float reach,
               std::int64_t row, int k, RayPacket& packet) {
    const R *o = rays.origins + 3 * row, *d = rays.directions + 3 * row;
    float squared = 0, size = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float p = float(o[axis]), e = float(d[axis]);
        packet.origin[axis][k] = p;
        packet.direction[axis][k] = e;
        size += std::abs(p) + std::abs(e);
        squared += e * e;
    }
    packet.time[k] = 0;
    packet.t_min[k] = float(interval.t_min[row * interval.t_min_step]);
    packet.t_max[k] = float(interval.t_max[row * interval.t_max_step]);
    packet.active[k] = size <= reach && squared > 0;  // NaN is not
    return packet.active[k];
}

/// Rays in another order than the input lie anywhere in memory; prefetches those of a later packet.
template <class R>
void prefetch(const RaySpan<R>& rays, const std::uint32_t* order, std::int64_t first,
              std::int64_t end) {
    for (std::int64_t i = first; i < std::min(end, first + RayPacket::width); ++i) {
        __builtin_prefetch(rays.origins + 3 * static_cast<std::int64_t>(order[i]));
        __builtin_prefetch(rays.directions + 3 * static_cast<std::int64_t>(order[i]));
    }
}

[[noreturn]] inline void refuse_rays(const char* function, float reach, std::int64_t count,
                                     std::int64_t first) {
    fail(ErrorKind::range, function, "origins, directions",
         "finite numbers whose sizes add up to at most " + number_text(double(reach)) +
             ", and directions of some length",
         std::to_string(count) + " rays that have not, the first in row " + std::to_string(first));
}

/// visit(packet, side_by_side, rows) for all rays, packets being cut the same way for any number of
/// threads.
template <class R, class Visit>
void for_each_packet(const RaySpan<R>& rays, const RayInterval<R>& interval, const Box& scene,
                     float reach, const char* function, Visit&& visit) {
    constexpr int width = RayPacket::width;
    constexpr std::int64_t block_size = 4096;    // rays of one task
    constexpr std::int64_t slab_size = 1 << 20;  // rays ordered at a time: 20 MB of scratch
    LineOrder line_order;
    std::vector<std::int64_t> refused, first_refused;
    for (std::int64_t start = 0; start < rays.count; start += slab_size) {
        const RaySpan<R> slab{rays.origins + 3 * start, rays.directions + 3 * start,
                              std::min(slab_size, rays.count - start)};
        const bool near = runs_side_by_side(slab, scene);
        const std::uint32_t* order = near ? nullptr : line_order.sort(slab, scene);
        const std::int64_t blocks = (slab.count + block_size - 1) / block_size;
        refused.assign(static_cast<std::size_t>(blocks), 0);
        first_refused.assign(static_cast<std::size_t>(blocks), rays.count);
        parallel_for(blocks, [&](std::int64_t block) {
            const std::int64_t end = std::min(slab.count, (block + 1) * block_size);
            const auto b = static_cast<std::size_t>(block);
            RayPacket packet;
            PacketRows rows;
            for (std::int64_t i = block * block_size; i < end; i += width) {
                if (!near) prefetch(slab, order, i + 2 * width, end);
                for (int k = 0; k < width; ++k) {
                    // Lanes behind the end repeat the last ray, switched off.
                    const std::int64_t at = std::min(i + k, end - 1);
                    rows[static_cast<std::size_t>(k)] =
                        start + (near ? at : order[static_cast<std::size_t>(at)]);
                    const std::int64_t row = rows[static_cast<std::size_t>(k)];
                    const bool good = load_lane(rays, interval, reach, row, k, packet);
                    if (i + k >= end) {
                        packet.active[k] = false;
                    } else if (!good) {
                        ++refused[b];
                        first_refused[b] = std::min(first_refused[b], row);
                    }
                }
                visit(packet, near, rows);
            }
        });
        std::int64_t count = 0, first = rays.count;
        for (std::size_t b = 0; b < refused.size(); ++b) {
            count += refused[b];
            first = std::min(first, first_refused[b]);
        }
        if (count > 0) refuse_rays(function, reach, count, first);
    }
}

}  // namespace photograd
