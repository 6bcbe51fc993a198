#include "photograd/texture/packed_mips.h"

#include <algorithm>

namespace photograd {

template <Real R>
std::vector<R> packed_levels(const PackedMips& mips, const R* texels, int channels) {
    std::vector<R> packed(static_cast<std::size_t>(mips.texels() * channels));
    std::copy_n(texels, mips.shapes[0].texels() * channels, packed.begin());
    for (int k = 0; k + 1 < mips.count(); ++k)
        halve<R>(mips.level<const R>(packed.data(), k, channels),
                 mips.level(packed.data(), k + 1, channels));
    return packed;
}

template <Real R>
void packed_levels_backward(const PackedMips& mips, const R* packed, int channels,
                            std::span<const R> uv, std::span<const R> level,
                            std::span<const R> d_color, R* d_texels) {
    std::vector<R> d_packed(static_cast<std::size_t>(mips.texels() * channels), R(0));
    std::vector<ImageView<const R>> values;
    std::vector<ImageView<R>> d_values;
    for (int k = 0; k < mips.count(); ++k) {
        values.push_back(mips.level(packed, k, channels));
        d_values.push_back(mips.level(d_packed.data(), k, channels));
    }
    sample_mips_backward<R>(values, uv.data(), level.data(),
                            static_cast<std::int64_t>(level.size()), d_color.data(), d_values,
                            nullptr, nullptr);
    for (int k = mips.count() - 1; k > 0; --k)
        halve_backward<R>(mips.level<const R>(d_packed.data(), k, channels),
                          mips.level(d_packed.data(), k - 1, channels));
    const std::int64_t own = mips.shapes[0].texels() * channels;
    for (std::int64_t i = 0; i < own; ++i) d_texels[i] += d_packed[static_cast<std::size_t>(i)];
}

template std::vector<float> packed_levels(const PackedMips&, const float*, int);
template std::vector<double> packed_levels(const PackedMips&, const double*, int);
template void packed_levels_backward(const PackedMips&, const float*, int, std::span<const float>,
                                     std::span<const float>, std::span<const float>, float*);
template void packed_levels_backward(const PackedMips&, const double*, int, std::span<const double>,
                                     std::span<const double>, std::span<const double>, double*);

}  // namespace photograd
