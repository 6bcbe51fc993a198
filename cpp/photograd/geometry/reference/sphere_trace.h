// Where rays hit the surface of a signed distance field (SDF) [Hart1996].
//
// Nothing lies nearer than the distance, so a step of that length cannot pass through the surface;
// steps shrink as it comes close. That the march finds the first hit rests on |f(p) - f(q)| <=
// |p - q| alone (f is 1-Lipschitz).
//
// The march ends within a tolerance of the surface; Newton steps t -= f / <n, w>, n = df/dp, w the
// direction, then bring the hit to rounding, as long as they bring f nearer to 0.
//
// A hit stays on the surface while the body changes: f(o + t w, x) = 0 for all numbers x, hence
//
//   <n, w> dt/dx + df/dx = 0        dt/dx = -(df/dx) / <n, w>
//   <n, w> dt/do + n = 0            dt/do = -n / <n, w>        dt/dw = -t n / <n, w>
//
// These are the derivatives inside of the silhouette; where <n, w> goes to 0 they grow without
// bound.
#pragma once

#include "photograd/geometry/ray_order.h"
#include "photograd/geometry/reference/sdf.h"

namespace photograd {

/// gave_up: max_steps were not enough; t is then how far the way is known to be free.
enum class SdfEnd : std::int8_t { missed, hit, gave_up };

struct SdfMarch {
    double t_min, t_max, tolerance;
    std::int32_t max_steps;
};

/// Arrays (R,), filled: t (infinite where nothing was met), f evaluated, how the ray ended. A ray
/// that starts inside has its hit at t_min. Directions need not have unit length: t counts in their
/// lengths.
struct SdfHits {
    double* t;
    std::int32_t* steps;
    SdfEnd* end;
};

/// Results do not depend on the number of threads, to the bit.
void trace_sdf(const Sdf& body, const double* numbers, const RaySpan<double>& rays,
               const SdfMarch& march, const SdfHits& hits);

/// Adds dL/dnumbers, dL/dorigins and dL/ddirections (R, 3) of dL/dt (R,); rows that end otherwise
/// than in a hit, and those that started inside, have no derivative and are left out.
void trace_sdf_backward(const Sdf& body, const double* numbers, const RaySpan<double>& rays,
                        const SdfMarch& march, const double* t, const SdfEnd* end,
                        const double* d_t, double* d_numbers, double* d_origins,
                        double* d_directions);

}  // namespace photograd
