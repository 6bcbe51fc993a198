// One-blob encoding [Mueller2019, Sec. 4.3] of numbers in [0, 1]: K bins hold the values of a
// Gaussian around the number, with a standard deviation of one bin, at the bins' centers:
//
//   feature_i = exp(-K^2 (c_i - p)^2 / 2),  c_i = (i + 1/2) / K
//
// Adjoint: d_p += sum_i feature_i K^2 (c_i - p) d_feature_i.
#pragma once

#include <cstdint>

#include "photograd/core/exp.h"
#include "photograd/core/real.h"

namespace photograd {

struct OneBlobEncoding {
    int dimensions, bins;

    [[nodiscard]] int features() const { return dimensions * bins; }

    /// Feature f is written to out[f * stride].
    template <Real R>
    void encode(const R* p, std::int64_t stride, R* out) const {
        for (int a = 0; a < dimensions; ++a)
            for (int i = 0; i < bins; ++i) {
                const R x = apart(i, p[a]);
                out[(a * bins + i) * stride] = exp(R(-0.5) * x * x);
            }
    }

    template <Real R>
    void backward(const R* p, std::int64_t stride, const R* d_out, R* d_p) const {
        for (int a = 0; a < dimensions; ++a)
            for (int i = 0; i < bins; ++i) {
                const R x = apart(i, p[a]);
                d_p[a] += exp(R(-0.5) * x * x) * R(bins) * x * d_out[(a * bins + i) * stride];
            }
    }

private:
    /// K (c_i - p)
    template <Real R>
    [[nodiscard]] R apart(int i, R p) const {
        return (R(i) + R(0.5)) - R(bins) * p;
    }
};

}  // namespace photograd
