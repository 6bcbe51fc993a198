#include "photograd/light/environment_sampler.h"

#include <string>

#include "photograd/core/errors.h"
#include "photograd/light/luminance.h"

namespace photograd {
namespace {

constexpr double brightest = 1e30;  // squares and sums stay numbers

template <class R>
void check_texels(std::span<const R> texels, std::int64_t width) {
    std::int64_t bad = 0, first = -1;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        if (texels[i] >= R(0) && texels[i] <= R(brightest)) continue;
        if (bad++ == 0) first = static_cast<std::int64_t>(i) / 3;
    }
    if (bad > 0)
        fail(ErrorKind::range, "EnvironmentSampler", "texels", "numbers from 0 to 1e30",
             std::to_string(bad) + " that are not, the first in row " +
                 std::to_string(first / width) + ", column " + std::to_string(first % width),
             "repair the picture, for example with numpy.nan_to_num and numpy.maximum");
}

/// 1 - cos(theta) = 2 sin^2(theta / 2) at the rows' centers, between those of the poles.
std::vector<double> band_edges(int height) {
    std::vector<double> drop(static_cast<std::size_t>(height) + 2);
    for (int row = 0; row < height; ++row) {
        const double half = sin_cos((row + 0.5) / height * (pi / 2)).sin;
        drop[static_cast<std::size_t>(row) + 1] = 2 * half * half;
    }
    drop.back() = 2.0;
    return drop;
}

}  // namespace

template <Real R>
EnvironmentSampler::EnvironmentSampler(std::span<const R> texels, int height, double uniform_share)
    : height_(height), drop_(band_edges(height)) {
    const std::int64_t width = 2 * static_cast<std::int64_t>(height);
    if (height < 1 || texels.size() != static_cast<std::size_t>(3 * width * height))
        fail(ErrorKind::shape, "EnvironmentSampler", "texels", "shape (H, 2 H, 3)",
             std::to_string(texels.size()) + " numbers for a height of " + std::to_string(height));
    if (!(uniform_share >= 0.0 && uniform_share <= 1.0))
        fail(ErrorKind::range, "EnvironmentSampler", "uniform_share", "a number in [0, 1]",
             std::to_string(uniform_share));
    check_texels(texels, width);
    brightness_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < brightness_.size(); ++i)
        brightness_[i] = static_cast<float>(luminance(&texels[3 * i]));
    const auto mass = [&](std::int64_t band, std::int64_t column) {
        const auto k = static_cast<std::size_t>(band);
        return corners(band, column).mean() * (drop_[k + 1] - drop_[k]);
    };
    cells_ = Distribution2D(height + 1, width, mass);
    // The sphere's mean brightness, everywhere, is the uniform part of the mixture.
    const double mean = cells_.total() / (2.0 * static_cast<double>(width));
    flux_ = 4 * pi * mean;
    const bool dark = !(mean > 0.0);
    for (float& b : brightness_)
        b = dark ? 1.0f : static_cast<float>((1 - uniform_share) * b + uniform_share * mean);
    if (dark || uniform_share > 0.0) cells_ = Distribution2D(height + 1, width, mass);
    density_scale_ = 1 / (cells_.total() * (2 * pi / static_cast<double>(width)));
}

template EnvironmentSampler::EnvironmentSampler(std::span<const float>, int, double);
template EnvironmentSampler::EnvironmentSampler(std::span<const double>, int, double);

/// Column k of a band reaches from the center of texel k to that of its right neighbor; band k
/// lies between the rows k - 1 and k, where they exist.
BilinearPatch<double> EnvironmentSampler::corners(std::int64_t band, std::int64_t column) const {
    const std::int64_t width = 2 * static_cast<std::int64_t>(height_);
    const std::int64_t upper = std::max<std::int64_t>(band - 1, 0) * width;
    const std::int64_t lower = std::min<std::int64_t>(band, height_ - 1) * width;
    const std::int64_t right = column + 1 < width ? column + 1 : 0;
    const auto at = [&](std::int64_t i) {
        return static_cast<double>(brightness_[static_cast<std::size_t>(i)]);
    };
    return {at(upper + column), at(upper + right), at(lower + column), at(lower + right)};
}

SampledDirection EnvironmentSampler::sample(const Vec2<double>& u2) const {
    const CellChoice cell = cells_.sample(u2.y, u2.x);
    const BilinearPatch<double> patch = corners(cell.row, cell.column);
    const Vec2<double> in = patch.sample(cell.rest_column, cell.rest_row);
    const auto k = static_cast<std::size_t>(cell.row);
    const double beyond = (static_cast<double>(cell.column) + 0.5 + in.x) / (2.0 * height_);
    const double u = beyond < 1 ? beyond : beyond - 1;
    return {direction_from_lat_long(u, drop_[k] + in.y * (drop_[k + 1] - drop_[k])), u,
            density_scale_ * patch.at(in.x, in.y)};
}

double EnvironmentSampler::pdf(const LatLong& map_point) const {
    const TexelPair column = columns_at(map_point.u, 2 * height_);
    const auto band = static_cast<std::size_t>(
        smaller(double(height_), larger(0.0, map_point.v * height_ + 0.5)));
    const double s = (map_point.drop - drop_[band]) / (drop_[band + 1] - drop_[band]);
    return density_scale_ * corners(static_cast<std::int64_t>(band), column.first)
                                .at(column.fraction, clamped(s, 0.0, 1.0));
}

}  // namespace photograd
