// A polynomial in two variables with its slopes, by Horner's scheme.
//
//   v = sum_ij c_ij x^i y^j,   coefficients with j the faster
#pragma once

#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
struct Polynomial {
    R value, by_x, by_y;

    /// Of degree `x_degree` in x and `y_degree` in y.
    static Polynomial of(const double* c, int x_degree, int y_degree, R x, R y) {
        Polynomial sum{R(0), R(0), R(0)};
        for (int i = x_degree; i >= 0; --i) {
            R row = R(0), slope = R(0);
            for (int j = y_degree; j >= 0; --j) {
                slope = slope * y + row;
                row = row * y + R(c[i * (y_degree + 1) + j]);
            }
            sum.by_x = sum.by_x * x + sum.value;
            sum.value = sum.value * x + row;
            sum.by_y = sum.by_y * x + slope;
        }
        return sum;
    }
};

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
