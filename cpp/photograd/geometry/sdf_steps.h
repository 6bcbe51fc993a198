// A signed distance field (SDF) as a list of steps for a stack: the same function as its tree
// (reference/sdf.h), faster to evaluate.
//
// A shape pushes its distance f; a combination pops b, then a, and pushes one distance. Placements
// and scalings are not steps: they are folded into the shapes when the list is made
// (sdf_solid.cpp), since
//
//   s f(p / s; lengths) = f(p; s lengths)
//
// for every shape and combination. The gradient with respect to p is carried along: each f on the
// stack has its g = df/dp beside it.
//
//   shape at q = M p + c       g = M^T df/dq        M a rotation
//   min(a, b)                  that of the smaller one; where both are equal, the first's
//   max(a, b), max(a, -b)      that of the larger one, of b with its sign
//   smooth union               df/da g_a + df/db g_b
//   f - r                      g
#pragma once

#include <span>

#include "photograd/geometry/sdf_step.h"
#include "photograd/ops/sdf_combine.h"
#include "photograd/ops/sdf_shapes.h"

namespace photograd {

template <class R>
R shape_distance(const SdfStep& step, const Vec3<R>& q) {
    const auto& x = step.x;
    switch (step.kind) {
        case SdfKind::sphere: return sdf_sphere(q, R(x[0]));
        case SdfKind::torus: return sdf_torus(q, R(x[0]), R(x[1]));
        case SdfKind::box: return sdf_box(q, Vec3<R>(R(x[0]), R(x[1]), R(x[2])));
        case SdfKind::capsule: return sdf_capsule(q, R(x[0]), R(x[1]));
        default: return sdf_plane(q, Vec3<R>(R(x[0]), R(x[1]), R(x[2])), R(x[3]));
    }
}
inline Vec3<double> shape_gradient(const SdfStep& step, const Vec3<double>& q) {
    const auto& x = step.x;
    const Vec3<double> three(x[0], x[1], x[2]);
    Vec3<double> g(0), unused(0);
    double none = 0;
    switch (step.kind) {
        case SdfKind::sphere: sdf_sphere_backward(q, 1.0, g, none); break;
        case SdfKind::torus: sdf_torus_backward(q, x[0], 1.0, g, none, none); break;
        case SdfKind::box: sdf_box_backward(q, three, 1.0, g, unused); break;
        case SdfKind::capsule: sdf_capsule_backward(q, x[0], 1.0, g, none, none); break;
        default: sdf_plane_backward(q, three, 1.0, g, unused, none);
    }
    const auto& m = step.shape_from_world.m;
    return {m[0] * g.x + m[4] * g.y + m[8] * g.z, m[1] * g.x + m[5] * g.y + m[9] * g.z,
            m[2] * g.x + m[6] * g.y + m[10] * g.z};
}

/// f(p), meters; negative inside.
template <class R>
R steps_distance(std::span<const SdfStep> steps, const Vec3<R>& p) {
    R stack[SdfStep::deepest];
    int top = -1;
    for (const SdfStep& step : steps) {
        if (step.kind == SdfKind::round) {
            stack[top] = stack[top] - R(step.x[0]);
        } else if (sdf_child_count(step.kind) == 0) {
            stack[++top] = shape_distance(step, step.shape_from_world.point(p));
        } else {
            const R b = stack[top--];
            R& a = stack[top];
            switch (step.kind) {
                case SdfKind::unite: a = b < a ? b : a; break;
                case SdfKind::intersect: a = b > a ? b : a; break;
                case SdfKind::subtract: a = -b > a ? -b : a; break;
                default: a = smooth_union(a, b, R(step.x[0]));
            }
        }
    }
    return stack[0];
}

/// df/dp: out of the surface, of length 1 but where a smooth union blends.
inline Vec3<double> steps_gradient(std::span<const SdfStep> steps, const Vec3<double>& p) {
    double f[SdfStep::deepest];
    Vec3<double> g[SdfStep::deepest];
    int top = -1;
    for (const SdfStep& step : steps) {
        if (step.kind == SdfKind::round) {
            f[top] -= step.x[0];
            continue;
        }
        if (sdf_child_count(step.kind) == 0) {
            const Vec3<double> q = step.shape_from_world.point(p);
            f[++top] = shape_distance(step, q);
            g[top] = shape_gradient(step, q);
            continue;
        }
        const double b = f[top], sign = step.kind == SdfKind::subtract ? -1 : 1;
        const Vec3<double> g_b = g[top--];
        double& a = f[top];
        if (step.kind == SdfKind::smooth_unite) {
            double d_a = 0, d_b = 0, none = 0;
            smooth_union_backward(a, b, step.x[0], 1.0, d_a, d_b, none);
            g[top] = d_a * g[top] + d_b * g_b;
            a = smooth_union(a, b, step.x[0]);
        } else if (step.kind == SdfKind::unite ? b < a : sign * b > a) {
            a = sign * b;
            g[top] = sign * g_b;
        }
    }
    return g[0];
}

}  // namespace photograd
