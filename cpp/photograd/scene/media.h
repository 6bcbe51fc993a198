// Which medium a path is in. A closed shape has an interior: a medium, or nothing; what no shape contains lies in the
// world's medium, or in nothing.
//
// A path remembers the shapes that it has entered and not left. It is in the interior of the last of them, so that a ball of
// glass in fog holds no fog, and bubbles may lie in the glass. A shape whose surface is a mere boundary bends no ray and
// reflects nothing: there is a medium on one side and another on the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "photograd/medium/density_grid.h"

namespace photograd {

struct MediaGeometry {
    /// Interiors that are no medium: nothing, and whatever is around (crossing the shape changes nothing).
    static constexpr std::int32_t vacuum = -1, unchanged = -2;

    std::vector<std::int32_t> interior;  // of each shape
    std::vector<bool> boundary;          // of each shape: whether it is a boundary and nothing else
    std::int32_t world = vacuum;
    std::vector<DensityLayout> grids;  // of each medium

    /// Whether light is anywhere affected by what is between surfaces, or surfaces are invisible.
    [[nodiscard]] bool any() const { return !interior.empty(); }
};

/// The shapes around a point of a path, the innermost last.
class Surroundings {
public:
    static constexpr int deepest = 8;  // of shapes within one another; further ones are not noticed

    void cross(const MediaGeometry& media, std::int32_t shape, bool entering) {
        if (media.interior[static_cast<std::size_t>(shape)] == MediaGeometry::unchanged) return;
        count_ = static_cast<int>(std::remove(shapes_, shapes_ + count_, shape) - shapes_);
        if (entering && count_ < deepest) shapes_[count_++] = shape;
    }
    /// Number of the medium here, or MediaGeometry::vacuum.
    [[nodiscard]] std::int32_t medium(const MediaGeometry& media) const {
        return count_ > 0 ? media.interior[static_cast<std::size_t>(shapes_[count_ - 1])]
                          : media.world;
    }

private:
    std::int32_t shapes_[deepest];
    int count_ = 0;
};

}  // namespace photograd
