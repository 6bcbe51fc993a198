// Dual numbers: forward-mode derivatives that are exact to rounding.
//
// A Dual carries a value and its derivative along one direction v. Running an op on Duals gives J v
// in one pass, which the dot-product test <J v, w> = <v, J^T w> compares with the hand-written
// backward (J^T w). Arithmetic follows the rules of calculus:
// (a + e a')(b + e b') = ab + e (a' b + a b').
#pragma once

#include <compare>

#include "photograd/core/exp.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class T>
struct Dual {
    T value;
    T tangent;

    Dual() = default;
    constexpr Dual(T v) : value(v), tangent(0) {}  // NOLINT: constants enter formulas implicitly
    constexpr Dual(T v, T dv) : value(v), tangent(dv) {}
    constexpr explicit Dual(int v) : value(T(v)), tangent(0) {}

    constexpr Dual operator-() const { return {-value, -tangent}; }
    constexpr Dual& operator+=(Dual b) { return *this = *this + b; }
    constexpr Dual& operator-=(Dual b) { return *this = *this - b; }
    constexpr Dual& operator*=(Dual b) { return *this = *this * b; }
    constexpr Dual& operator/=(Dual b) { return *this = *this / b; }

    friend constexpr Dual operator+(Dual a, Dual b) {
        return {a.value + b.value, a.tangent + b.tangent};
    }
    friend constexpr Dual operator-(Dual a, Dual b) {
        return {a.value - b.value, a.tangent - b.tangent};
    }
    friend constexpr Dual operator*(Dual a, Dual b) {
        return {a.value * b.value, a.tangent * b.value + a.value * b.tangent};
    }
    friend constexpr Dual operator/(Dual a, Dual b) {
        const T ratio = a.value / b.value;
        return {ratio, (a.tangent - ratio * b.tangent) / b.value};
    }
    // Branches follow the value alone: the derivative is that of the branch taken.
    friend constexpr bool operator==(Dual a, Dual b) { return a.value == b.value; }
    friend constexpr auto operator<=>(Dual a, Dual b) { return a.value <=> b.value; }
};

/// Truncation to an integer has derivative zero almost everywhere; only the value matters.
template <class T>
constexpr int to_int(Dual<T> x) {
    return static_cast<int>(x.value);
}
constexpr int to_int(float x) { return static_cast<int>(x); }
constexpr int to_int(double x) { return static_cast<int>(x); }

template <class T>
inline Dual<T> exp(Dual<T> x) {
    const T e = exp(x.value);
    return {e, e * x.tangent};
}

template <class T>
inline Dual<T> expm1(Dual<T> x) {
    return {expm1(x.value), exp(x.value) * x.tangent};
}

template <class T>
inline Dual<T> log1p_unit(Dual<T> x) {
    return {log1p_unit(x.value), x.tangent / (T(1) + x.value)};
}

inline float sqrt(float x) { return __builtin_sqrtf(x); }
inline double sqrt(double x) { return __builtin_sqrt(x); }

template <class T>
inline Dual<T> sqrt(Dual<T> x) {
    const T root = sqrt(x.value);
    return {root, x.tangent / (T(2) * root)};
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
