// All reflectance models behind one table: the description of each, and its functions on a flat
// row of its parameters. Code that goes through the table does not include the models.
//
// Models are numbered: those of bsdf/registry.h first, then the specular ones of
// bsdf/delta_registry.h. Directions are in the shading frame.
#pragma once

#include <span>
#include <string_view>

#include "photograd/bsdf/bsdf.h"
#include "photograd/bsdf/delta.h"

namespace photograd {

/// Capacity of a row. The widest model must fit, which is checked where the table is made.
inline constexpr int max_bsdf_parameters = 25;
inline constexpr int max_lobes = 4;  // of a specular model

/// Where a path goes on. Models with a density have lobe -1, pdf over solid angle, and value f.
/// Specular ones name the lobe that was chosen; pdf is then the probability of that choice and
/// value the lobe's weight, cosine included.
template <class R>
struct ScatterSample {
    Vec3<R> wi{R(0)}, value{R(0)};
    R pdf = R(0);
    int lobe = -1;
};

/// f(wo, wi) and the density with which `sample` returns wi.
template <class R>
struct ScatterValue {
    Vec3<R> f{R(0)};
    R pdf = R(0);
};

struct BsdfInfo {
    std::string_view name;
    std::span<const ParameterInfo> parameters;
    int parameter_count;  // scalars
    int lobe_count;       // of a specular model; 0 of one with a density
    bool transmits;
    bool reciprocal;
    EnergyClaim energy;

    [[nodiscard]] constexpr bool is_specular() const { return lobe_count > 0; }
};

/// What a specular model has no answer to (f, pdf, sample_direction) is 0.
template <class R>
struct BsdfFunctions {
    /// f(wo, wi), or the weight of a specular model's lobe.
    Vec3<R> (*value)(const R* row, const Vec3<R>& wo, const Vec3<R>& wi, int lobe);
    /// Adds dL/dparameter to d_row. The direction is held fixed, that of a refracted lobe as well.
    void (*value_backward)(const R* row, const Vec3<R>& wo, const Vec3<R>& wi, int lobe,
                           const Vec3<R>& d_value, R* d_row);
    R (*pdf)(const R* row, const Vec3<R>& wo, const Vec3<R>& wi);
    ScatterValue<R> (*f_and_pdf)(const R* row, const Vec3<R>& wo, const Vec3<R>& wi);
    Vec3<R> (*sample_direction)(const R* row, const Vec3<R>& wo, const Vec2<R>& u2);
    /// beta is the throughput of the path so far: of surfaces that send each color another way, one
    /// that the path still has is followed.
    ScatterSample<R> (*sample)(const R* row, const Vec3<R>& wo, const Vec2<R>& u2, R u,
                               const Vec3<R>& beta);
    Vec3<R> (*index_inside)(const R* row);
    /// All lobe_count lobes, and the derivatives with respect to the parameters; null without
    /// lobes.
    void (*lobes)(const R* row, const Vec3<R>& wo, DeltaLobe<R>* out);
    void (*lobes_backward)(const R* row, const Vec3<R>& wo, const DeltaLobe<R>* d_lobes, R* d_row);
};

/// Forward mode along v, a row of the change of each parameter; directions are held.
struct BsdfTangents {
    Vec3<double> (*value)(const double* row, const double* v, const Vec3<double>& wo,
                          const Vec3<double>& wi, int lobe);
    void (*lobes)(const double* row, const double* v, const Vec3<double>& wo,
                  DeltaLobe<double>* out);
};

extern const std::span<const BsdfInfo> bsdf_infos;
extern const BsdfFunctions<float>* const float_bsdfs;
extern const BsdfFunctions<double>* const double_bsdfs;
extern const BsdfTangents* const bsdf_tangents;

template <Real R>
const BsdfFunctions<R>& bsdf_functions(int model) {
    if constexpr (std::is_same_v<R, float>)
        return float_bsdfs[model];
    else
        return double_bsdfs[model];
}

}  // namespace photograd
