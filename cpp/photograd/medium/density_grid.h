// A density grid of a heterogeneous medium: values (X, Y, Z) at the voxels' centers of a box in the
// world.
//
// box_from_world takes the box to [0, 1]^3; voxel i of n sits at (i + 1/2) / n. Between centers the
// density is trilinear (ops/trilinear.h), from the outermost centers to the box's sides it stays,
// and outside it is 0. It is linear in the values, whose derivatives are the weights of the lookup.
#pragma once

#include <array>
#include <vector>

#include "photograd/core/vec.h"
#include "photograd/ops/trilinear.h"

namespace photograd {

/// shape.x = 0: no grid.
struct DensityLayout {
    GridShape shape{0, 0, 0};
    std::array<double, 12> box_from_world{};  // rows of (3, 4), to [0, 1]^3

    [[nodiscard]] bool empty() const { return shape.x == 0; }
    /// A point, or with last = 0 a direction, in the box's coordinates.
    template <class R>
    [[nodiscard]] Vec3<R> in_box(const Vec3<R>& v, R last) const {
        Vec3<R> q;
        for (int i = 0; i < 3; ++i) {
            const double* row = box_from_world.data() + 4 * i;
            q[i] = R(row[0]) * v.x + R(row[1]) * v.y + R(row[2]) * v.z + R(row[3]) * last;
        }
        return q;
    }
    /// The point of the world with these coordinates in the box; the inverse is by cofactors.
    [[nodiscard]] Vec3<double> in_world(const Vec3<double>& q) const {
        const auto row = [&](std::size_t i) {
            const double* m = box_from_world.data() + 4 * i;
            return Vec3<double>(m[0], m[1], m[2]);
        };
        const Vec3<double> a = row(0), b = row(1), c = row(2);
        const Vec3<double> p =
            q - Vec3<double>(box_from_world[3], box_from_world[7], box_from_world[11]);
        return (cross(b, c) * p.x + cross(c, a) * p.y + cross(a, b) * p.z) *
               (1 / dot(a, cross(b, c)));
    }
    /// Cuts [t0, t1] of a ray down to what lies in the box; t1 < t0 where nothing does.
    template <class R>
    void clip(const Vec3<R>& origin, const Vec3<R>& direction, R& t0, R& t1) const {
        const Vec3<R> o = in_box(origin, R(1)), d = in_box(direction, R(0));
        for (int i = 0; i < 3; ++i) {
            if (d[i] == R(0)) {
                if (o[i] < R(0) || o[i] > R(1)) t1 = R(-1);
                continue;
            }
            const R a = -o[i] / d[i], b = (R(1) - o[i]) / d[i];
            t0 = larger(t0, smaller(a, b));
            t1 = smaller(t1, larger(a, b));
        }
    }
};

/// The eight voxels around a point and their weights.
template <class R>
struct DensityTaps {
    AxisWeights<R> x, y, z;
    bool inside = false;

    DensityTaps(const DensityLayout& layout, const Vec3<R>& world) {
        const Vec3<R> q = layout.in_box(world, R(1));
        inside = true;
        for (int i = 0; i < 3; ++i) inside = inside && q[i] >= R(0) && q[i] <= R(1);
        if (!inside) return;
        const GridShape& n = layout.shape;
        x = axis_weights(q[0] * R(n.x) - R(0.5), n.x, Border::clamp);
        y = axis_weights(q[1] * R(n.y) - R(0.5), n.y, Border::clamp);
        z = axis_weights(q[2] * R(n.z) - R(0.5), n.z, Border::clamp);
    }
};

template <class R>
R density_at(const DensityLayout& layout, const R* values, const Vec3<R>& world) {
    const DensityTaps<R> taps(layout, world);
    if (!taps.inside) return R(0);
    R out[1];
    trilinear<R, 1>(values, layout.shape, taps.x, taps.y, taps.z, out);
    return out[0];
}

/// Lookups of one grid and their derivatives, not yet added up: world (N, 3), d_density (N,).
template <class R>
struct DensityAdjoint {
    std::vector<R> world, d_density;
};

}  // namespace photograd
