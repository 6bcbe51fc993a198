// Signed distances as flat functions, for the proofs (see op_list.h).
#pragma once

#include <array>

#include "input_group.h"
#include "photograd/ops/sdf_combine.h"
#include "photograd/ops/sdf_shapes.h"

namespace photograd {

template <class R>
Vec3<R> vec_at(const R* in) {
    return {in[0], in[1], in[2]};
}
template <class R>
void add_vec(const Vec3<R>& v, R* out) {
    for (int k = 0; k < 3; ++k) out[k] += v[k];
}

struct SdfSphereOp {
    static constexpr const char* name = "sdf_sphere";
    static constexpr std::array<InputGroup, 2> inputs{{{"p", 3, 0.2, 1.5}, {"radius", 1, 0.3, 2}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = sdf_sphere(vec_at(in), in[3]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_p(R(0));
        sdf_sphere_backward(vec_at(in), d_out[0], d_p, d_in[3]);
        add_vec(d_p, d_in);
    }
};

struct SdfPlaneOp {
    static constexpr const char* name = "sdf_plane";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"p", 3, -1, 1}, {"normal", 3, 0.2, 1.5}, {"height", 1, -1, 1}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = sdf_plane(vec_at(in), vec_at(in + 3), in[6]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_p(R(0)), d_normal(R(0));
        sdf_plane_backward(vec_at(in), vec_at(in + 3), d_out[0], d_p, d_normal, d_in[6]);
        add_vec(d_p, d_in);
        add_vec(d_normal, d_in + 3);
    }
};

struct SdfTorusOp {
    static constexpr const char* name = "sdf_torus";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"p", 3, 0.2, 0.9}, {"ring", 1, 1.5, 2}, {"tube", 1, 0.1, 0.4}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = sdf_torus(vec_at(in), in[3], in[4]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_p(R(0));
        sdf_torus_backward(vec_at(in), in[3], d_out[0], d_p, d_in[3], d_in[4]);
        add_vec(d_p, d_in);
    }
};

/// A point beyond a corner, on the negative side of Z; or one inside, nearest to a side across X.
template <bool Inside>
struct SdfBoxOp {
    static constexpr const char* name = Inside ? "sdf_box_inside" : "sdf_box";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"p", 3, Inside ? 0.1 : 1.1, Inside ? 0.5 : 2.0}, {"half", 3, 0.6, 1.0}}};
    static constexpr int outputs = 1;

    template <class R>
    static void setup(const R* in, Vec3<R>& p, Vec3<R>& half) {
        p = {in[0], in[1], -in[2]};
        half = vec_at(in + 3);
        if (Inside) half += Vec3<R>(R(0), R(2), R(3));
    }
    template <class R>
    static void forward(const R* in, R* out) {
        Vec3<R> p, half;
        setup(in, p, half);
        out[0] = sdf_box(p, half);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> p, half, d_p(R(0)), d_half(R(0));
        setup(in, p, half);
        sdf_box_backward(p, half, d_out[0], d_p, d_half);
        add_vec(Vec3<R>(d_p.x, d_p.y, -d_p.z), d_in);
        add_vec(d_half, d_in + 3);
    }
};

/// A point beyond the lower end: beside the rod, its length has no derivative.
struct SdfCapsuleOp {
    static constexpr const char* name = "sdf_capsule";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"p", 3, 1.1, 2.0}, {"half", 1, 0.6, 1.0}, {"radius", 1, 0.2, 0.8}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = sdf_capsule(Vec3<R>(in[0], -in[1], in[2]), in[3], in[4]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_p(R(0));
        sdf_capsule_backward(Vec3<R>(in[0], -in[1], in[2]), in[3], d_out[0], d_p, d_in[3], d_in[4]);
        add_vec(Vec3<R>(d_p.x, -d_p.y, d_p.z), d_in);
    }
};

/// Both orders of two distances that feel each other, a < b.
struct SmoothUnionOp {
    static constexpr const char* name = "smooth_union";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"a", 1, 0, 0.4}, {"b", 1, 0.5, 0.9}, {"k", 1, 1, 2}}};
    static constexpr int outputs = 2;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = smooth_union(in[0], in[1], in[2]);
        out[1] = smooth_union(in[1], in[0], in[2]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        smooth_union_backward(in[0], in[1], in[2], d_out[0], d_in[0], d_in[1], d_in[2]);
        smooth_union_backward(in[1], in[0], in[2], d_out[1], d_in[1], d_in[0], d_in[2]);
    }
};

struct ToShapeOp {
    static constexpr const char* name = "to_shape";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"p", 3, -1, 1}, {"quat", 4, 0.2, 1.5}, {"shift", 3, -1, 1}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* in, R* out) {
        const Vec3<R> local = to_shape(vec_at(in), in + 3, vec_at(in + 7));
        for (int k = 0; k < 3; ++k) out[k] = local[k];
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_p(R(0)), d_shift(R(0));
        to_shape_backward(vec_at(in), in + 3, vec_at(in + 7), vec_at(d_out), d_p, d_in + 3,
                          d_shift);
        add_vec(d_p, d_in);
        add_vec(d_shift, d_in + 7);
    }
};

}  // namespace photograd
