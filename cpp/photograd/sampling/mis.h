// Weights of multiple importance sampling for light that two strategies can sample [Veach1995].
//
//   balance    w(p, q) = p / (p + q)
//   power      w(p, q) = p^2 / (p^2 + q^2)           lower variance where one strategy is good
//
// p is the density of the strategy that took the sample, q that of the other, over the same
// measure; w(p, q) + w(q, p) = 1. Weights are detached: adjoints hold them constant.
#pragma once

#include "photograd/core/real.h"

namespace photograd {

enum class Heuristic : int { balance = 0, power = 1 };  // power: [Veach1995, Sec. 3.4], exponent 2

template <class R>
R mis_weight(Heuristic heuristic, R p, R q) {
    if (!(p > R(0))) return R(0);
    const R r = q / p;  // p^2 would overflow a float long before p does
    return R(1) / (R(1) + (heuristic == Heuristic::balance ? r : r * r));
}

}  // namespace photograd
