// Parameter descriptions of models.
//
// A model lists its continuous parameters in one line,
//     static constexpr auto params = describe(p("roughness", &Ggx::roughness, 0.01, 1, "1"));
// and everything that must visit parameters (constructor and properties in Python, gradient proof,
// benchmark row, gallery picture) iterates over that tuple. The adjoint of a model has the model's
// own type, so a new parameter gets its slot for a derivative without another line.
#pragma once

#include <array>
#include <tuple>
#include <type_traits>

#include "photograd/core/vec.h"

namespace photograd {

template <class Model, class Value>
struct Parameter {
    const char* name;
    Value Model::* member;
    double lo, hi;     // range in which values make sense; tests draw from its inside
    const char* unit;  // "1" for pure numbers
};

template <class Model, class Value>
constexpr Parameter<Model, Value> p(const char* name, Value Model::* member, double lo, double hi,
                                    const char* unit = "1") {
    return {name, member, lo, hi, unit};
}

template <class... P>
constexpr std::tuple<P...> describe(P... parameters) {
    return {parameters...};
}

/// Calls visit(parameter) for each parameter of the model.
template <class Model, class Visit>
constexpr void for_each_parameter(Visit&& visit) {
    std::apply([&](const auto&... parameter) { (visit(parameter), ...); }, Model::params);
}

/// Number of scalars in a parameter's value: 1, or 3 for a color or vector.
template <class Value>
constexpr int scalar_count() {
    if constexpr (std::is_class_v<Value> && !std::is_same_v<Value, Dual<double>>)
        return Value::length();
    else
        return 1;
}

template <class Model, class Value>
constexpr int value_scalars(const Parameter<Model, Value>&) {
    return scalar_count<Value>();
}

/// A closed list of types; registries are such lists.
template <class... T>
struct TypeList {
    template <class Visit>
    static constexpr void for_each(Visit&& visit) {
        (visit(std::type_identity<T>{}), ...);
    }
    static constexpr int size = sizeof...(T);
};

/// A closed list of models that are templates on the number type.
template <template <class> class... Model>
struct ModelList {
    template <class R>
    using of = TypeList<Model<R>...>;

    /// Calls visit.template operator()<Model>() for each.
    template <class Visit>
    static constexpr void for_each(Visit&& visit) {
        (visit.template operator()<Model>(), ...);
    }
};

/// Number of scalars in a description.
template <class... Q>
constexpr int scalars_in(const std::tuple<Q...>& description) {
    return std::apply([](const auto&... q) { return (0 + ... + value_scalars(q)); }, description);
}

/// Calls visit(scalar of a, scalar of b, ...) for every scalar of every described member, in their
/// order.
template <class... Q, class Visit, class... Models>
constexpr void for_each_scalar(const std::tuple<Q...>& description, Visit&& visit,
                               Models&... models) {
    const auto one = [&](const auto& q) {
        if constexpr (value_scalars(std::remove_cvref_t<decltype(q)>{}) > 1)
            for (int i = 0; i < value_scalars(q); ++i) visit((models.*q.member)[i]...);
        else
            visit(models.*q.member...);
    };
    std::apply([&](const auto&... q) { (one(q), ...); }, description);
}

/// for_each_scalar over the parameters that a model describes.
template <class Visit, class Model, class... Models>
    requires requires { std::remove_const_t<Model>::params; }
constexpr void for_each_scalar(Visit&& visit, Model& model, Models&... models) {
    for_each_scalar(std::remove_const_t<Model>::params, visit, model, models...);
}

template <class Model>
constexpr int parameter_count() {
    return scalars_in(Model::params);
}

/// A described parameter without its type, for code that does not know the model.
struct ParameterInfo {
    const char* name;
    int scalars;
    double lo, hi;
    const char* unit;
};

template <class... Q>
constexpr std::array<ParameterInfo, sizeof...(Q)> parameter_infos(
    const std::tuple<Q...>& description) {
    return std::apply(
        [](const auto&... q) {
            return std::array<ParameterInfo, sizeof...(Q)>{
                ParameterInfo{q.name, value_scalars(q), q.lo, q.hi, q.unit}...};
        },
        description);
}

/// A model with parameters from a flat row, and a row from a model.
template <class Model, class R>
Model from_row(const R* row) {
    Model model;
    for_each_scalar([&](R& x) { x = *row++; }, model);
    return model;
}
template <class Model, class R>
void to_row(const Model& model, R* row) {
    for_each_scalar([&](const R& x) { *row++ = x; }, model);
}
/// A model on dual numbers: parameters from `row`, their tangents from `v`.
template <class Model, class R>
Model dual_from_rows(const R* row, const R* v) {
    Model model;
    for_each_scalar([&](Dual<R>& x) { x = Dual<R>(*row++, *v++); }, model);
    return model;
}

}  // namespace photograd
