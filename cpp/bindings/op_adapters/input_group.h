// A named group of differentiable inputs of an op, and where proofs draw them.
#pragma once

namespace photograd {

struct InputGroup {
    const char* name;
    int size;
    double lo, hi;  // proofs draw inputs from here; kinks lie outside
};

}  // namespace photograd
