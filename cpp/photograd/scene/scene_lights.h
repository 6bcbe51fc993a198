// Light sampling: which light, and where on it. Infinite and delta lights, and emissive primitives.
//
// All stand in one table. An infinite or delta light has an entry (light/any_light.h); so has each
// triangle and each sphere of a shape that emits, and each mesh that is a rectangle. An entry is
// chosen with probability pmf in proportion to its power (light/light_power.h); then the light
// itself samples a direction with its own density,
//
//   pdf = pmf (density over solid angle)
//
// which multiple importance sampling compares with that of the BSDF. Lights at infinity overlap: a
// direction may be sampled by any of them, so what lies behind everything has one density, the sum
// of theirs.
//
// The probabilities are those of the powers with which the scene was built. An optimization may
// change powers without them: estimates stay unbiased, with higher variance, and derivatives hold
// them fixed. Every infinite and delta light has a least probability: one that is black when the
// scene is built may emit later, and no ray would ever hit it if it is a delta light.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "photograd/geometry/bvh.h"
#include "photograd/light/any_light.h"
#include "photograd/light/quad_light.h"
#include "photograd/sampling/distribution_1d.h"

namespace photograd {

/// A triangle, a ball, or a rectangle of two triangles (`rectangle` >= 0, primitive 0).
struct EmissivePrimitive {
    std::int32_t shape, primitive, rectangle = -1;
};

/// A sample of an emissive primitive; `normal` is the side that emits. pdf = 0: none is visible.
template <class R>
struct EmissiveSample {
    LightSample<R> light;
    Vec3<R> normal{R(0)};
};

/// A uniform point of an emissive primitive of this area, m^2; `normal` is the side that emits.
struct EmissivePoint {
    Vec3<double> position, normal;
    double area;
};

class SceneLights {
public:
    /// Stand for a shape: no hit, so the background; no emitter; a delta light.
    static constexpr std::int32_t background = -1, none = -2, delta = -3;

    SceneLights() = default;
    /// emission (S, 3) of each shape, all 0 where it does not emit. Refuses (SceneError) negative
    /// emission, and primitives that emit without area.
    SceneLights(const Bvh& bvh, std::span<const double> emission,
                std::span<const AnyLight<double>> infinite_and_delta);

    [[nodiscard]] bool empty() const {
        return infinite_and_delta_count_ == 0 && primitives_.empty();
    }
    [[nodiscard]] bool has_delta() const { return !deltas_.empty(); }
    /// Number of infinite and delta lights: entries from here on are emissive primitives.
    [[nodiscard]] std::int64_t infinite_and_delta_count() const {
        return infinite_and_delta_count_;
    }
    [[nodiscard]] const EmissivePrimitive& primitive(std::int64_t entry) const {
        return primitives_[static_cast<std::size_t>(entry - infinite_and_delta_count_)];
    }
    /// Numbers in the list of the lights at infinity.
    [[nodiscard]] std::span<const std::int32_t> at_infinity() const { return at_infinity_; }

    /// An entry by a uniform number. There must be one.
    [[nodiscard]] Choice choose(double u) const { return choice_.sample(u); }
    /// An entry among delta lights alone, for BSDF sampling, which hits all others.
    [[nodiscard]] Choice choose_delta(double u) const;
    [[nodiscard]] double pmf(std::int64_t entry) const { return choice_.pmf(entry); }

    /// A direction from `point` to a primitive, whose choice is not in its pdf.
    template <Real R>
    [[nodiscard]] EmissiveSample<R> sample(const Bvh& bvh, const EmissivePrimitive& emissive,
                                           const Vec3<R>& point, const Vec2<R>& u2) const;
    /// A point of a primitive, visible or not.
    [[nodiscard]] EmissivePoint point_on(const Bvh& bvh, const EmissivePrimitive& emissive,
                                         const Vec2<double>& u2) const;
    /// The density over solid angle of arriving at this primitive by a choice and a sample; 0 if it
    /// is no light. The front was hit at `distance`, with `cosine`.
    template <Real R>
    [[nodiscard]] R hit_pdf(const Bvh& bvh, std::int32_t shape, std::int32_t primitive,
                            const Vec3<R>& point, R distance, R cosine) const;

private:
    template <class R>
    void add_rectangle(const QuadLight<double>& quad);
    void add_shape(const Bvh& bvh, std::int32_t shape, double L, std::vector<double>& power);
    template <class R, class Use>
    auto as_light(const Bvh& bvh, const EmissivePrimitive& emissive, Use&& use) const;

    std::int64_t infinite_and_delta_count_ = 0;
    std::vector<EmissivePrimitive> primitives_;
    std::tuple<std::vector<PlacedQuad<float>>, std::vector<PlacedQuad<double>>> rectangles_;
    std::vector<std::int32_t> first_;  // primitive of each shape, or -1
    std::vector<std::int32_t> at_infinity_, deltas_;
    Distribution1D choice_, delta_choice_;
};

}  // namespace photograd
