// Attributes of vertices at the points that pixels see: a = b_0 a_0 + b_1 a_1 + b_2 a_2 with the
// perspective-correct barycentrics of triangle.h, b_0 = 1 - b_1 - b_2. A pixel that sees nothing
// gets zeros.
//
//   d_a_i += b_i d_a      d_b_1 = <d_a, a_1 - a_0>      d_b_2 = <d_a, a_2 - a_0>
#pragma once

#include <cstdint>
#include <span>

namespace photograd {

/// What pixels see of a mesh with F faces; numbers outside of [0, F) see nothing.
struct VisibleFaces {
    std::span<const std::int32_t> face;  // (P,)
    const double* barycentrics;          // (P, 2)
    std::span<const std::uint32_t> faces;
};

/// attributes (V, C) to out (P, C).
void interpolate(const VisibleFaces& visible, const double* attributes, std::int64_t channels,
                 double* out);
/// Adds to d_attributes (V, C) and writes d_barycentrics (P, 2).
void interpolate_backward(const VisibleFaces& visible, const double* attributes,
                          std::int64_t vertices, std::int64_t channels, const double* d_out,
                          double* d_attributes, double* d_barycentrics);

}  // namespace photograd
