// Derivative pictures: how every pixel changes along one direction v of the parameters, in one
// pass.
//
// render/path/adjoint.h writes the radiance of a path as a polynomial in what the scene lets
// change. Its tangent follows the same recursion, from the end of the path to the camera. With t(x)
// the change of x along v, and U_k = Lo_k / c_k the three terms before the weight of the alpha
// test:
//
//   t(U_k) = w_k t(Le_k) + w^l_k (t(f^l_k) T^l L^l_k + f^l_k t(T^l L^l_k))
//            + s_k (t(f_k) Li_k + f_k t(Li_k))
//   t(Lo_k) = c_k t(U_k) + U_k dc_k/dalpha t(alpha)
//   t(T) = sum over events i of (product before i) t(x_i) (product after i)
//
// All weights are detached, as in the adjoint: <d_image, t> is <v, derivative of
// trace_paths_backward> for the same paths. One pass costs little more than a picture and gives one
// parameter's derivative in all pixels, where the adjoint gives all parameters' in one number. In
// double alone: such a picture is looked at and compared, not fitted.
#pragma once

#include "photograd/render/path/path.h"

namespace photograd {

/// A value and its change.
struct Dual3 {
    Vec3<double> value{0.0}, tangent{0.0};
};

/// L and its directional derivative along `along`, a scene of the same geometry that holds the
/// tangents of the numbers of `scene`.
class RadianceTangent {
public:
    RadianceTangent(const PathScene<double>& scene, const PathScene<double>& along);

    [[nodiscard]] Dual3 radiance(const Path<double>& path) const;

private:
    /// A material at one point, and how it changes there.
    struct PointMaterial {
        Material<double> value, change;
    };
    [[nodiscard]] PointMaterial at(std::size_t material, const Vec2<double>& uv,
                                   const Footprint<double>& footprint) const;
    [[nodiscard]] Vec3<double> emission(std::int32_t shape, const Vec2<double>& uv,
                                        const Vec3<double>& direction) const;
    [[nodiscard]] Vec3<double> emitter(const EmitterSample<double>& nee) const;
    [[nodiscard]] double alpha_transmittance(const Path<double>& path,
                                             const EmitterSample<double>& nee) const;
    [[nodiscard]] Vec3<double> product(const Path<double>& path,
                                       const EventProduct<double>& events) const;
    /// T^l L^l without occluders; 0 without a sample.
    [[nodiscard]] Dual3 direct(const Path<double>& path, const EmitterSample<double>& nee) const;
    /// t(f) Li s + t(f^l) T^l L^l w^l, at a surface and at a scattering event.
    [[nodiscard]] Vec3<double> reflected(const PathVertex<double>& v, const PointMaterial& material,
                                         const Vec3<double>& Li, const Vec3<double>& direct) const;
    [[nodiscard]] Vec3<double> scattered(const PathVertex<double>& v, const Vec3<double>& Li,
                                         const Vec3<double>& direct) const;
    [[nodiscard]] Dual3 outgoing(const Path<double>& path, const PathVertex<double>& v,
                                 const Dual3& Li) const;

    const PathScene<double>&scene_, &along_;
    std::vector<bool> moving_;  // of each material: whether anything of it changes
};

/// Adds samples to both sums: of the picture, and of its change along `along`.
void trace_paths_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                         const ThinLens& camera, const PathOptions& options,
                         const SampleRange& samples, const PathSums& picture,
                         const PathSums& tangent);

}  // namespace photograd
