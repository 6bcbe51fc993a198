// How a model becomes a row of the table (bsdf_table.h). Included by the tables alone: it brings
// all models.
#pragma once

#include <algorithm>

#include "photograd/bsdf/bsdf_table.h"
#include "photograd/bsdf/delta_registry.h"
#include "photograd/bsdf/registry.h"

namespace photograd {

template <template <class> class... A, template <class> class... B>
ModelList<A..., B...> joined(ModelList<A...>, ModelList<B...>);
using AllBsdfs = decltype(joined(Bsdfs{}, DeltaBsdfs{}));

template <class T>
concept Specular = requires { T::lobe_count; };

template <class R>
R largest(const Vec3<R>& v) {
    return std::max({v.x, v.y, v.z});
}

/// A lobe in proportion to its weight, mixed with a small uniform share: a lobe of weight 0 is
/// never followed otherwise, and its derivative, which need not be 0, would be lost.
template <class R, std::size_t count>
ScatterSample<R> choose_lobe(const std::array<DeltaLobe<R>, count>& lobes, R u,
                             const Vec3<R>& beta) {
    constexpr R uniform_share = R(0.1);
    R total = R(0), existing = R(0);
    for (const auto& lobe : lobes) {
        total += largest(lobe.weight * beta);
        existing += dot(lobe.wi, lobe.wi) > R(0) ? R(1) : R(0);
    }
    if (existing == R(0)) return {};
    ScatterSample<R> chosen;
    R below = R(0);
    for (std::size_t k = 0; k < count; ++k) {
        const DeltaLobe<R>& lobe = lobes[k];
        if (!(dot(lobe.wi, lobe.wi) > R(0))) continue;
        const R share = total > R(0)
                            ? (R(1) - uniform_share) * largest(lobe.weight * beta) / total +
                                  uniform_share / existing
                            : R(1) / existing;
        chosen = {lobe.wi, lobe.weight, share, static_cast<int>(k)};
        below += share;
        if (u < below) break;  // the last one takes what rounding leaves
    }
    return chosen;
}

template <class T>
inline constexpr auto infos_of = parameter_infos(T::params);

template <class T>
constexpr BsdfInfo info_of() {
    BsdfInfo info{T::name, infos_of<T>, parameter_count<T>(),   0,
                  false,   true,        {Energy::conserving, 1}};
    if constexpr (Specular<T>) {
        info.lobe_count = static_cast<int>(T::lobe_count);
        info.transmits = T::lobe_count > 1;
    } else {
        info.transmits = transmits<T>();
        info.reciprocal = T::reciprocal;
        info.energy = T::energy;
    }
    return info;
}

template <class R, class T>
constexpr BsdfFunctions<R> density_functions() {
    using V = Vec3<R>;
    BsdfFunctions<R> to{};
    to.value = [](const R* row, const V& wo, const V& wi, int) {
        return from_row<T>(row).f(wo, wi);
    };
    to.value_backward = [](const R* row, const V& wo, const V& wi, int, const V& d_value,
                           R* d_row) {
        T d_model = from_row<T>(d_row);
        from_row<T>(row).f_backward(wo, wi, d_value, d_model);
        to_row(d_model, d_row);
    };
    to.pdf = [](const R* row, const V& wo, const V& wi) { return from_row<T>(row).pdf(wo, wi); };
    to.f_and_pdf = [](const R* row, const V& wo, const V& wi) -> ScatterValue<R> {
        const T model = from_row<T>(row);
        return {model.f(wo, wi), model.pdf(wo, wi)};
    };
    to.sample_direction = [](const R* row, const V& wo, const Vec2<R>& u2) {
        return from_row<T>(row).sample(wo, u2);
    };
    to.sample = [](const R* row, const V& wo, const Vec2<R>& u2, R, const V&) -> ScatterSample<R> {
        const T model = from_row<T>(row);
        const V wi = model.sample(wo, u2);
        return {wi, model.f(wo, wi), model.pdf(wo, wi), -1};
    };
    to.index_inside = [](const R* row) {
        if constexpr (transmits<T>())
            return from_row<T>(row).index_inside();
        else
            return (void)row, V(R(1));
    };
    return to;
}

template <class R, class T>
constexpr BsdfFunctions<R> specular_functions() {
    static_assert(T::lobe_count <= max_lobes, "raise bsdf_table.h's max_lobes");
    using V = Vec3<R>;
    constexpr std::size_t count = T::lobe_count;
    BsdfFunctions<R> to{};
    to.value = [](const R* row, const V& wo, const V&, int lobe) {
        return lobe < 0 ? V(R(0))
                        : from_row<T>(row).lobes(wo)[static_cast<std::size_t>(lobe)].weight;
    };
    to.value_backward = [](const R* row, const V& wo, const V&, int lobe, const V& d_value,
                           R* d_row) {
        if (lobe < 0) return;
        std::array<DeltaLobe<R>, count> d_lobes{};
        d_lobes[static_cast<std::size_t>(lobe)].weight = d_value;
        T d_model = from_row<T>(d_row);
        from_row<T>(row).lobes_backward(wo, d_lobes, d_model);
        to_row(d_model, d_row);
    };
    to.pdf = [](const R*, const V&, const V&) { return R(0); };
    to.f_and_pdf = [](const R*, const V&, const V&) { return ScatterValue<R>{}; };
    to.sample_direction = [](const R*, const V&, const Vec2<R>&) { return V(R(0)); };
    to.sample = [](const R* row, const V& wo, const Vec2<R>&, R u, const V& beta) {
        constexpr bool parts_colors = count > 3;  // a lobe for each channel
        return choose_lobe(from_row<T>(row).lobes(wo), u, parts_colors ? beta : V(R(1)));
    };
    to.index_inside = [](const R*) { return V(R(1)); };
    to.lobes = [](const R* row, const V& wo, DeltaLobe<R>* out) {
        std::ranges::copy(from_row<T>(row).lobes(wo), out);
    };
    to.lobes_backward = [](const R* row, const V& wo, const DeltaLobe<R>* d_lobes, R* d_row) {
        std::array<DeltaLobe<R>, count> d{};
        std::copy_n(d_lobes, count, d.begin());
        T d_model = from_row<T>(d_row);
        from_row<T>(row).lobes_backward(wo, d, d_model);
        to_row(d_model, d_row);
    };
    return to;
}

template <class R, class T>
constexpr BsdfFunctions<R> functions_of() {
    static_assert(parameter_count<T>() <= max_bsdf_parameters,
                  "a model is wider than bsdf_table.h's max_bsdf_parameters: raise it");
    if constexpr (Specular<T>)
        return specular_functions<R, T>();
    else
        return density_functions<R, T>();
}

template <class R, template <class> class... M>
constexpr std::array<BsdfFunctions<R>, sizeof...(M)> functions_of_all(ModelList<M...>) {
    return {functions_of<R, M<R>>()...};
}

/// T is a model on dual numbers.
template <class T>
constexpr BsdfTangents tangents_of() {
    using V = Vec3<double>;
    using D = Dual<double>;
    BsdfTangents to{};
    to.value = [](const double* row, const double* v, const V& wo, const V& wi, int lobe) {
        const T model = dual_from_rows<T>(row, v);
        const Vec3<D> fixed_o(D(wo.x), D(wo.y), D(wo.z)), fixed_i(D(wi.x), D(wi.y), D(wi.z));
        Vec3<D> out(D(0.0));
        if constexpr (!Specular<T>)
            out = model.f(fixed_o, fixed_i);
        else if (lobe >= 0)
            out = model.lobes(fixed_o)[static_cast<std::size_t>(lobe)].weight;
        return V(out.x.tangent, out.y.tangent, out.z.tangent);
    };
    if constexpr (Specular<T>)
        to.lobes = [](const double* row, const double* v, const V& wo, DeltaLobe<double>* out) {
            const Vec3<D> fixed_o(D(wo.x), D(wo.y), D(wo.z));
            for (const auto& lobe : dual_from_rows<T>(row, v).lobes(fixed_o)) {
                for (int c = 0; c < 3; ++c) {
                    out->wi[c] = lobe.wi[c].tangent;
                    out->weight[c] = lobe.weight[c].tangent;
                }
                ++out;
            }
        };
    return to;
}

}  // namespace photograd
