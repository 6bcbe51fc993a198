// A thin lens camera: depth of field, sharp in one plane.
//
// All rays through a point (x, y) of the image meet in one point of the plane z = focus:
//
//   origin = radius (l_x, l_y, 0)
//   target = focus ((x - cx) / fx, (y - cy) / fy, 1),   direction ~ target - origin
//
// with l in the unit disc. A point on the axis at depth z is then seen by all image points within
//
//   f radius |1 / focus - 1 / z|                        pixels, the circle of confusion
//
// of the center [Cook1984]. With radius 0 it is the pinhole.
#pragma once

#include "photograd/camera/camera_motion.h"
#include "photograd/camera/pinhole.h"

namespace photograd {

struct ThinLens : Pinhole {
    double radius = 0, focus = 1;  // meters
    CameraMotion motion;           // while the shutter is open

    using Pinhole::ray;
    /// The ray through the point (x, y) of the image and the point `lens` of the unit disc.
    template <class R>
    [[nodiscard]] Ray<R> ray(R x, R y, const Vec2<R>& lens) const {
        const Vec3<R> start(R(radius) * lens.x, R(radius) * lens.y, R(0));
        const Vec3<R> target = R(focus) * Vec3<R>((x - R(cx)) / R(fx), (y - R(cy)) / R(fy), R(1));
        const Vec3<R> local = normalize(target - start);
        Ray<R> out;
        for (int i = 0; i < 3; ++i) {
            const double* row = world_from_camera[i];
            const Vec3<R> axis{R(row[0]), R(row[1]), R(row[2])};
            out.origin[i] = R(row[3]) + dot(axis, start);
            out.direction[i] = dot(axis, local);
        }
        return out;
    }
    /// Where the camera is at a time from 0 to 1.
    [[nodiscard]] ThinLens at(double time) const {
        ThinLens now = *this;
        motion.apply(time, now.world_from_camera);
        return now;
    }
};

}  // namespace photograd
