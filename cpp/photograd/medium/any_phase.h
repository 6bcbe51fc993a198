// One phase function of the registry, with its parameters, as a value: a scene has media with
// different ones.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "photograd/core/errors.h"
#include "photograd/medium/registry.h"

namespace photograd {

namespace detail {
template <class R, class List>
struct PhaseVariantOf;
template <class R, template <class> class... Model>
struct PhaseVariantOf<R, ModelList<Model...>> {
    using type = std::variant<Model<R>...>;
};
}  // namespace detail

template <Real R>
struct AnyPhase {
    typename detail::PhaseVariantOf<R, Phases>::type model;

    /// The phase function `name`. Refuses (SceneError) a name that the registry does not have.
    static AnyPhase named(std::string_view name) {
        AnyPhase phase;
        bool found = false;
        Phases::for_each([&]<template <class> class M>() {
            if (name != M<R>::name) return;
            phase.model = M<R>{};
            found = true;
        });
        if (!found)
            fail(ErrorKind::scene, "medium", "phase", "a registered phase function",
                 std::string(name), "photograd.bsdf.phase.registry()");
        return phase;
    }
    /// visit(each parameter), in their order.
    template <class Visit>
    void for_each(Visit&& visit) {
        std::visit([&](auto& m) { for_each_scalar(visit, m); }, model);
    }
    [[nodiscard]] int parameter_count() const {
        return std::visit([](const auto& m) { return scalars_in(m.params); }, model);
    }

    /// Density of a turn, 1/sr, and its derivatives, added to d_self, a phase function of the same
    /// kind, and to d_cos_theta.
    [[nodiscard]] R p(R cos_theta) const {
        return std::visit([&](const auto& m) { return m.p(cos_theta); }, model);
    }
    void p_backward(R cos_theta, R d_p, AnyPhase& d_self, R& d_cos_theta) const {
        std::visit(
            [&]<class M>(const M& m) {
                m.p_backward(cos_theta, d_p, std::get<M>(d_self.model), d_cos_theta);
            },
            model);
    }
    /// p_backward of a sampled direction, which is detached.
    void p_backward(R cos_theta, R d_p, AnyPhase& d_self) const {
        R held = R(0);
        p_backward(cos_theta, d_p, d_self, held);
    }
    /// All are sampled as Henyey and Greenstein's (henyey_greenstein.h).
    [[nodiscard]] Vec3<R> sample(const Vec3<R>& direction, const Vec2<R>& u2) const {
        return sample_henyey_greenstein(lobe(), direction, u2);
    }
    [[nodiscard]] R pdf(R cos_theta) const { return henyey_greenstein_pdf(lobe(), cos_theta); }

private:
    [[nodiscard]] R lobe() const {
        return std::visit([](const auto& m) { return m.g; }, model);
    }
};

}  // namespace photograd
