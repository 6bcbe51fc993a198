// Derivative pictures: how every pixel changes along one direction v of the parameters, in the pass of the picture.
//
// render/path_vertex.h writes the radiance of a path as a polynomial in what the scene lets change. Its tangent follows
// the same recursion, from the end of the path to the camera, with t(x) the change of x along v:
//
//   t_k = w_k t(Le_k) + w^l_k (t(f^l_k) L^l_k + f^l_k t(L^l_k)) + s_k (t(f_k) L_{k+1} + f_k t_{k+1})       t_n = 0
//
// What covers only in part (coverage.h) multiplies: with U_k the sum of the three terms of L_k, veils as a factor of L^l_k,
// and the weight c_k of staying or passing, t_k = c_k t(U_k) + U_k dc_k/dalpha t(alpha).
//
// Between surfaces (volume_vertex.h), L^l and L_{k+1} have products P of steps x_i as factors, and f may be a phase function:
//
//   t(P) = sum over i of (product before i) t(x_i) (product after i),       gathered from the first step on
//
// All weights are detached, as in the adjoint: <d_image, t> is <v, derivative of trace_paths_backward> for the same
// paths. One pass costs little more than a picture and gives one parameter's derivative in all pixels, where the adjoint
// gives all parameters' in one number. In double alone: such a picture is looked at and compared, not fitted.
#pragma once

#include "photograd/render/path.h"
#include "photograd/render/volume_vertex.h"

namespace photograd {

/// L_0, and its change along `along`, a scene of the same geometry whose numbers say how those of `scene` change.
class PathTangent {
public:
    PathTangent(const PathScene<double>& scene, const PathScene<double>& along);

    struct Pair {
        Vec3<double> value, tangent;
    };
    [[nodiscard]] Pair gather(const Path<double>& path) const;
    /// The same of a path through media.
    [[nodiscard]] Pair gather_through(const Path<double>& path,
                                      const MediaTrail<double>& trail) const;

private:
    /// A material as it is at one point, and how it changes there.
    struct Here {
        Material<double> value, change;
    };
    [[nodiscard]] Here at(std::size_t material, const Vec2<double>& uv,
                          const Footprint<double>& seen) const;
    [[nodiscard]] Vec3<double> emitted(std::int32_t shape, const Vec2<double>& uv,
                                       const Vec3<double>& direction) const;
    [[nodiscard]] double through(const LightVertex<double>& light) const;
    [[nodiscard]] Vec3<double> sent(const LightVertex<double>& light) const;
    /// L^l and its change, where a light was asked; else 0.
    [[nodiscard]] Pair from_light(const LightVertex<double>& light) const;
    [[nodiscard]] Vec3<double> reflected(const PathVertex<double>& v, const Here& here,
                                         const Vec3<double>& ahead, const Vec3<double>& lit) const;
    /// L_k and its change, from what comes from ahead, what comes from the light, and U_k. `medium` is that which
    /// scatters at the vertex, if it is no surface.
    [[nodiscard]] Pair leaving(const PathVertex<double>& v, std::int32_t medium, const Pair& ahead,
                               const Pair& lit, const Vec3<double>& U) const;
    [[nodiscard]] Vec3<double> product(const MediaTrail<double>& trail,
                                       const StepProduct<double>& steps) const;
    [[nodiscard]] Vec3<double> scattered(const PathVertex<double>& v, std::int32_t medium,
                                         const Vec3<double>& ahead, const Vec3<double>& lit) const;

    const PathScene<double>&scene_, &along_;
    std::vector<bool> moving_;  // of each material: whether anything of it changes
};

/// Adds samples to both sums: of the picture, and of its change along `along`.
void trace_paths_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                         const ThinLens& camera, const PathOptions& options,
                         const SampleRange& samples, const PathSums& picture,
                         const PathSums& tangent);

}  // namespace photograd
