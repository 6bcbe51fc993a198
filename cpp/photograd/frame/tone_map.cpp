#include "photograd/frame/tone_map.h"

#include "photograd/frame/chunk_sums.h"
#include "photograd/ops/tone_curve.h"

namespace photograd {
namespace {

template <class R>
void map_color(ToneCurve curve, const R* params, const R* color, R* out) {
    if (curve == ToneCurve::agx) {
        const AgxColor<R> agx(color, params);
        for (int i = 0; i < 3; ++i) out[i] = agx.out[i];
        return;
    }
    for (int i = 0; i < 3; ++i)
        out[i] = curve == ToneCurve::reinhard ? reinhard(color[i], params[0])
                                              : aces_fit(color[i], params);
}

template <class R>
void map_color_backward(ToneCurve curve, const R* params, const R* color, const R* d_out,
                        R* d_color, R* d_params) {
    if (curve == ToneCurve::agx) {
        AgxColor<R>(color, params).backward(params, d_out, d_color, d_params);
        return;
    }
    for (int i = 0; i < 3; ++i) {
        if (curve == ToneCurve::reinhard)
            reinhard_backward(color[i], params[0], d_out[i], d_color[i], d_params[0]);
        else
            aces_fit_backward(color[i], params, d_out[i], d_color[i], d_params);
    }
}

}  // namespace

template <Real R>
void tone_map(ToneCurve curve, const R* params, const R* color, std::int64_t count, R* out) {
    for_chunks(count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last; ++i)
            map_color(curve, params, color + 3 * i, out + 3 * i);
    });
}

template <Real R>
void tone_map_backward(ToneCurve curve, const R* params, const R* color, std::int64_t count,
                       const R* d_out, R* d_color, R* d_params) {
    const int width = tone_parameter_counts[static_cast<int>(curve)];
    add_chunk_sums(count, width, d_params, [&](std::int64_t first, std::int64_t last, R* d_own) {
        for (std::int64_t i = first; i < last; ++i)
            map_color_backward(curve, params, color + 3 * i, d_out + 3 * i, d_color + 3 * i, d_own);
    });
}

template void tone_map(ToneCurve, const float*, const float*, std::int64_t, float*);
template void tone_map(ToneCurve, const double*, const double*, std::int64_t, double*);
template void tone_map_backward(ToneCurve, const float*, const float*, std::int64_t, const float*,
                                float*, float*);
template void tone_map_backward(ToneCurve, const double*, const double*, std::int64_t,
                                const double*, double*, double*);

}  // namespace photograd
