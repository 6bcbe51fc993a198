// Passes over the pixels of a frame; photograd.frame is the typed face.
#include "array_args.h"
#include "camera_args.h"
#include "module.h"
#include "photograd/frame/bloom.h"
#include "photograd/frame/chunk_sums.h"
#include "photograd/frame/disk_occlusion.h"
#include "photograd/frame/horizon.h"
#include "photograd/frame/screen_rays.h"
#include "photograd/frame/shadow_map.h"
#include "photograd/frame/ssao.h"
#include "photograd/frame/tone_map.h"

namespace photograd {
namespace {

ToneCurve tone_curve_of(const ArrayArgs& args, int curve) {
    if (curve < 0 || curve > static_cast<int>(ToneCurve::agx))
        args.range("curve", "0 to 2", std::to_string(curve));
    return static_cast<ToneCurve>(curve);
}
std::string tone_axes(ToneCurve curve) {
    return std::to_string(tone_parameter_counts[static_cast<int>(curve)]);
}

void map_tones(const py::array& color, int curve, const py::array& params, py::array out) {
    dispatch_real("tone_map", "color", color, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const ToneCurve which = tone_curve_of(args, curve);
        const R* in = args.in<R>("color", color, "N 3");
        const R* numbers = args.in<R>("params", params, tone_axes(which));
        R* to = args.out<R>("out", out, "N 3");
        const std::int64_t count = args.size("N");
        const py::gil_scoped_release release;
        tone_map(which, numbers, in, count, to);
    });
}
void map_tones_backward(const py::array& color, int curve, const py::array& params,
                        const py::array& d_out, py::array d_color, py::array d_params) {
    dispatch_real("tone_map_backward", "color", color, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const ToneCurve which = tone_curve_of(args, curve);
        const R* in = args.in<R>("color", color, "N 3");
        const R* numbers = args.in<R>("params", params, tone_axes(which));
        const R* d = args.in<R>("d_out", d_out, "N 3");
        R* d_in = args.out<R>("d_color", d_color, "N 3");
        R* d_numbers = args.out<R>("d_params", d_params, tone_axes(which));
        const std::int64_t count = args.size("N");
        const py::gil_scoped_release release;
        tone_map_backward(which, numbers, in, count, d, d_in, d_numbers);
    });
}

template <class R>
const R* bloom_weights(ArrayArgs& args, const py::array& weights) {
    const R* found = args.in<R>("weights", weights, "L");
    if (args.size("L") < 1 || args.size("L") > max_bloom_levels)
        args.range("weights", "1 to 16 levels", std::to_string(args.size("L")));
    return found;
}

void add_bloom(const py::array& color, double threshold, const py::array& weights, py::array out) {
    dispatch_real("bloom", "color", color, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* in = args.in<R>("color", color, "H W 3");
        const R* by = bloom_weights<R>(args, weights);
        R* to = args.out<R>("out", out, "H W 3");
        const FrameSize size{args.size("H"), args.size("W")};
        const int levels = static_cast<int>(args.size("L"));
        const py::gil_scoped_release release;
        bloom(size, in, R(threshold), by, levels, to);
    });
}
/// d_threshold (1,).
void add_bloom_backward(const py::array& color, double threshold, const py::array& weights,
                        const py::array& d_out, py::array d_color, py::array d_weights,
                        py::array d_threshold) {
    dispatch_real("bloom_backward", "color", color, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* in = args.in<R>("color", color, "H W 3");
        const R* by = bloom_weights<R>(args, weights);
        const R* d = args.in<R>("d_out", d_out, "H W 3");
        R* d_in = args.out<R>("d_color", d_color, "H W 3");
        R* d_by = args.out<R>("d_weights", d_weights, "L");
        R* d_from = args.out<R>("d_threshold", d_threshold, "1");
        const FrameSize size{args.size("H"), args.size("W")};
        const int levels = static_cast<int>(args.size("L"));
        const py::gil_scoped_release release;
        bloom_backward(size, in, R(threshold), by, levels, d, d_in, d_by, d_from);
    });
}

void check_count(const ArrayArgs& args, const char* name, int value, int most) {
    if (value < 1 || value > most)
        args.range(name, "1 to " + std::to_string(most), std::to_string(value));
}

/// Unit directions (N, 3) of the world through the centers of pixels (N,), row * width + column.
void view_directions(const py::tuple& camera_numbers, const py::array& pixels, py::array out) {
    dispatch_real("view_directions", "out", out, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const Pinhole camera = pinhole(camera_numbers);
        const std::int64_t* ids = args.in<std::int64_t>("pixels", pixels, "N");
        R* to = args.out<R>("out", out, "N 3");
        const std::int64_t count = args.size("N");
        const py::gil_scoped_release release;
        for_chunks(count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
            for (std::int64_t i = first; i < last; ++i) {
                const R x = R(ids[i] % camera.width) + R(0.5);
                const R y = R(ids[i] / camera.width) + R(0.5);
                const Vec3<R> direction = camera.ray(x, y).direction;
                for (int k = 0; k < 3; ++k) to[3 * i + k] = direction[k];
            }
        });
    });
}

