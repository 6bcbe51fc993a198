#include "photograd/scene/material.h"

#include <algorithm>
#include <string>

#include "photograd/core/errors.h"

namespace photograd {
namespace {

template <class T>
concept Smooth = requires { T::lobe_count; };

/// Surfaces that name a lobe for each channel.
template <class T>
constexpr bool parts_colors = requires { requires T::lobe_count > 3; };

template <class R>
R largest(const Vec3<R>& v) {
    return std::max({v.x, v.y, v.z});
}

/// A lobe in proportion to its weight, mixed with a small even share: a lobe of weight 0 is never looked along
/// otherwise, and its derivative, which need not be 0, would be lost.
template <class R, class Lobes>
ScatterSample<R> choose_lobe(const Lobes& lobes, R u, const Vec3<R>& carried) {
    constexpr R even_share = R(0.1);
    R total = R(0), existing = R(0);
    for (const auto& lobe : lobes) {
        total += largest(lobe.weight * carried);
        existing += dot(lobe.wi, lobe.wi) > R(0) ? R(1) : R(0);
    }
    if (existing == R(0)) return {};
    ScatterSample<R> chosen;
    R passed = R(0);
    for (int k = 0; k < static_cast<int>(lobes.size()); ++k) {
        const auto& lobe = lobes[static_cast<std::size_t>(k)];
        if (!(dot(lobe.wi, lobe.wi) > R(0))) continue;
        const R share = total > R(0)
                            ? (R(1) - even_share) * largest(lobe.weight * carried) / total +
                                  even_share / existing
                            : R(1) / existing;
        chosen = {lobe.wi, lobe.weight, share, k};
        passed += share;
        if (u < passed) break;  // the last one takes what rounding leaves
    }
    return chosen;
}

}  // namespace

template <Real R>
Material<R> Material<R>::read(std::string_view name, const R* row) {
    constexpr std::string_view mark = "+alpha";
    Material material;
    material.sheer = name.ends_with(mark);
    if (material.sheer) name.remove_suffix(mark.size());
    bool found = false;
    const auto look = [&]<template <class> class M>() {
        if (name != M<R>::name) return;
        M<R> model;
        const R* next = row;
        for_each_scalar([&](auto& x) { x = *next++; }, model);
        if (material.sheer) material.alpha = *next;
        material.model = model;
        found = true;
    };
    Bsdfs::for_each(look);
    DeltaBsdfs::for_each(look);
    if (!found)
        fail(ErrorKind::scene, "material", "model", "a registered reflectance model",
             std::string(name), "photograd.bsdf.registry() and photograd.delta_bsdf.registry()");
    return material;
}

template <Real R>
Material<R> Material<R>::zero() const {
    Material copy = *this;
    std::visit([](auto& m) { for_each_scalar([](auto& x) { x = R(0); }, m); }, copy.model);
    copy.alpha = R(0);
    return copy;
}

template <Real R>
int Material<R>::parameter_count() const {
    return std::visit([](const auto& m) { return scalars_in(m.params); }, model) + (sheer ? 1 : 0);
}

template <Real R>
void Material<R>::add_to(double* out) const {
    std::visit(
        [&](const auto& m) {
            for_each_scalar([&](const auto& x) { *out++ += static_cast<double>(x); }, m);
        },
        model);
    if (sheer) *out += static_cast<double>(alpha);
}

template <Real R>
void Material<R>::get(R* row) const {
    std::visit([&](const auto& m) { for_each_scalar([&](const auto& x) { *row++ = x; }, m); },
               model);
    if (sheer) *row = alpha;
}

template <Real R>
void Material<R>::set(const R* row) {
    std::visit([&](auto& m) { for_each_scalar([&](auto& x) { x = *row++; }, m); }, model);
    if (sheer) alpha = *row;
}

template <Real R>
bool Material<R>::transmits() const {
    return std::visit(
        []<class M>(const M&) {
            if constexpr (Smooth<M>)
                return M::lobe_count > 1;
            else
                return photograd::transmits<M>();
        },
        model);
}

template <Real R>
bool Material<R>::is_delta() const {
    return std::visit([]<class M>(const M&) { return Smooth<M>; }, model);
}

template <Real R>
Vec3<R> Material<R>::f(const Vec3<R>& wo, const Vec3<R>& wi) const {
    return value(wo, wi, -1);
}

template <Real R>
R Material<R>::pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
    return std::visit(
        [&]<class M>(const M& m) -> R {
            if constexpr (Smooth<M>)
                return R(0);
            else
                return m.pdf(wo, wi);
        },
        model);
}

template <Real R>
ScatterValue<R> Material<R>::f_and_pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
    return std::visit(
        [&]<class M>(const M& m) -> ScatterValue<R> {
            if constexpr (Smooth<M>)
                return {};
            else
                return {m.f(wo, wi), m.pdf(wo, wi)};
        },
        model);
}

template <Real R>
ScatterSample<R> Material<R>::sample(const Vec3<R>& wo, const Vec2<R>& u2, R u,
                                     const Vec3<R>& carried) const {
    return std::visit(
        [&]<class M>(const M& m) -> ScatterSample<R> {
            if constexpr (Smooth<M>) {
                return choose_lobe(m.lobes(wo), u, parts_colors<M> ? carried : Vec3<R>(R(1)));
            } else {
                const Vec3<R> wi = m.sample(wo, u2);
                return {wi, m.f(wo, wi), m.pdf(wo, wi), -1};
            }
        },
        model);
}

template <Real R>
Vec3<R> Material<R>::value(const Vec3<R>& wo, const Vec3<R>& wi, int lobe) const {
    return std::visit(
        [&]<class M>(const M& m) -> Vec3<R> {
            if constexpr (Smooth<M>)
                return lobe < 0 ? Vec3<R>(R(0))
                                : m.lobes(wo)[static_cast<std::size_t>(lobe)].weight;
            else
                return m.f(wo, wi);
        },
        model);
}

template <Real R>
void Material<R>::value_backward(const Vec3<R>& wo, const Vec3<R>& wi, int lobe,
                                 const Vec3<R>& d_value, Material& d_self) const {
    std::visit(
        [&]<class M>(const M& m) {
            M& d_model = std::get<M>(d_self.model);
            if constexpr (Smooth<M>) {
                if (lobe < 0) return;
                std::array<DeltaLobe<R>, M::lobe_count> d_lobes{};
                d_lobes[static_cast<std::size_t>(lobe)].weight = d_value;
                m.lobes_backward(wo, d_lobes, d_model);
            } else {
                m.f_backward(wo, wi, d_value, d_model);
            }
        },
        model);
}

template struct Material<float>;
template struct Material<double>;

}  // namespace photograd
