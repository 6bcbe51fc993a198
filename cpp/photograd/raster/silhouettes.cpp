#include "photograd/raster/silhouettes.h"

#include <algorithm>

#include "photograd/core/parallel.h"
#include "photograd/core/vec.h"

namespace photograd {

void find_silhouettes(std::span<const double> positions, std::span<const std::uint32_t> ends,
                      std::span<const std::int32_t> opposite, std::uint8_t* silhouette) {
    const auto vertex = [&](std::size_t i) {
        return Vec3<double>(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    };
    const std::size_t edges = ends.size() / 2;
    constexpr std::size_t piece = 4096;
    parallel_for(static_cast<std::int64_t>((edges + piece - 1) / piece), [&](std::int64_t p) {
        const std::size_t first = static_cast<std::size_t>(p) * piece;
        for (std::size_t e = first; e < std::min(edges, first + piece); ++e) {
            const std::int32_t* third = &opposite[2 * e];
            silhouette[e] = 1;
            if (third[0] < 0 || third[1] < 0) continue;
            const Vec3<double> line = cross(vertex(ends[2 * e]), vertex(ends[2 * e + 1]));
            const double one = dot(line, vertex(static_cast<std::size_t>(third[0])));
            const double other = dot(line, vertex(static_cast<std::size_t>(third[1])));
            silhouette[e] = (one < 0 && other > 0) || (one > 0 && other < 0) ? 0 : 1;
        }
    });
}

}  // namespace photograd
