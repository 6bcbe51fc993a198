// An orthonormal frame around a normal. In the shading frame the normal is +Z.
#pragma once

#include "photograd/core/vec.h"

namespace photograd {

template <class R>
struct Frame {
    Vec3<R> tangent, bitangent, normal;

    /// Branchless construction from a unit normal [Duff2017].
    static Frame from_normal(const Vec3<R>& n) {
        const R sign = n.z < R(0) ? R(-1) : R(1);
        const R a = R(-1) / (sign + n.z);
        const R b = n.x * n.y * a;
        return {{R(1) + sign * n.x * n.x * a, sign * b, -sign * n.x},
                {b, sign + n.y * n.y * a, -n.y},
                n};
    }
    [[nodiscard]] Vec3<R> to_local(const Vec3<R>& v) const {
        return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
    }
    [[nodiscard]] Vec3<R> to_world(const Vec3<R>& v) const {
        return v.x * tangent + v.y * bitangent + v.z * normal;
    }
};

}  // namespace photograd
