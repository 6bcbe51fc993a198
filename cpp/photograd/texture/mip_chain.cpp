#include "photograd/texture/mip_chain.h"

#include "photograd/core/parallel.h"

namespace photograd {
namespace {

/// Calls visit(coarse, weight) for the texels of the next level that texel i of n is part of.
template <class Visit>
void for_each_part(int n, int i, Visit&& visit) {
    for (int j = larger(i / 2 - 1, 0); j <= smaller(i / 2, half_size(n) - 1); ++j) {
        const BoxTaps taps = box_taps(n, j);
        const int tap = i - taps.first;
        if (tap < taps.count) visit(j, taps.weight[tap]);
    }
}

}  // namespace

std::vector<TextureShape> mip_shapes(TextureShape shape) {
    std::vector<TextureShape> shapes{shape};
    while (shape.texels() > 1) {
        shape = {half_size(shape.height), half_size(shape.width)};
        shapes.push_back(shape);
    }
    return shapes;
}

template <Real R>
void halve(const ImageView<const R>& fine, const ImageView<R>& coarse) {
    const int channels = fine.channels, width = coarse.shape.width;
    parallel_for(coarse.shape.height, [&](std::int64_t i) {
        const BoxTaps rows = box_taps(fine.shape.height, static_cast<int>(i));
        for (int j = 0; j < width; ++j) {
            const BoxTaps columns = box_taps(fine.shape.width, j);
            for (int c = 0; c < channels; ++c) {
                double mean = 0;
                for (int y = 0; y < rows.count; ++y)
                    for (int x = 0; x < columns.count; ++x) {
                        const std::int64_t texel =
                            std::int64_t(rows.first + y) * fine.shape.width + columns.first + x;
                        mean += rows.weight[y] * columns.weight[x] *
                                static_cast<double>(fine.texels[texel * channels + c]);
                    }
                coarse.texels[(i * width + j) * channels + c] = static_cast<R>(mean);
            }
        }
    });
}

// Each row of d_fine collects what it is part of: nothing is shared between rows.
template <Real R>
void halve_backward(const ImageView<const R>& d_coarse, const ImageView<R>& d_fine) {
    const auto [height, width] = d_fine.shape;
    const int channels = d_fine.channels;
    parallel_for(height, [&, width = width, height = height](std::int64_t i) {
        for (int j = 0; j < width; ++j)
            for (int c = 0; c < channels; ++c) {
                double sum = 0;
                for_each_part(height, static_cast<int>(i), [&](int row, double row_weight) {
                    for_each_part(width, j, [&](int column, double column_weight) {
                        const std::int64_t texel =
                            std::int64_t(row) * d_coarse.shape.width + column;
                        sum += row_weight * column_weight *
                               static_cast<double>(d_coarse.texels[texel * channels + c]);
                    });
                });
                d_fine.texels[(i * width + j) * channels + c] += static_cast<R>(sum);
            }
    });
}

template void halve(const ImageView<const float>&, const ImageView<float>&);
template void halve(const ImageView<const double>&, const ImageView<double>&);
template void halve_backward(const ImageView<const float>&, const ImageView<float>&);
template void halve_backward(const ImageView<const double>&, const ImageView<double>&);

}  // namespace photograd
