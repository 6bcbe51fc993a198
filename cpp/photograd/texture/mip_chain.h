// Mip maps: a texture and its averages over ever larger squares [Williams1983].
//
// Level 0 is the texture; an axis of n texels has m = n / 2 on the next level, rounded down and at
// least 1. A texel of the next level is the mean of the area that it covers, n / m texels wide
// [Guthe2005]:
//
//   n = 1      the texel itself
//   n = 2 m    texels 2j, 2j + 1                 with weights 1/2, 1/2
//   n = 2m+1   texels 2j, 2j + 1, 2j + 2         with weights (m - j, m, j + 1) / (2m + 1)
//
// Along both axes the weights multiply. They add up to one, so constants stay, and every texel's
// weights in all the next level's texels add up to the same, m / n, so the mean of the picture
// stays. For even n affine pictures keep their values at the centers; for odd n they move by at
// most (m - 1) / (2m (2m + 1)) of a texel, since texels at the edge of the covered area count with
// the color of their center.
//
// The map is linear: its adjoint distributes each texel's derivative with the same weights.
#pragma once

#include <vector>

#include "photograd/texture/image.h"

namespace photograd {

struct BoxTaps {
    int first, count;
    double weight[3];
};

/// Size of an axis on the next level.
constexpr int half_size(int n) { return n > 1 ? n / 2 : 1; }

/// Texels of an axis of n that are averaged to texel j of the next level.
inline BoxTaps box_taps(int n, int j) {
    if (n == 1) return {0, 1, {1, 0, 0}};
    if (n % 2 == 0) return {2 * j, 2, {0.5, 0.5, 0}};
    const int m = n / 2;
    return {2 * j, 3, {double(m - j) / n, double(m) / n, double(j + 1) / n}};
}

/// Shapes of all levels, the last one a single texel.
std::vector<TextureShape> mip_shapes(TextureShape shape);

/// coarse = means of fine; their shapes are neighbors in mip_shapes.
template <Real R>
void halve(const ImageView<const R>& fine, const ImageView<R>& coarse);

/// d_fine += adjoint of d_coarse.
template <Real R>
void halve_backward(const ImageView<const R>& d_coarse, const ImageView<R>& d_fine);

}  // namespace photograd
