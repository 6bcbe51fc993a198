// A named group of differentiable inputs of an op, and the range in which proofs sample them.
#pragma once

namespace photograd {

struct InputGroup {
    const char* name;
    int size;
    double lo, hi;  // sampled range; kinks lie outside
};

}  // namespace photograd
