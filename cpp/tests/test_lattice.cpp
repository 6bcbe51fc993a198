#include <doctest/doctest.h>

#include <initializer_list>
#include <utility>

#include "photograd/render/march/lattice.h"

using namespace photograd;

namespace {
constexpr double box[2][3] = {{-1, -1, -1}, {1, 1, 1}};
}

TEST_CASE("a ray parallel to a face, inside of the slab, is clipped by the other axes") {
    const double o[3] = {-3, 0.5, 0.0}, d[3] = {1, 0, 0};
    const Span<double> span = clip_to_box(o, d, box);
    CHECK(span.near == doctest::Approx(2));
    CHECK(span.far == doctest::Approx(4));
}

TEST_CASE("rays that miss, point away or touch a face from outside have no samples") {
    const double miss[3] = {-3, 2, 0}, along[3] = {1, 0, 0}, away[3] = {-1, 0, 0},
                 hit[3] = {-3, 0, 0};
    for (const auto& [o, d] : {std::pair{miss, along}, std::pair{hit, away}})
        CHECK(place_samples(clip_to_box(o, d, box), 0.1, Lattice::origin, 0.5).count == 0);
}

TEST_CASE("a ray that runs in a face is not lost to NaN") {
    const float o[3] = {-3, 1, 0}, d[3] = {1, 0, 0};
    const Span<float> span = clip_to_box(o, d, box);
    CHECK(span.near == doctest::Approx(2));
    CHECK(span.far == doctest::Approx(4));
}

TEST_CASE("samples of both lattices lie inside of the span, for any jitter") {
    const Span<double> span{0.237, 1.913};
    for (const double jitter : {0.0, 0.25, 0.5, 0.999}) {
        const RaySamples<double> s = place_samples(span, 0.1, Lattice::origin, jitter);
        REQUIRE(s.count > 0);
        CHECK(s.t0 + 0.05 >= span.near);
        CHECK(s.t0 + (s.count - 0.5) * 0.1 <= span.far);
        CHECK(s.t0 + (s.count + 0.5) * 0.1 > span.far);
    }
    const RaySamples<double> entry = place_samples(span, 0.1, Lattice::entry, 0.5);
    CHECK(entry.count == 16);
    CHECK(entry.t0 == doctest::Approx(0.237));
}
