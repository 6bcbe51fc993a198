// Rays that are followed through the depths of a frame, which is all that they can meet.
#pragma once

#include <cstdint>

#include "photograd/frame/screen.h"

namespace photograd {

inline constexpr std::int32_t ray_missed = -1, ray_left_frame = -2;
inline constexpr int max_screen_steps = 4096;

/// A ray is looked at in `steps` points of its picture, equally far apart and turned by a pattern
/// of 4 x 4 pixels. It has met the frame where that is nearer than the ray, by no more than
/// `thickness`, and faces it.
template <class R>
struct ScreenRays {
    R length, thickness;  // meters
    int steps;
};

/// From the surface in each pixel along wi (H, W, 3), unit vectors of the camera: hit (H, W) is the
/// pixel y W + x whose surface the ray meets, ray_missed where it meets none, and ray_left_frame
/// where it leaves the picture, or the space before the camera, before its end. Pixels that show
/// nothing miss.
template <Real R>
void follow_screen_rays(const ScreenFrame<R>& frame, const ScreenRays<R>& rays, const R* wi,
                        std::int32_t* hit);

}  // namespace photograd
