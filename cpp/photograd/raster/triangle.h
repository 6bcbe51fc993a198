// A triangle seen by a pinhole camera: barycentrics and depth at a point of the image.
//
// A vertex stands in homogeneous pixels, V = (z x, z y, z) for a depth z and a position (x, y) in
// the image, V = K (R X + t). With p = (x, y, 1) [Olano1997]
//
//   w_0 = <V1 x V2, p>   w_1 = <V2 x V0, p>   w_2 = <V0 x V1, p>   det = <V0, V1 x V2>
//   s = w_0 + w_1 + w_2      b_i = w_i / s      z = det / s
//
// since p z = sum b_i V_i is the point of the triangle. The b_i are those of the triangle in the
// world, perspective and all, and no vertex is ever divided by its depth: a triangle that reaches
// behind the camera needs no clipping. w_i(p) = 0 is the line of the edge opposite to corner i; two
// triangles that share an edge calculate the same numbers with opposite signs, to the last bit.
//
// Of the cotangents d_b, d_z:
//
//   d_w_i = (d_b_i - sum_j d_b_j b_j - d_z z) / s      d_det = d_z / s
//   d_V1 += d_w_0 V2 x p   d_V2 += d_w_0 p x V1   and around;   d_V0 += d_det V1 x V2   and around
//
// Which triangle is seen is held constant, and so is p.
#pragma once

#include "photograd/core/vec.h"

namespace photograd {

/// Lines of the edges opposite to each corner, and the determinant; negative for a triangle whose
/// corners run counter-clockwise as the camera sees them, in an image with y downwards.
template <class R>
struct TriangleEdges {
    Vec3<R> line[3];
    R det;

    static TriangleEdges of(const Vec3<R>& v0, const Vec3<R>& v1, const Vec3<R>& v2) {
        TriangleEdges out{{cross(v1, v2), cross(v2, v0), cross(v0, v1)}, R(0)};
        out.det = dot(v0, out.line[0]);
        return out;
    }
};

/// Weights of the three corners, of sum 1, and the depth.
template <class R>
struct ScreenPoint {
    R b[3], z;
};

/// Where the ray through p = (x, y, 1) meets the plane of the triangle.
template <class R>
ScreenPoint<R> screen_point(const TriangleEdges<R>& edges, const Vec3<R>& p) {
    const R w0 = dot(edges.line[0], p), w1 = dot(edges.line[1], p), w2 = dot(edges.line[2], p);
    const R s = w0 + w1 + w2;
    return {{w0 / s, w1 / s, w2 / s}, edges.det / s};
}
/// `point` is what screen_point found. Adds to d_v, of the three corners.
template <class R>
void screen_point_backward(const Vec3<R> (&v)[3], const TriangleEdges<R>& edges, const Vec3<R>& p,
                           const ScreenPoint<R>& point, const ScreenPoint<R>& d_point,
                           Vec3<R> (&d_v)[3]) {
    const R s = dot(edges.line[0], p) + dot(edges.line[1], p) + dot(edges.line[2], p);
    R shared = d_point.z * point.z;
    for (int i = 0; i < 3; ++i) shared += d_point.b[i] * point.b[i];
    const R d_det = d_point.z / s;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const R d_w = (d_point.b[i] - shared) / s;
        d_v[j] += d_w * cross(v[k], p);
        d_v[k] += d_w * cross(p, v[j]);
        d_v[i] += d_det * edges.line[i];
    }
}

}  // namespace photograd
