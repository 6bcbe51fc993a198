#include "photograd/raster/interpolate.h"

#include <algorithm>
#include <vector>

#include "photograd/core/parallel.h"
#include "photograd/raster/owner_sums.h"

namespace photograd {
namespace {

constexpr std::size_t pixels_per_piece = 1024;

/// visit(pixel, face) for each pixel that sees a face, in parallel.
template <class Visit>
void for_visible(const VisibleFaces& visible, Visit&& visit) {
    const std::size_t pixels = visible.face.size(), faces = visible.faces.size() / 3;
    const auto pieces = (pixels + pixels_per_piece - 1) / pixels_per_piece;
    parallel_for(static_cast<std::int64_t>(pieces), [&](std::int64_t p) {
        const std::size_t first = static_cast<std::size_t>(p) * pixels_per_piece;
        for (std::size_t i = first; i < std::min(pixels, first + pixels_per_piece); ++i) {
            const auto face = static_cast<std::size_t>(visible.face[i]);
            if (visible.face[i] >= 0 && face < faces) visit(i, face);
        }
    });
}

}  // namespace

void interpolate(const VisibleFaces& visible, const double* attributes, std::int64_t channels,
                 double* out) {
    const auto width = static_cast<std::size_t>(channels);
    for_visible(visible, [&](std::size_t i, std::size_t face) {
        const std::uint32_t* corner = &visible.faces[3 * face];
        const double b1 = visible.barycentrics[2 * i], b2 = visible.barycentrics[2 * i + 1];
        const double b0 = 1 - b1 - b2;
        for (std::size_t c = 0; c < width; ++c)
            out[width * i + c] = b0 * attributes[width * corner[0] + c] +
                                 b1 * attributes[width * corner[1] + c] +
                                 b2 * attributes[width * corner[2] + c];
    });
}
void interpolate_backward(const VisibleFaces& visible, const double* attributes,
                          std::int64_t vertices, std::int64_t channels, const double* d_out,
                          double* d_attributes, double* d_barycentrics) {
    const auto width = static_cast<std::size_t>(channels);
    const std::size_t pixels = visible.face.size(), faces = visible.faces.size() / 3;
    std::vector<std::uint32_t> owner(pixels, static_cast<std::uint32_t>(faces));
    std::vector<double> by_pixel(3 * width * pixels);
    for_visible(visible, [&](std::size_t i, std::size_t face) {
        const std::uint32_t* corner = &visible.faces[3 * face];
        const double b1 = visible.barycentrics[2 * i], b2 = visible.barycentrics[2 * i + 1];
        const double b[3] = {1 - b1 - b2, b1, b2};
        double along[3] = {};
        owner[i] = static_cast<std::uint32_t>(face);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < width; ++c) {
                by_pixel[width * (3 * i + k) + c] = b[k] * d_out[width * i + c];
                along[k] += attributes[width * corner[k] + c] * d_out[width * i + c];
            }
        d_barycentrics[2 * i] = along[1] - along[0];
        d_barycentrics[2 * i + 1] = along[2] - along[0];
    });
    std::vector<double> by_face(3 * width * faces, 0.0);
    add_to_owners(owner, static_cast<std::int64_t>(faces), by_pixel.data(), 3 * channels,
                  by_face.data());
    add_to_owners(visible.faces, vertices, by_face.data(), channels, d_attributes);
}

}  // namespace photograd
