// Sixteen rays at a time: the only code that fills Embree's packets.
#pragma once

#include <limits>

#include "photograd/geometry/bvh.h"

namespace photograd {

inline constexpr int trace_width = RayPacket::width;

template <class R>
struct RayQuery {
    Vec3<R> origin{R(0)}, direction{R(0)};
    float time = 0;                                        // while the shutter is open
    float t_max = std::numeric_limits<float>::infinity();  // in units of `direction`
};

/// The packet of those of sixteen rays for which ray_of(k, query) is true; whether there are any.
template <class R, class RayOf>
bool fill_packet(RayPacket& packet, RayOf&& ray_of) {
    bool any = false;
    for (int k = 0; k < trace_width; ++k) {
        RayQuery<R> query;
        packet.active[k] = ray_of(k, query);
        if (!packet.active[k]) continue;
        any = true;
        for (int axis = 0; axis < 3; ++axis) {
            packet.origin[axis][k] = static_cast<float>(query.origin[axis]);
            packet.direction[axis][k] = static_cast<float>(query.direction[axis]);
        }
        packet.t_min[k] = 0;
        packet.t_max[k] = query.t_max;
        packet.time[k] = query.time;
    }
    return any;
}

/// Finds the closest hits; false if there are no rays. `coherent`: rays that start side by side.
template <class R, class RayOf>
bool closest16(const Bvh& bvh, bool coherent, RayOf&& ray_of, PacketHits& found) {
    RayPacket packet{};
    if (!fill_packet<R>(packet, ray_of)) return false;
    bvh.trace(packet, coherent, found);
    return true;
}

/// Finds whether anything is hit at all; `blocked` of rays that do not exist is false.
template <class R, class RayOf>
void occluded16(const Bvh& bvh, RayOf&& ray_of, bool (&blocked)[trace_width]) {
    RayPacket packet{};
    if (fill_packet<R>(packet, ray_of))
        bvh.occluded(packet, false, blocked);
    else
        std::fill(blocked, blocked + trace_width, false);
}

/// The closest hit of a single ray.
template <class R>
bool closest1(const Bvh& bvh, const RayQuery<R>& one, PacketHits& found) {
    closest16<R>(
        bvh, false,
        [&](int k, RayQuery<R>& query) {
            query = one;
            return k == 0;
        },
        found);
    return found.primitive[0] >= 0;
}

}  // namespace photograd
