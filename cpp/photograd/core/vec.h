// Small vectors. The only door to GLM.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "photograd/core/dual.h"

namespace photograd {

template <class R>
using Vec2 = glm::vec<2, R>;
template <class R>
using Vec3 = glm::vec<3, R>;
template <class R>
using Mat3 = glm::mat<3, 3, R>;

// GLM's own geometric functions insist on IEEE types; these accept Dual numbers as well.
template <class R>
constexpr R dot(const Vec3<R>& a, const Vec3<R>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class R>
constexpr Vec3<R> cross(const Vec3<R>& a, const Vec3<R>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class R>
R length(const Vec3<R>& a) {
    return sqrt(dot(a, a));
}

template <class R>
Vec3<R> normalize(const Vec3<R>& a) {
    return a * (R(1) / length(a));
}

}  // namespace photograd
