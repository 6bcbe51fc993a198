// Parameter descriptions: what a model says about itself, once.
//
// A model lists its continuous parameters in one line,
//     static constexpr auto params = describe(p("roughness", &Ggx::roughness, 0.01, 1, "1"));
// and everything that must visit parameters (constructor and properties in Python, gradient proof,
// benchmark row, gallery picture) iterates over that tuple. The adjoint of a model has the model's own
// type, so a new parameter gets its slot for a derivative without another line.
#pragma once

#include <tuple>
#include <type_traits>

#include "photograd/core/vec.h"

namespace photograd {

template <class Model, class Value>
struct Parameter {
    const char* name;
    Value Model::*member;
    double lo, hi;     // range in which values make sense; tests draw from its inside
    const char* unit;  // "1" for pure numbers
};

template <class Model, class Value>
constexpr Parameter<Model, Value> p(const char* name, Value Model::*member, double lo, double hi,
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

/// Number of scalars in a parameter's value: 1, or 3 for a colour or vector.
template <class Value>
constexpr int scalar_count() {
    if constexpr (std::is_class_v<Value> && !std::is_same_v<Value, Dual<double>>)
        return Value::length();
    else
        return 1;
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

}  // namespace photograd
