// world_from_object: three rows of four numbers, rotation, scale and shear in the first three
// columns, translation in the last.
#pragma once

#include <array>

#include "photograd/core/vec.h"

namespace photograd {

struct Affine {
    std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // row by row

    template <class R>
    [[nodiscard]] Vec3<R> point(const Vec3<R>& p) const {
        Vec3<R> out;
        for (int i = 0; i < 3; ++i) {
            const double* row = m.data() + 4 * i;
            out[i] = R(row[0]) * p.x + R(row[1]) * p.y + R(row[2]) * p.z + R(row[3]);
        }
        return out;
    }
    [[nodiscard]] double determinant() const {
        return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
               m[2] * (m[4] * m[9] - m[5] * m[8]);
    }
    [[nodiscard]] bool is_identity() const { return m == Affine{}.m; }
    /// Each point on its straight way from here to there, at a time from 0 to 1.
    [[nodiscard]] Affine towards(const Affine& there, double time) const {
        Affine out;
        for (std::size_t i = 0; i < m.size(); ++i) out.m[i] = (1 - time) * m[i] + time * there.m[i];
        return out;
    }
};

}  // namespace photograd
