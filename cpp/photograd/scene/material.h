// What a surface is made of: one model of either registry, with its parameters.
//
// A scene has many surfaces of different models. The set is closed (bsdf/registry.h and bsdf/delta_registry.h), so a
// material is a variant over it, not a base class; a model that is added there can be used in scenes without a line
// here. Directions are in the shading frame.
#pragma once

#include <string_view>
#include <variant>

#include "photograd/bsdf/delta_registry.h"
#include "photograd/bsdf/registry.h"

namespace photograd {

namespace detail {
template <class R, class Rough, class Smooth>
struct VariantOf;
template <class R, template <class> class... Rough, template <class> class... Smooth>
struct VariantOf<R, ModelList<Rough...>, ModelList<Smooth...>> {
    using type = std::variant<Rough<R>..., Smooth<R>...>;
};
}  // namespace detail

template <class R>
using AnyModel = typename detail::VariantOf<R, Bsdfs, DeltaBsdfs>::type;

/// Where a path goes on. Models with a density have lobe -1, pdf over solid angle, and value f. Smooth ones name the
/// lobe that was chosen; pdf is then the probability of that choice and value the lobe's weight, cosine included.
template <class R>
struct ScatterSample {
    Vec3<R> wi{R(0)}, value{R(0)};
    R pdf = R(0);
    int lobe = -1;
};

/// f(wo, wi) and the density with which `sample` draws wi.
template <class R>
struct ScatterValue {
    Vec3<R> f{R(0)};
    R pdf = R(0);
};

inline constexpr int max_parameters = 64;  // numbers of one model

template <Real R>
struct Material {
    AnyModel<R> model;
    /// Whether the surface covers only a part of what lies behind it; `alpha`, that part, is then its last parameter.
    bool sheer = false;
    R alpha = R(1);

    /// The model `name` with parameters from `row`; "+alpha" behind the name makes it sheer. Refuses (SceneError) a name
    /// that no registry has.
    static Material read(std::string_view name, const R* row);
    /// The same model with all parameters 0: where derivatives are added up.
    [[nodiscard]] Material zero() const;
    [[nodiscard]] int parameter_count() const;
    /// Adds all parameters to out, in their order.
    void add_to(double* out) const;
    /// All parameters, in the same order, to or from a row of them.
    void get(R* row) const;
    void set(const R* row);

    /// Whether light may pass; such a surface has an inside, and is not turned towards the viewer.
    [[nodiscard]] bool transmits() const;
    [[nodiscard]] bool is_delta() const;

    /// f(wo, wi); 0 for smooth surfaces, which nobody meets by chance.
    [[nodiscard]] Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const;
    [[nodiscard]] R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const;
    /// Both at once, which have much in common.
    [[nodiscard]] ScatterValue<R> f_and_pdf(const Vec3<R>& wo, const Vec3<R>& wi) const;
    /// `carried` is the weight of the path so far: of surfaces that send each colour another way, one that the path still
    /// has is followed.
    [[nodiscard]] ScatterSample<R> sample(const Vec3<R>& wo, const Vec2<R>& u2, R u,
                                          const Vec3<R>& carried = Vec3<R>(R(1))) const;

    /// `value` of a sample that another material has drawn: f, or the weight of a lobe.
    [[nodiscard]] Vec3<R> value(const Vec3<R>& wo, const Vec3<R>& wi, int lobe) const;
    /// Adds dL/dparameter to d_self, a material of the same model. The direction is held fixed, that of a
    /// refracted lobe as well.
    void value_backward(const Vec3<R>& wo, const Vec3<R>& wi, int lobe, const Vec3<R>& d_value,
                        Material& d_self) const;
};

}  // namespace photograd
