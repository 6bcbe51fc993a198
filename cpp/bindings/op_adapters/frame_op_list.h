// What a frame is graded with as flat functions, for the proofs (see op_list.h).
#pragma once

#include <array>

#include "input_group.h"
#include "photograd/ops/obscurance.h"
#include "photograd/ops/tone_curve.h"

namespace photograd {

struct ReinhardOp {
    static constexpr const char* name = "reinhard";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"x", 1, 0.0, 20.0}, {"white", 1, 1.0, 8.0}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = reinhard(in[0], in[1]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        reinhard_backward(in[0], in[1], d_out[0], d_in[0], d_in[1]);
    }
};

struct AcesFitOp {
    static constexpr const char* name = "aces_fit";
    static constexpr std::array<InputGroup, 2> inputs{{{"x", 1, 0.0, 5.0}, {"k", 5, 0.2, 3.0}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = aces_fit(in[0], in + 1);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        aces_fit_backward(in[0], in + 1, d_out[0], d_in[0], d_in + 1);
    }
};

/// Below and above the pivot.
template <bool Below>
struct AgxContrastOp {
    static constexpr const char* name = Below ? "agx_toe" : "agx_shoulder";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"t", 1, Below ? 0.05 : 0.62, Below ? 0.6 : 0.98},
         {"slope", 1, 1.6, 3.0},
         {"power", 1, 1.2, 3.0}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = agx_contrast(in[0], in[1], in[2]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        agx_contrast_backward(in[0], in[1], in[2], d_out[0], d_in[0], d_in[1], d_in[2]);
    }
};

/// A color whose shown channels are positive, and parameters of the contrast.
struct AgxColorOp {
    static constexpr const char* name = "agx_color";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"color", 3, 0.3, 1.5}, {"slope", 1, 1.6, 3.0}, {"power", 1, 1.2, 3.0}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* in, R* out) {
        const AgxColor<R> at(in, in + 3);
        for (int i = 0; i < 3; ++i) out[i] = at.out[i];
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        AgxColor<R>(in, in + 3).backward(in + 3, d_out, d_in, d_in + 3);
    }
};

/// A point above the plane of another, within the radius.
struct ObscuranceOp {
    static constexpr const char* name = "obscurance";
    static constexpr std::array<InputGroup, 4> inputs{{{"v", 3, 0.1, 0.4},
                                                       {"radius", 1, 1.0, 2.0},
                                                       {"falloff", 1, 0.5, 3.0},
                                                       {"bias", 1, 0.0, 0.1}}};
    static constexpr int outputs = 1;
    template <class R>
    static Vec3<R> normal() {
        return {R(0.6), R(0), R(0.8)};
    }
    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = obscurance(Vec3<R>(in[0], in[1], in[2]), normal<R>(),
                            Obscurance<R>{in[3], in[4], in[5]});
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_v(R(0));
        Obscurance<R> d_by{R(0), R(0), R(0)};
        obscurance_backward(Vec3<R>(in[0], in[1], in[2]), normal<R>(),
                            Obscurance<R>{in[3], in[4], in[5]}, d_out[0], d_v, d_by);
        for (int k = 0; k < 3; ++k) d_in[k] += d_v[k];
        d_in[3] += d_by.radius;
        d_in[4] += d_by.falloff;
        d_in[5] += d_by.bias;
    }
};

}  // namespace photograd
