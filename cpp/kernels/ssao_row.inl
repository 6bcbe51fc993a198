// Obscurance of sixteen neighboring pixels side by side, a sample of each at a time. Blocks that
// show no surface are left out.
#include "kernels/ssao_row.h"
#include "photograd/core/lanes.h"
#include "photograd/ops/obscurance_terms.h"

namespace photograd::PHOTOGRAD_ISA {

// Pixels, and where their samples lie.
struct SsaoBlock {
    Lanes<float> x, y, w;              // center, 1 / depth, or 1 where nothing is visible
    Lanes<float> visible;              // 1 or 0
    Lanes<float> point[3], normal[3];  // of the camera
    Lanes<float> turn_cosine, turn_sine;
};

static inline bool load_block(const SsaoRows& a, std::int64_t y, std::int64_t x0, int n,
                              SsaoBlock& b) {
    const float* depths = a.inverse_depth + y * a.width + x0;
    const float* normals = a.normals + 3 * (y * a.width + x0);
    const std::int64_t turn = 4 * (y % 4);
    float any = 0;
    for (int i = 0; i < lane_count; ++i) {
        const float w = i < n ? depths[i] : 0.0f;
        b.visible[i] = w > 0.0f ? 1.0f : 0.0f;
        b.w[i] = w > 0.0f ? w : 1.0f;
        any = any + b.visible[i];
    }
    if (!(any > 0.0f)) return false;
    for (int i = 0; i < lane_count; ++i)
        for (int c = 0; c < 3; ++c) b.normal[c][i] = i < n ? normals[3 * i + c] : 0.0f;
    const float row = static_cast<float>(y) + 0.5f;
    for (int i = 0; i < lane_count; ++i) {
        const float over = 1.0f / b.w[i];
        b.x[i] = static_cast<float>(static_cast<int>(x0) + i) + 0.5f;
        b.y[i] = row;
        b.point[0][i] = (b.x[i] - a.cx) / a.fx * over;
        b.point[1][i] = (row - a.cy) / a.fy * over;
        b.point[2][i] = over;
        b.turn_cosine[i] = a.turn_cosine[turn + i % 4];
        b.turn_sine[i] = a.turn_sine[turn + i % 4];
    }
    return true;
}

// 1 / depth between four pixels, and the point of the picture; as InverseDepth does.
struct SsaoTap {
    Lanes<float> x, y, tx, ty;
    int first[lane_count];
};

static inline void set_tap(const SsaoRows& a, const SsaoBlock& b, int k, SsaoTap& at) {
    const float reach = a.radius * a.alpha[k], c0 = a.cosine[k], s0 = a.sine[k];
    const float last_x = static_cast<float>(a.width - 1), last_y = static_cast<float>(a.height - 1);
    const int end_x = larger(static_cast<int>(a.width) - 2, 0);
    const int end_y = larger(static_cast<int>(a.height) - 2, 0);
    const int width = static_cast<int>(a.width);
    for (int i = 0; i < lane_count; ++i) {
        const float c = c0 * b.turn_cosine[i] - s0 * b.turn_sine[i];
        const float s = s0 * b.turn_cosine[i] + c0 * b.turn_sine[i];
        at.x[i] = b.x[i] + reach * (b.w[i] * a.fx * c);
        at.y[i] = b.y[i] + reach * (b.w[i] * a.fy * s);
        const float fx = clamped(at.x[i] - 0.5f, 0.0f, last_x);
        const float fy = clamped(at.y[i] - 0.5f, 0.0f, last_y);
        const int column = clamped(static_cast<int>(fx), 0, end_x);
        const int row = clamped(static_cast<int>(fy), 0, end_y);
        at.tx[i] = fx - static_cast<float>(column);
        at.ty[i] = fy - static_cast<float>(row);
        at.first[i] = row * width + column;
    }
}

static inline void add_sample(const SsaoRows& a, const SsaoBlock& b, int k, Lanes<float>& sum) {
    SsaoTap at;
    set_tap(a, b, k, at);
    const float* w = a.inverse_depth;
    const int right = a.width > 1 ? 1 : 0, down = a.height > 1 ? static_cast<int>(a.width) : 0;
    Lanes<float> w00, w01, w10, w11;
    for (int i = 0; i < lane_count; ++i) w00[i] = w[at.first[i]];
    for (int i = 0; i < lane_count; ++i) w01[i] = w[at.first[i] + right];
    for (int i = 0; i < lane_count; ++i) w10[i] = w[at.first[i] + down];
    for (int i = 0; i < lane_count; ++i) w11[i] = w[at.first[i] + down + right];
    for (int i = 0; i < lane_count; ++i) {
        const float top = w00[i] + at.tx[i] * (w01[i] - w00[i]);
        const float bottom = w10[i] + at.tx[i] * (w11[i] - w10[i]);
        const float value = top + at.ty[i] * (bottom - top);
        const bool visible = value > 0.0f;
        const float over = 1.0f / (visible ? value : 1.0f);
        const float vx = (at.x[i] - a.cx) / a.fx * over - b.point[0][i];
        const float vy = (at.y[i] - a.cy) / a.fy * over - b.point[1][i];
        const float vz = over - b.point[2][i];
        const float along = vx * b.normal[0][i] + vy * b.normal[1][i] + vz * b.normal[2][i];
        const float squared = vx * vx + vy * vy + vz * vz;
        const float found = obscurance_terms(squared, along, a.radius, a.falloff, a.bias);
        sum[i] = sum[i] + (visible & (along > 0.0f) ? found : 0.0f);
    }
}

// Row y of the picture.
void ssao_row(const SsaoRows& given, std::int64_t y) {
    const SsaoRows a = given;  // a copy, of which nothing else writes
    float* out = a.out + y * a.width;
    for (std::int64_t x0 = 0; x0 < a.width; x0 += lane_count) {
        const int n = static_cast<int>(smaller<std::int64_t>(lane_count, a.width - x0));
        SsaoBlock b;
        if (!load_block(a, y, x0, n, b)) {
            for (int i = 0; i < n; ++i) out[x0 + i] = 1.0f;
            continue;
        }
        Lanes<float> sum = {};
        for (int k = 0; k < a.samples; ++k) add_sample(a, b, k, sum);
        const float count = static_cast<float>(a.samples);
        for (int i = 0; i < n; ++i)
            out[x0 + i] = 1.0f - a.strength * (b.visible[i] * sum[i]) / count;
    }
}

}  // namespace photograd::PHOTOGRAD_ISA
