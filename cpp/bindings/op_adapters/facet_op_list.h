// Adapters for the proofs, see op_list.h: the pieces that reflectance models are made of.
#pragma once

#include <array>

#include "input_group.h"
#include "photograd/ops/beckmann.h"
#include "photograd/ops/charlie.h"
#include "photograd/ops/dispersion.h"
#include "photograd/ops/erf.h"
#include "photograd/ops/fresnel_conductor.h"
#include "photograd/ops/fresnel_dielectric.h"
#include "photograd/ops/fresnel_schlick.h"
#include "photograd/ops/ggx.h"
#include "photograd/ops/ggx_fast.h"
#include "photograd/ops/gtr1.h"
#include "photograd/ops/principled.h"
#include "photograd/ops/refract.h"
#include "photograd/ops/thin_film.h"

namespace photograd {

struct ErfOp {
    static constexpr const char* name = "erf";
    static constexpr std::array<InputGroup, 1> inputs{{{"x", 3, 0.01, 3.0}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* x, R* y) {
        for (int i = 0; i < 3; ++i) y[i] = erf(x[i]);
    }
    template <class R>
    static void backward(const R* x, const R* d_y, R* d_x) {
        for (int i = 0; i < 3; ++i) erf_backward(x[i], d_y[i], d_x[i]);
    }
};

struct SchlickOp {
    static constexpr const char* name = "fresnel_schlick";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"f0", 1, 0.02, 0.9}, {"f90", 1, 0.5, 1.0}, {"cos_theta", 1, 0.05, 0.9}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = schlick(in[0], in[1], in[2]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        schlick_backward(in[0], in[1], in[2], d_out[0], d_in[0], d_in[1], d_in[2]);
    }
};

/// f0 of an index, and the indices of three channels.
struct IndexOp {
    static constexpr const char* name = "refractive_index";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"eta", 1, 1.1, 2.4}, {"dispersion", 1, 0.1, 2.0}}};
    static constexpr int outputs = 4;

    template <class R>
    static void forward(const R* in, R* out) {
        const Vec3<R> index = channel_indices(in[0], in[1]);
        for (int k = 0; k < 3; ++k) out[k] = index[k];
        out[3] = schlick_f0(in[0]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        channel_indices_backward(in[0], in[1], Vec3<R>(d_out[0], d_out[1], d_out[2]), d_in[0],
                                 d_in[1]);
        schlick_f0_backward(in[0], d_out[3], d_in[0]);
    }
};

/// Light from outside into glass, or from inside out, before total reflection begins.
template <bool Leaving>
struct DielectricOp {
    static constexpr const char* name =
        Leaving ? "fresnel_dielectric_leaving" : "fresnel_dielectric";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"eta", 1, Leaving ? 0.6 : 1.2, Leaving ? 0.9 : 2.4},
         {"cos_theta", 1, Leaving ? 0.85 : 0.05, 0.98}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = fresnel_dielectric(in[0], in[1]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        fresnel_dielectric_backward(in[0], in[1], d_out[0], d_in[0], d_in[1]);
    }
};

/// A viewer outside, and one inside of glass before total reflection begins; wo need not be of unit
/// length.
struct RefractOp {
    static constexpr const char* name = "refract";
    static constexpr std::array<InputGroup, 2> inputs{{{"wo", 6, 0.6, 0.9}, {"e", 1, 1.2, 1.3}}};
    static constexpr int outputs = 6;

    template <class R>
    static void forward(const R* in, R* out) {
        for (int side = 0; side < 2; ++side) {
            const Vec3<R> wi = refract(viewer(in, side), side == 0 ? in[6] : R(1) / in[6]);
            for (int k = 0; k < 3; ++k) out[3 * side + k] = wi[k];
        }
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        for (int side = 0; side < 2; ++side) {
            const R* d = d_out + 3 * side;
            Vec3<R> d_wo(R(0));
            R d_e = R(0);
            refract_backward(viewer(in, side), side == 0 ? in[6] : R(1) / in[6],
                             Vec3<R>(d[0], d[1], d[2]), d_wo, d_e);
            d_in[6] += side == 0 ? d_e : -d_e / (in[6] * in[6]);
            for (int k = 0; k < 3; ++k) d_in[3 * side + k] += side && k == 2 ? -d_wo[k] : d_wo[k];
        }
    }
    template <class R>
    static Vec3<R> viewer(const R* in, int side) {
        const R* w = in + 3 * side;
        return {w[0], w[1], side ? -w[2] : w[2]};
    }
};

struct ConductorOp {
    static constexpr const char* name = "fresnel_conductor";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"eta", 1, 0.05, 4.0}, {"k", 1, 0.2, 8.0}, {"cos_theta", 1, 0.05, 0.98}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = fresnel_conductor(in[0], in[1], in[2]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        fresnel_conductor_backward(in[0], in[1], in[2], d_out[0], d_in[0], d_in[1], d_in[2]);
    }
};

/// D and V for directions that need not be of unit length: the formulas are defined for others,
/// too.
struct GgxOp {
    static constexpr const char* name = "ggx";
    static constexpr std::array<InputGroup, 4> inputs{
        {{"wh", 3, 0.1, 0.9}, {"wo", 3, 0.2, 0.8}, {"wi", 3, 0.2, 0.8}, {"alpha", 2, 0.1, 0.9}}};
    static constexpr int outputs = 2;