/// vectors (N, 3) times rotation (3, 3), each component on its own.
void turn(const py::array& vectors, const py::array& rotation, py::array out) {
    dispatch_real("turn_vectors", "vectors", vectors, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* v = args.in<R>("vectors", vectors, "N 3");
        const R* m = args.in<R>("rotation", rotation, "3 3");
        R* to = args.out<R>("out", out, "N 3");
        const std::int64_t count = args.size("N");
        const py::gil_scoped_release release;
        for_chunks(count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
            for (std::int64_t i = 3 * first; i < 3 * last; i += 3)
                for (int k = 0; k < 3; ++k)
                    to[i + k] = v[i] * m[k] + v[i + 1] * m[3 + k] + v[i + 2] * m[6 + k];
        });
    });
}

/// intrinsics (fx, fy, cx, cy).
template <class R>
ScreenFrame<R> screen_frame(ArrayArgs& args, const py::array& inverse_depth,
                            const py::array& normals, const std::array<double, 4>& intrinsics) {
    const R* w = args.in<R>("inverse_depth", inverse_depth, "H W");
    const R* n = args.in<R>("normals", normals, "H W 3");
    return {args.size("H"),
            args.size("W"),
            R(intrinsics[0]),
            R(intrinsics[1]),
            R(intrinsics[2]),
            R(intrinsics[3]),
            w,
            n};
}
/// Numbers as SsaoSettings orders them.
template <class R>
SsaoSettings<R> ssao_settings(ArrayArgs& args, const py::array& numbers, int samples) {
    const R* s = args.in<R>("settings", numbers, "5");
    check_count(args, "samples", samples, max_ssao_samples);
    return {s[0], s[1], s[2], s[3], s[4]};
}

void occlude(const py::array& inverse_depth, const py::array& normals,
             const std::array<double, 4>& intrinsics, const py::array& settings, int samples,
             py::array out) {
    dispatch_real("ssao", "inverse_depth", inverse_depth, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto frame = screen_frame<R>(args, inverse_depth, normals, intrinsics);
        const auto by = ssao_settings<R>(args, settings, samples);
        R* to = args.out<R>("out", out, "H W");
        const py::gil_scoped_release release;
        ssao(frame, by, samples, to);
    });
}
void occlude_backward(const py::array& inverse_depth, const py::array& normals,
                      const std::array<double, 4>& intrinsics, const py::array& settings,
                      int samples, const py::array& d_out, py::array d_settings) {
    dispatch_real("ssao_backward", "inverse_depth", inverse_depth, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto frame = screen_frame<R>(args, inverse_depth, normals, intrinsics);
        const auto by = ssao_settings<R>(args, settings, samples);
        const R* d = args.in<R>("d_out", d_out, "H W");
        R* d_in = args.out<R>("d_settings", d_settings, "5");
        const py::gil_scoped_release release;
        ssao_backward(frame, by, samples, d, d_in);
    });
}

void occlude_horizons(const py::array& inverse_depth, const py::array& normals,
                      const std::array<double, 4>& intrinsics, double radius, double falloff,
                      int slices, int steps, py::array out) {
    dispatch_real("horizon_occlusion", "inverse_depth", inverse_depth,
                  [&](auto real, ArrayArgs& args) {
                      using R = decltype(real);
                      const auto frame = screen_frame<R>(args, inverse_depth, normals, intrinsics);
                      check_count(args, "slices", slices, max_horizon_slices);
                      check_count(args, "steps", steps, max_horizon_steps);
                      R* to = args.out<R>("out", out, "H W");
                      const py::gil_scoped_release release;
                      horizon_occlusion(frame, {R(radius), R(falloff), slices, steps}, to);
                  });
}

void follow_rays(const py::array& inverse_depth, const py::array& normals,
                 const std::array<double, 4>& intrinsics, double length, double thickness,
                 int steps, const py::array& wi, py::array hit) {
    dispatch_real("follow_screen_rays", "inverse_depth", inverse_depth,
                  [&](auto real, ArrayArgs& args) {
                      using R = decltype(real);
                      const auto frame = screen_frame<R>(args, inverse_depth, normals, intrinsics);
                      const R* direction = args.in<R>("wi", wi, "H W 3");
                      std::int32_t* to = args.out<std::int32_t>("hit", hit, "H W");
                      check_count(args, "steps", steps, max_screen_steps);
                      const py::gil_scoped_release release;
                      follow_screen_rays(frame, {R(length), R(thickness), steps}, direction, to);
                  });
}

