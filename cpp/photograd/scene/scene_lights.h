// Which light a path asks, and where on it: lights of a list, and pieces of shapes that emit.
//
// All stand in one table. A light of the list has an entry, at infinity or delta (light/any_light.h); so has each
// triangle and each ball of a shape that emits, and each mesh that is a rectangle. An entry is chosen with probability
// pmf in proportion to its power (light/light_power.h); then the light itself draws a direction with its own density,
//
//   pdf = pmf (density over solid angle)
//
// which multiple importance sampling compares with that of the BSDF. Lights at infinity overlap: a direction may be
// drawn by any of them, so what lies behind everything has one density, the sum of theirs.
//
// The probabilities are those of the powers with which the scene was built: they decide only where to look. A
// fit may change powers without them; estimates stay right, if noisier, and derivatives hold them fixed. Each light of
// the list is chosen at least now and then: one that is black when the scene is built may shine later, and no ray
// would ever hit it if it is a delta light.
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
struct LightPiece {
    std::int32_t shape, primitive, rectangle = -1;
};

/// Where a piece was asked; `normal` is the side that emits. pdf = 0: it cannot be seen.
template <class R>
struct PieceSample {
    LightSample<R> light;
    Vec3<R> normal{R(0)};
};

/// A point of a piece, drawn evenly over its area, m^2; `normal` is the side that emits.
struct PiecePoint {
    Vec3<double> position, normal;
    double area;
};

class SceneLights {
public:
    /// What a direction meets that meets no shape, and what else is no shape.
    static constexpr std::int32_t background = -1, none = -2, delta = -3;

    SceneLights() = default;
    /// emission (S, 3) of each shape, all 0 where it does not emit. Refuses (SceneError) negative emission, and
    /// pieces that emit without area.
    SceneLights(const Bvh& bvh, std::span<const double> emission,
                std::span<const AnyLight<double>> listed);

    [[nodiscard]] bool empty() const { return listed_ == 0 && pieces_.empty(); }
    [[nodiscard]] bool has_delta() const { return !deltas_.empty(); }
    /// Number of the lights of the list: entries from here on are pieces.
    [[nodiscard]] std::int64_t listed_count() const { return listed_; }
    [[nodiscard]] const LightPiece& piece(std::int64_t entry) const {
        return pieces_[static_cast<std::size_t>(entry - listed_)];
    }
    /// Numbers in the list of the lights at infinity.
    [[nodiscard]] std::span<const std::int32_t> at_infinity() const { return at_infinity_; }

    /// An entry by a uniform number. There must be one.
    [[nodiscard]] Choice choose(double u) const { return choice_.sample(u); }
    /// The same among delta lights alone: what is left to ask for those who wait for the others.
    [[nodiscard]] Choice choose_delta(double u) const;
    [[nodiscard]] double pmf(std::int64_t entry) const { return choice_.pmf(entry); }

    /// A direction from `point` to a piece; the choice of the piece is not in its pdf.
    template <Real R>
    [[nodiscard]] PieceSample<R> sample(const Bvh& bvh, const LightPiece& piece,
                                        const Vec3<R>& point, const Vec2<R>& u2) const;
    /// A point of a piece, whoever may see it.
    [[nodiscard]] PiecePoint point_on(const Bvh& bvh, const LightPiece& piece,
                                      const Vec2<double>& u2) const;
    /// The density over solid angle of arriving at this primitive by a choice and a sample; 0 if it is no light. The
    /// front was hit at `distance`, with `cosine`.
    template <Real R>
    [[nodiscard]] R hit_pdf(const Bvh& bvh, std::int32_t shape, std::int32_t primitive,
                            const Vec3<R>& point, R distance, R cosine) const;

private:
    template <class R>
    void add_rectangle(const QuadLight<double>& quad);
    void add_shape(const Bvh& bvh, std::int32_t shape, double L, std::vector<double>& power);
    template <class R, class Use>
    auto as_light(const Bvh& bvh, const LightPiece& piece, Use&& use) const;

    std::int64_t listed_ = 0;
    std::vector<LightPiece> pieces_;
    std::tuple<std::vector<PlacedQuad<float>>, std::vector<PlacedQuad<double>>> rectangles_;
    std::vector<std::int32_t> first_;  // piece of each shape, or -1
    std::vector<std::int32_t> at_infinity_, deltas_;
    Distribution1D choice_, delta_choice_;
};

}  // namespace photograd
