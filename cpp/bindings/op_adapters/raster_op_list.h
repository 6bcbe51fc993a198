// Triangles in the image as flat functions, for the proofs (see op_list.h).
#pragma once

#include <array>

#include "input_group.h"
#include "photograd/raster/triangle.h"

namespace photograd {

/// A triangle around the point (0.3, 0.4), its corners at depths of their own; outputs b and z.
struct ScreenPointOp {
    static constexpr const char* name = "screen_point";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"first", 3, -0.1, 0.1}, {"second", 3, -0.1, 0.1}, {"third", 3, -0.1, 0.1}}};
    static constexpr int outputs = 4;

    template <class R>
    struct Setup {
        Vec3<R> v[3], p{R(0.3), R(0.4), R(1)};
        TriangleEdges<R> edges;
        ScreenPoint<R> point;
        explicit Setup(const R* in) {
            const double base[3][3] = {{-0.5, -0.4, 0.8}, {1.6, 0.1, 1.2}, {0.2, 2.1, 1.7}};
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k) v[i][k] = in[3 * i + k] + R(base[i][k]);
            edges = TriangleEdges<R>::of(v[0], v[1], v[2]);
            point = screen_point(edges, p);
        }
    };
    template <class R>
    static void forward(const R* in, R* out) {
        const Setup<R> at(in);
        for (int i = 0; i < 3; ++i) out[i] = at.point.b[i];
        out[3] = at.point.z;
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const Setup<R> at(in);
        Vec3<R> d_v[3] = {};
        const ScreenPoint<R> d_point{{d_out[0], d_out[1], d_out[2]}, d_out[3]};
        screen_point_backward(at.v, at.edges, at.p, at.point, d_point, d_v);
        for (int i = 0; i < 9; ++i) d_in[i] += d_v[i / 3][i % 3];
    }
};

}  // namespace photograd
