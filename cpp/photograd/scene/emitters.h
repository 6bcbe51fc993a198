// Which light a path asks, and where on it: shapes that emit, piece by piece, and what lies behind everything.
//
// A piece is a triangle or a sphere. It is chosen with a probability (pmf) in proportion to its power, area times mean
// emission, and a point on it uniformly over its area A. Seen from a distance d, with the cosine c between the piece's
// normal and the way back, the same choice has the density over solid angle
//
//   pdf = pmf d^2 / (A c)
//
// which multiple importance sampling compares with that of the BSDF. The environment takes half of the choices
// where there are both. The probabilities are those of the emission that the scene was built with: they decide only
// where to look, so a fit may change the emission without them, and derivatives hold them fixed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/geometry/bvh.h"

namespace photograd {

/// A point of a piece. The normal is the side that emits.
template <class R>
struct EmitterPoint {
    Vec3<R> position, normal;
};

struct EmitterPiece {
    std::int32_t shape, primitive;
    double area, pmf;
};

class Emitters {
public:
    static constexpr int environment = -1, none = -2;

    Emitters() = default;
    /// emission (S, 3) of each shape, all 0 where it does not emit. Refuses (SceneError) negative emission, and
    /// pieces that emit without area.
    Emitters(const Bvh& bvh, std::span<const double> emission, bool has_environment);

    [[nodiscard]] bool empty() const { return pieces_.empty() && environment_pmf_ == 0; }
    [[nodiscard]] double environment_pmf() const { return environment_pmf_; }
    [[nodiscard]] std::span<const EmitterPiece> pieces() const { return pieces_; }

    /// A piece's number, `environment` or `none`, by a uniform number.
    [[nodiscard]] int choose(double u) const;
    /// The density per area with which points of this primitive are chosen; 0 if it is no emitter.
    [[nodiscard]] double density(std::int32_t shape, std::int32_t primitive) const;
    /// A point of a piece, uniform over its area.
    template <Real R>
    [[nodiscard]] EmitterPoint<R> point(const Bvh& bvh, int piece, const Vec2<R>& u2) const;

private:
    std::vector<EmitterPiece> pieces_;
    std::vector<double> upper_;        // sum of pmf up to each piece
    std::vector<std::int32_t> first_;  // of each shape, or -1
    double environment_pmf_ = 0;
};

}  // namespace photograd
