// sin and cos with the same bits on every processor (libm picks its variant by processor).
#pragma once

namespace photograd {

template <class R>
struct SinCos {
    R sin, cos;
};

/// Taylor polynomials to x^15 and x^16: remainders below 2e-17 on |x| <= pi/4.
template <class R>
SinCos<R> sin_cos_small(R x) {
    const R y = x * x;
    R s = R(-1.0 / 1307674368000.0), c = R(1.0 / 20922789888000.0);
    constexpr double sine[] = {1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0,
                               -1.0 / 5040.0,      1.0 / 120.0,       -1.0 / 6.0};
    constexpr double cosine[] = {-1.0 / 87178291200.0,
                                 1.0 / 479001600.0,
                                 -1.0 / 3628800.0,
                                 1.0 / 40320.0,
                                 -1.0 / 720.0,
                                 1.0 / 24.0,
                                 -0.5};
    for (const double a : sine) s = s * y + R(a);
    for (const double a : cosine) c = c * y + R(a);
    return {x + x * y * s, R(1) + y * c};
}

/// On [-pi, pi]: those of a quarter of the angle, doubled twice, at a cost of two digits in the
/// last place.
template <class R>
SinCos<R> sin_cos(R x) {
    SinCos<R> part = sin_cos_small(R(0.25) * x);
    for (int k = 0; k < 2; ++k)
        part = {R(2) * part.sin * part.cos, part.cos * part.cos - part.sin * part.sin};
    return part;
}

}  // namespace photograd
