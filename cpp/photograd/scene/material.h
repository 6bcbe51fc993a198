// The material of a surface: a reflectance model of bsdf/bsdf_table.h, its parameters, and opacity.
//
// A scene has many surfaces of different models. A material is a number in the table and a row of
// parameters, whatever the model; one that is added to a registry can be used in scenes without a
// line here. Directions are in the shading frame.
#pragma once

#include <cstdint>
#include <string_view>

#include "photograd/bsdf/bsdf_table.h"

namespace photograd {

inline constexpr int max_parameters = max_bsdf_parameters + 1;  // and opacity

template <Real R>
struct Material {
    std::uint16_t model = 0;   // in the table
    bool has_opacity = false;  // then `alpha` is the last parameter
    R alpha = R(1);            // part of the surface that covers what is behind it
    R parameter[max_bsdf_parameters] = {};

    /// The model `name` with parameters from `row`; "+alpha" behind the name adds opacity. Refuses
    /// (SceneError) a name that no registry has.
    static Material read(std::string_view name, const R* row);
    /// This model with all parameters 0, as an accumulator of derivatives.
    [[nodiscard]] Material zero() const;
    [[nodiscard]] int parameter_count() const {
        return info().parameter_count + (has_opacity ? 1 : 0);
    }
    /// One of all parameters.
    [[nodiscard]] R& number(int i) { return i < info().parameter_count ? parameter[i] : alpha; }
    /// Adds all parameters to out, in their order.
    void add_to(double* out) const;
    /// All parameters, in the same order, to or from a row of at most max_parameters.
    void get(R* row) const;
    void set(const R* row);

    /// Whether light may pass; such a surface has an inside, and is not turned towards the viewer.
    [[nodiscard]] bool transmits() const { return info().transmits; }
    [[nodiscard]] bool is_specular() const { return info().is_specular(); }

    /// f(wo, wi); 0 for specular surfaces, which no other strategy hits.
    [[nodiscard]] Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return value(wo, wi, -1);
    }
    [[nodiscard]] R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return functions().pdf(parameter, wo, wi);
    }
    /// Both at once, which have much in common.
    [[nodiscard]] ScatterValue<R> f_and_pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return functions().f_and_pdf(parameter, wo, wi);
    }
    /// `beta`: see BsdfFunctions.
    [[nodiscard]] ScatterSample<R> sample(const Vec3<R>& wo, const Vec2<R>& u2, R u,
                                          const Vec3<R>& beta = Vec3<R>(R(1))) const {
        return functions().sample(parameter, wo, u2, u, beta);
    }

    /// `value` of a sample of another material of the same kind: f, or the weight of a lobe.
    [[nodiscard]] Vec3<R> value(const Vec3<R>& wo, const Vec3<R>& wi, int lobe) const {
        return functions().value(parameter, wo, wi, lobe);
    }
    /// Adds dL/dparameter to d_self, a material of the same model. The direction is held fixed,
    /// that of a refracted lobe as well.
    void value_backward(const Vec3<R>& wo, const Vec3<R>& wi, int lobe, const Vec3<R>& d_value,
                        Material& d_self) const {
        functions().value_backward(parameter, wo, wi, lobe, d_value, d_self.parameter);
    }

private:
    [[nodiscard]] const BsdfInfo& info() const { return bsdf_infos[model]; }
    [[nodiscard]] const BsdfFunctions<R>& functions() const { return bsdf_functions<R>(model); }
};

}  // namespace photograd
