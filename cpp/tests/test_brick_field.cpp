// Scatter into bricks: the same bits on any number of threads, and (in the build for it) no race.
#include <doctest/doctest.h>

#include <cmath>

#include "photograd/grid/brick_field.h"

using namespace photograd;

namespace {

/// 2 x 2 x 2 bricks in which every third voxel is missing, and points that leave them on all sides.
struct Setting {
    static constexpr int channels = 4, points = 20000;
    std::vector<std::int32_t> origins;
    std::vector<std::uint8_t> active;
    std::vector<float> at, values, background, d_out;

    Setting() {
        for (std::int32_t b = 0; b < 8; ++b)
            for (const std::int32_t axis : {b >> 2, b >> 1 & 1, b & 1}) origins.push_back(8 * axis);
        active.resize(8 * 512);
        for (std::size_t v = 0; v < active.size(); ++v) active[v] = v % 3 != 0;
        for (int p = 0; p < 3 * points; ++p) at.push_back(-1.5f + 18.0f * random(p));
        for (int p = 0; p < channels * points; ++p) d_out.push_back(random(p + 7) - 0.5f);
        background.assign(channels, 0.25f);
        values.assign(active.size() * channels, 0.5f);
    }
    /// A fraction in [0, 1) from a multiplicative hash.
    static float random(int i) {
        const auto word = (static_cast<std::uint32_t>(i) + 1u) * 2654435761u;
        return static_cast<float>(word >> 8) / static_cast<float>(1u << 24);
    }
};

struct Gradients {
    std::vector<float> values, background, points;
    bool operator==(const Gradients&) const = default;
};

Gradients scatter(const Setting& s, int threads) {
    const BrickTopology topology(s.origins, s.active, 1 << 30);
    const BrickField<float> field{&topology, s.values.data(), s.background.data(), s.channels};
    Gradients g{std::vector<float>(static_cast<std::size_t>(topology.voxels()) * s.channels),
                std::vector<float>(s.channels), std::vector<float>(s.at.size())};
    set_thread_count(threads);
    sample_bricks_backward<float>(field, {s.at.data(), s.points}, s.d_out.data(), g.values.data(),
                                  g.background.data(), g.points.data());
    set_thread_count(0);
    return g;
}

}  // namespace

TEST_CASE("contributions to bricks add up to the same bits on 1, 2 and 5 threads") {
    const Setting s;
    const Gradients one = scatter(s, 1);
    CHECK(scatter(s, 2) == one);
    CHECK(scatter(s, 5) == one);
}

TEST_CASE("nothing of a cotangent is lost between values and background") {
    // The weights of a lookup add up to one, so what all points send arrives somewhere.
    const Setting s;
    const Gradients g = scatter(s, 2);
    for (std::size_t c = 0; c < Setting::channels; ++c) {
        double sent = 0, arrived = g.background[c], size = 0;
        for (std::size_t p = c; p < s.d_out.size(); p += Setting::channels) {
            sent += s.d_out[p];
            size += std::abs(s.d_out[p]);
        }
        for (std::size_t v = c; v < g.values.size(); v += Setting::channels) arrived += g.values[v];
        CHECK(size > 1000.0);
        CHECK(std::abs(g.background[c]) > 0.0f);
        CHECK(std::abs(arrived - sent) < 1e-6 * size);  // float sums of some hundred terms a row
    }
}
