// How large a number of a scene may be.
//
// Embree and the lights calculate in float32, which ends at 3.4e38. With coordinates and lengths up
// to 1e15, products of two (areas, squared distances) and sums of them stay finite, and a transform
// may still enlarge a thousandfold before coordinates reach Embree's own bound of 1.8e18.
#pragma once

#include <cstdio>
#include <string>

namespace photograd {

inline constexpr double world_limit = 1e15;  // meters, in scene files: BEYOND of scene_node.py

/// A number for a message: `1e+15`, `0.25`.
inline std::string number_text(double x) {
    char text[32];
    std::snprintf(text, sizeof(text), "%g", x);
    return text;
}

}  // namespace photograd
