// A ray o + t d. Directions handed to renderers have unit length, so t is in meters.
#pragma once

#include "photograd/core/vec.h"

namespace photograd {

template <class R>
struct Ray {
    Vec3<R> origin;
    Vec3<R> direction;

    [[nodiscard]] Vec3<R> at(R t) const { return origin + t * direction; }
};

}  // namespace photograd
