// Luminance of a color, the weight by which lights and directions are sampled.
#pragma once

namespace photograd {

/// Rec. 709 of linear (3,) values. Every channel counts, so that no light is left out.
template <class R>
double luminance(const R* color) {
    return 0.2126 * double(color[0]) + 0.7152 * double(color[1]) + 0.0722 * double(color[2]);
}

}  // namespace photograd
