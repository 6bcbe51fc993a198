// Textures as the batch functions take them: a view of (H, W, C) scalars with C from 1 to 4.
#pragma once

#include <type_traits>
#include <utility>

#include "photograd/core/real.h"
#include "photograd/ops/bilinear.h"

namespace photograd {

/// T is a number type, const for a texture that is only read.
template <class T>
struct ImageView {
    T* texels;
    TextureShape shape;
    int channels;
};

template <class T>
ImageView<const T> read_only(const ImageView<T>& view) {
    return {view.texels, view.shape, view.channels};
}

inline constexpr int max_channels = 4;

/// Calls use(std::integral_constant<int, channels>) so that loops over channels have a fixed
/// length.
template <class Use>
void with_channels(int channels, Use&& use) {
    const auto match = [&]<int C>(std::integral_constant<int, C> fixed) {
        if (channels == C) use(fixed);
    };
    [&]<int... C>(std::integer_sequence<int, C...>) {
        (match(std::integral_constant<int, C + 1>{}), ...);
    }(std::make_integer_sequence<int, max_channels>{});
}

}  // namespace photograd
