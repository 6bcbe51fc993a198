// Medium stacks. A closed shape has an interior: a medium, or vacuum; outside of all
// shapes there is the world's medium, or vacuum.
//
// A path keeps a stack of the shapes that it has entered and not left, and is in the interior of
// the last of them: a glass ball in fog holds no fog, and bubbles may lie in the glass. A shape may
// be a boundary between media and nothing else: it neither bends nor reflects.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "photograd/medium/density_grid.h"

namespace photograd {

struct MediaGeometry {
    /// Interiors that are no medium: vacuum, and `unchanged`, where crossing the shape has no
    /// effect.
    static constexpr std::int32_t vacuum = -1, unchanged = -2;

    std::vector<std::int32_t> interior;  // of each shape
    std::vector<bool> boundary;          // of each shape: whether it is a boundary and nothing else
    std::int32_t world = vacuum;
    std::vector<DensityLayout> grids;  // of each medium

    /// Whether the scene has media, or shapes that are boundaries of vacuum.
    [[nodiscard]] bool any() const { return !interior.empty(); }
};

/// The shapes around a point of a path, the innermost last (nested dielectrics' interior list).
class MediumStack {
public:
    static constexpr int max_depth = 8;  // of shapes within one another; further ones are ignored

    void cross(const MediaGeometry& media, std::int32_t shape, bool entering) {
        if (media.interior[static_cast<std::size_t>(shape)] == MediaGeometry::unchanged) return;
        count_ = static_cast<int>(std::remove(shapes_, shapes_ + count_, shape) - shapes_);
        if (entering && count_ < max_depth) shapes_[count_++] = shape;
    }
    /// Number of the medium here, or MediaGeometry::vacuum.
    [[nodiscard]] std::int32_t medium(const MediaGeometry& media) const {
        return count_ > 0 ? media.interior[static_cast<std::size_t>(shapes_[count_ - 1])]
                          : media.world;
    }

private:
    std::int32_t shapes_[max_depth];
    int count_ = 0;
};

}  // namespace photograd
