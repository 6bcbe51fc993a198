// A pinhole camera: +X right, +Y down, +Z forward; the center of the top left pixel is (0.5, 0.5).
#pragma once

#include <cmath>

#include "photograd/core/ray.h"

namespace photograd {

struct Pinhole {
    int width, height;
    double fx, fy, cx, cy;           // pixels
    double world_from_camera[3][4];  // rigid

    /// The ray through the point (x, y) of the image, in pixels; its direction has unit length.
    template <class R>
    [[nodiscard]] Ray<R> ray(R x, R y) const {
        const Vec3<R> local = normalize(Vec3<R>((x - R(cx)) / R(fx), (y - R(cy)) / R(fy), R(1)));
        Ray<R> out;
        for (int i = 0; i < 3; ++i) {
            const double* row = world_from_camera[i];
            out.origin[i] = R(row[3]);
            out.direction[i] = R(row[0]) * local.x + R(row[1]) * local.y + R(row[2]) * local.z;
        }
        return out;
    }
    /// The directions of N such rays, with the same bits; lanes of one instruction where R has any.
    template <class R, int N>
    void directions(const R (&x)[N], const R (&y)[N], R (&out)[3][N]) const {
        const R scale_x = R(fx), scale_y = R(fy), mid_x = R(cx), mid_y = R(cy);
        for (int k = 0; k < N; ++k) {
            const R u = (x[k] - mid_x) / scale_x, v = (y[k] - mid_y) / scale_y;
            const R s = R(1) / std::sqrt(u * u + v * v + R(1));
            out[0][k] = u * s;
            out[1][k] = v * s;
            out[2][k] = s;
        }
        R m[3][3];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] = R(world_from_camera[i][j]);
        for (int k = 0; k < N; ++k) {
            const R u = out[0][k], v = out[1][k], s = out[2][k];
            for (int i = 0; i < 3; ++i) out[i][k] = m[i][0] * u + m[i][1] * v + m[i][2] * s;
        }
    }
};

}  // namespace photograd
