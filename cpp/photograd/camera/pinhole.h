// A pinhole camera: +X right, +Y down, +Z forward; the center of the top left pixel is (0.5, 0.5).
#pragma once

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
};

}  // namespace photograd
