// Activations: from an unbounded parameter to a density (>= 0) or a color (in [0, 1]).
//
// Trilinear interpolation acts on the raw parameters and the activation on the result, which keeps
// a surface inside a voxel sharp [Sun2022, Sec. 4.1].
//
//   identity  y = x
//   relu      y = max(x, 0)        dy/dx = [x > 0]      dead below 0: no gradient ever revives it
//   softplus  y = ln(1 + e^x)      dy/dx = sigmoid(x)
//   exp       y = e^x              dy/dx = y
//   sigmoid   y = 1 / (1 + e^-x)   dy/dx = y (1 - y)
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

enum class Activation : int { identity = 0, relu = 1, softplus = 2, exp = 3, sigmoid = 4 };

template <class R>
inline R relu(R x) {
    return larger(x, R(0));
}
template <class R>
inline void relu_backward(R x, R d_y, R& d_x) {
    d_x += x > R(0) ? d_y : R(0);
}

template <class R>
inline R sigmoid(R x) {
    // e^-|x| <= 1 cannot overflow; the two signs share it.
    const R e = exp(x < R(0) ? x : -x);
    return (x < R(0) ? e : R(1)) / (R(1) + e);
}
template <class R>
inline void sigmoid_backward(R x, R d_y, R& d_x) {
    const R e = exp(x < R(0) ? x : -x);
    const R denominator = R(1) + e;
    d_x += d_y * (e / (denominator * denominator));  // y (1 - y) without cancellation
}

template <class R>
inline R softplus(R x) {
    const R e = exp(x < R(0) ? x : -x);
    return larger(x, R(0)) + log1p_unit(e);
}
template <class R>
inline void softplus_backward(R x, R d_y, R& d_x) {
    d_x += d_y * sigmoid(x);
}

template <class R>
inline R exponential(R x) {
    return exp(x);
}
template <class R>
inline void exponential_backward(R x, R d_y, R& d_x) {
    d_x += d_y * exp(x);
}

/// The activation named by `kind`. The switch is loop-invariant where it matters.
template <class R>
inline R activate(Activation kind, R x) {
    switch (kind) {
        case Activation::relu: return relu(x);
        case Activation::softplus: return softplus(x);
        case Activation::exp: return exponential(x);
        case Activation::sigmoid: return sigmoid(x);
        default: return x;
    }
}
template <class R>
inline void activate_backward(Activation kind, R x, R d_y, R& d_x) {
    switch (kind) {
        case Activation::relu: relu_backward(x, d_y, d_x); break;
        case Activation::softplus: softplus_backward(x, d_y, d_x); break;
        case Activation::exp: exponential_backward(x, d_y, d_x); break;
        case Activation::sigmoid: sigmoid_backward(x, d_y, d_x); break;
        default: d_x += d_y;
    }
}

/// dy/dx from y alone, where x was not kept.
template <class R>
inline R derivative_at_value(Activation kind, R y) {
    switch (kind) {
        case Activation::relu: return y > R(0) ? R(1) : R(0);
        case Activation::softplus: return -expm1(-y);  // y = ln(1 + e^x): 1 - e^-y = sigmoid(x)
        case Activation::exp: return y;
        case Activation::sigmoid: return y * (R(1) - y);
        default: return R(1);
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
