// Ambient occlusion from the horizons around each pixel [Bavoil2008], in closed form within a slice
// [Jimenez2016].
//
// A slice is a plane through the line of sight. In it, the surface sees the sky between two
// horizons, at the angles h0 < 0 < h1 from the direction v towards the viewer. With n the angle of
// the normal's projection onto the slice, and p its length,
//
//   visible = p sum_j (cos n + 2 h_j sin n - cos(2 h_j - n)) / 4,
//
// which is the integral of max(0, cos(theta - n)) |sin theta| over the angles between. The open
// slice, h_j = n +- pi / 2, has p (cos n + n sin n). The result is the ratio of the sums over all
// slices: 1 on flat walls, however they are turned, for any number of slices.
#pragma once

#include <cstdint>

#include "photograd/frame/screen.h"

namespace photograd {

inline constexpr int max_horizon_slices = 64, max_horizon_steps = 256;

/// `radius` in meters: what is further away hides nothing; from radius (1 - falloff) on, it hides
/// less and less.
template <class R>
struct HorizonSettings {
    R radius, falloff;
    int slices, steps;
};

/// out (H, W), 0 to 1; 1 where nothing is seen.
template <Real R>
void horizon_occlusion(const ScreenFrame<R>& frame, const HorizonSettings<R>& settings, R* out);

}  // namespace photograd
