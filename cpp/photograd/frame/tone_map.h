// Tone mapping of pictures, and its adjoint. The curves are in ops/tone_curve.h.
#pragma once

#include <cstdint>

#include "photograd/core/real.h"

namespace photograd {

enum class ToneCurve { reinhard, aces, agx };
inline constexpr int tone_parameter_counts[] = {1, 5, 2};

/// out (N, 3) of color (N, 3), both linear; params as ops/tone_curve.h lists them.
template <Real R>
void tone_map(ToneCurve curve, const R* params, const R* color, std::int64_t count, R* out);

/// Adds to d_color (N, 3) and d_params.
template <Real R>
void tone_map_backward(ToneCurve curve, const R* params, const R* color, std::int64_t count,
                       const R* d_out, R* d_color, R* d_params);

}  // namespace photograd