    template <class R>
    static Vec3<R> vector(const R* v) {
        return {v[0], v[1], v[2]};
    }
    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = ggx_D(vector(in), in[9], in[10]);
        out[1] = ggx_V(vector(in + 3), vector(in + 6), in[9], in[10]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_wh(R(0)), d_wo(R(0)), d_wi(R(0));
        ggx_D_backward(vector(in), in[9], in[10], d_out[0], d_wh, d_in[9], d_in[10]);
        ggx_V_backward(vector(in + 3), vector(in + 6), in[9], in[10], d_out[1], d_wo, d_wi, d_in[9],
                       d_in[10]);
        for (int k = 0; k < 3; ++k) {
            d_in[k] += d_wh[k];
            d_in[3 + k] += d_wo[k];
            d_in[6 + k] += d_wi[k];
        }
    }
};

struct GgxFastOp {
    static constexpr const char* name = "ggx_fast";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"o_z", 1, 0.1, 0.9}, {"i_z", 1, 0.1, 0.9}, {"alpha", 1, 0.1, 0.9}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = ggx_V_fast(in[0], in[1], in[2]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        ggx_V_fast_backward(in[0], in[1], in[2], d_out[0], d_in[0], d_in[1], d_in[2]);
    }
};

struct BeckmannOp {
    static constexpr const char* name = "beckmann";
    static constexpr std::array<InputGroup, 1> inputs{{{"alpha", 1, 0.1, 0.9}}};
    static constexpr int outputs = 2;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = beckmann_D(direction<R>(0.28, 0.96), in[0]);
        out[1] = beckmann_V(direction<R>(0.8, 0.6), direction<R>(0.96, 0.28), in[0]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        beckmann_D_backward(direction<R>(0.28, 0.96), in[0], d_out[0], d_in[0]);
        beckmann_V_backward(direction<R>(0.8, 0.6), direction<R>(0.96, 0.28), in[0], d_out[1],
                            d_in[0]);
    }
    template <class R>
    static Vec3<R> direction(double sine, double cosine) {
        return {R(0.6 * sine), R(0.8 * sine), R(cosine)};
    }
};

struct CharlieOp {
    static constexpr const char* name = "charlie";
    static constexpr std::array<InputGroup, 1> inputs{{{"alpha", 1, 0.05, 0.95}}};
    static constexpr int outputs = 2;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = charlie_D(R(0.9), in[0]);
        out[1] = charlie_V(R(0.3), R(0.8), in[0]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        charlie_D_backward(R(0.9), in[0], d_out[0], d_in[0]);
        charlie_V_backward(R(0.3), R(0.8), in[0], d_out[1], d_in[0]);
    }
};

struct Gtr1Op {
    static constexpr const char* name = "gtr1";
    static constexpr std::array<InputGroup, 1> inputs{{{"alpha", 1, 0.05, 0.95}}};
    static constexpr int outputs = 1;

    template <class R>
    static void forward(const R* in, R* out) {
        out[0] = gtr1_D(Vec3<R>(R(0.168), R(0.224), R(0.96)), in[0]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        gtr1_D_backward(Vec3<R>(R(0.168), R(0.224), R(0.96)), in[0], d_out[0], d_in[0]);
    }
};

/// A film over a base that is denser than it in every channel, where the phase of the lower
/// boundary does not jump.
struct ThinFilmOp {
    static constexpr const char* name = "thin_film";
    static constexpr std::array<InputGroup, 4> inputs{{{"f0", 3, 0.2, 0.9},
                                                       {"index", 1, 1.2, 1.8},
                                                       {"thickness", 1, 150.0, 600.0},
                                                       {"cos_theta", 1, 0.3, 0.9}}};
    static constexpr int outputs = 6;

    template <class R>
    static void forward(const R* in, R* out) {
        const Vec3<R> f0(in[0], in[1], in[2]), F = thin_film(f0, in[3], in[4], in[5]);
        const Vec3<R> bound = thin_film_bound(f0, in[3], R(0.7));
        for (int c = 0; c < 3; ++c) {
            out[c] = F[c];
            out[3 + c] = bound[c];
        }
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        Vec3<R> d_f0(R(0));
        const Vec3<R> f0(in[0], in[1], in[2]);
        thin_film_backward(f0, in[3], in[4], in[5], Vec3<R>(d_out[0], d_out[1], d_out[2]), d_f0,
                           d_in[3], d_in[4], d_in[5]);
        thin_film_bound_backward(f0, in[3], R(0.7), Vec3<R>(d_out[3], d_out[4], d_out[5]), d_f0,
                                 d_in[3]);
        for (int c = 0; c < 3; ++c) d_in[c] += d_f0[c];
    }
};

/// P and Q of principled.h for directions off the plane of incidence.
struct PrincipledOp {
    static constexpr const char* name = "principled";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"metalness", 1, 0.05, 0.95}, {"roughness", 1, 0.1, 0.95}}};
    static constexpr int outputs = 2;

    template <class R>
    static PrincipledAngles<R> angles() {
        return PrincipledAngles<R>::of(R(0.48), R(0.64), R(0.6), R(-0.6), R(0.0), R(0.8));
    }
    template <class R>
    static void forward(const R* in, R* out) {
        const PrincipledTerms<R> terms = principled(angles<R>(), in[0], in[1]);
        out[0] = terms.P;
        out[1] = terms.Q;
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        principled_backward(angles<R>(), in[0], in[1], d_out[0], d_out[1], d_in[0], d_in[1]);
    }
};

}  // namespace photograd