/// centers, disk_normals (E, 3), areas, parts (E,) float64.
void occlude_by_disks(const py::array& centers, const py::array& disk_normals,
                      const py::array& areas, const py::array& parts, double opening, double radius,
                      const py::array& points, const py::array& normals, py::array visible) {
    dispatch_real("disk_occlusion", "points", points, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const double* c = args.in<double>("centers", centers, "E 3");
        const double* n = args.in<double>("disk_normals", disk_normals, "E 3");
        const double* a = args.in<double>("areas", areas, "E");
        const double* by = args.in<double>("parts", parts, "E");
        const R* at = args.in<R>("points", points, "N 3");
        const R* facing = args.in<R>("normals", normals, "N 3");
        R* to = args.out<R>("visible", visible, "N");
        const std::int64_t disks = args.size("E"), count = args.size("N");
        const py::gil_scoped_release release;
        DiskTree({disks, c, n, a}).look_up(by, opening, radius, count, at, facing, to);
    });
}

/// depths (K, S, S) and pixels_from_world (K, 3, 4) float64.
void look_up_shadow(const py::array& depths, const py::array& pixels_from_world, int radius,
                    double depth_bias, double normal_bias, double texel, const py::array& points,
                    const py::array& normals, py::array visibility) {
    dispatch_real("shadow_lookup", "points", points, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const double* depth = args.in<double>("depths", depths, "K S S");
        const double* matrices = args.in<double>("pixels_from_world", pixels_from_world, "K 3 4");
        const R* p = args.in<R>("points", points, "N 3");
        const R* n = args.in<R>("normals", normals, "N 3");
        R* out = args.out<R>("visibility", visibility, "N");
        if (radius < 0 || radius > 16) args.range("radius", "0 to 16", std::to_string(radius));
        const ShadowFilter filter{static_cast<int>(args.size("S")), radius, depth_bias, normal_bias,
                                  texel};
        std::vector<ShadowView> views;
        for (std::int64_t k = 0; k < args.size("K"); ++k) {
            ShadowView view{{}, depth + k * filter.size * filter.size};
            std::copy_n(matrices + 12 * k, 12, view.pixels_from_world.begin());
            views.push_back(view);
        }
        const std::int64_t count = args.size("N");
        const py::gil_scoped_release release;
        shadow_lookup<R>(views, filter, count, p, n, out);
    });
}

}  // namespace

void bind_frame(py::module_& m) {
    m.def("tone_map", &map_tones, py::arg("color"), py::arg("curve"), py::arg("params"),
          py::arg("out"));
    m.def("tone_map_backward", &map_tones_backward, py::arg("color"), py::arg("curve"),
          py::arg("params"), py::arg("d_out"), py::arg("d_color"), py::arg("d_params"),
          "Adds to d_color and d_params.");
    m.def("bloom", &add_bloom, py::arg("color"), py::arg("threshold"), py::arg("weights"),
          py::arg("out"));
    m.def("bloom_backward", &add_bloom_backward, py::arg("color"), py::arg("threshold"),
          py::arg("weights"), py::arg("d_out"), py::arg("d_color"), py::arg("d_weights"),
          py::arg("d_threshold"), "Adds to d_color, d_weights and d_threshold (1,).");
    m.def("view_directions", &view_directions, py::arg("camera"), py::arg("pixels"), py::arg("out"),
          "Unit directions (N, 3) through the centers of pixels (N,) int64.");
    m.def("turn_vectors", &turn, py::arg("vectors"), py::arg("rotation"), py::arg("out"),
          "out (N, 3) = vectors (N, 3) times rotation (3, 3).");
    m.def("ssao", &occlude, py::arg("inverse_depth"), py::arg("normals"), py::arg("intrinsics"),
          py::arg("settings"), py::arg("samples"), py::arg("out"),
          "settings: (radius, falloff, bias, distribution, strength).");
    m.def("ssao_backward", &occlude_backward, py::arg("inverse_depth"), py::arg("normals"),
          py::arg("intrinsics"), py::arg("settings"), py::arg("samples"), py::arg("d_out"),
          py::arg("d_settings"), "Adds to d_settings.");
    m.def("horizon_occlusion", &occlude_horizons, py::arg("inverse_depth"), py::arg("normals"),
          py::arg("intrinsics"), py::arg("radius"), py::arg("falloff"), py::arg("slices"),
          py::arg("steps"), py::arg("out"));
    m.def("follow_screen_rays", &follow_rays, py::arg("inverse_depth"), py::arg("normals"),
          py::arg("intrinsics"), py::arg("length"), py::arg("thickness"), py::arg("steps"),
          py::arg("wi"), py::arg("hit"),
          "hit (H, W) int32: a pixel, -1 for a ray that meets nothing, -2 for one that leaves.");
    m.def("disk_occlusion", &occlude_by_disks, py::arg("centers"), py::arg("disk_normals"),
          py::arg("areas"), py::arg("parts"), py::arg("opening"), py::arg("radius"),
          py::arg("points"), py::arg("normals"), py::arg("visible"));
    m.def("shadow_lookup", &look_up_shadow, py::arg("depths"), py::arg("pixels_from_world"),
          py::arg("radius"), py::arg("depth_bias"), py::arg("normal_bias"), py::arg("texel"),
          py::arg("points"), py::arg("normals"), py::arg("visibility"));
}

}  // namespace photograd
