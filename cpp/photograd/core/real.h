// The number types that ops and renderers are templates on.
//
//   float          fast, what a fit runs in
//   double         verifying: adjoints are compared with finite differences
//   Dual<double>   verifying: exact forward-mode derivatives (ops only)
#pragma once

#include <concepts>

#include "photograd/core/dual.h"

namespace photograd {

/// Types whose arrays cross the Python boundary.
template <class R>
concept Real = std::same_as<R, float> || std::same_as<R, double>;

/// Types that an op accepts.
template <class R>
concept DifferentiableReal = Real<R> || std::same_as<R, Dual<double>>;

}  // namespace photograd
