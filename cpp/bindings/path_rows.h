// One path as Python sees it: a dictionary a vertex.
#pragma once

#include "camera_args.h"
#include "photograd/render/path/path.h"
#include "scene_calls.h"

namespace photograd {

inline py::list colors(const Vec3<double>& v) { return py::cast(std::array{v.x, v.y, v.z}); }

/// (medium, kind, length, position, value) of each event of a product.
inline py::list event_rows(const Path<double>& path, const Range& events) {
    py::list out;
    for (std::int32_t i = events.first; i < events.last; ++i) {
        const MediumEvent<double>& event = path.events[static_cast<std::size_t>(i)];
        out.append(py::make_tuple(event.medium, static_cast<int>(event.kind), event.length,
                                  colors(event.position), colors(event.value)));
    }
    return out;
}

inline void put_emitter(const EmitterSample<double>& nee, py::dict& row) {
    row["nee_shape"] = nee.shape;
    row["nee_light"] = nee.light;
    row["nee_direction"] = colors(nee.direction);
    row["nee_f"] = colors(nee.f);
    row["nee_Le"] = colors(nee.weight > 0 ? nee.Le : Vec3<double>(0));
    row["nee_weight"] = nee.weight;
    row["nee_cosine"] = std::abs(nee.wi.z);
    row["nee_pdf"] = nee.pdf;
    row["nee_bsdf_pdf"] = nee.bsdf_pdf;
}

inline py::dict vertex_row(const Path<double>& path, const PathVertex<double>& v, bool media) {
    py::dict row;
    row["shape"] = v.shape;
    row["direction"] = colors(v.direction);
    row["Le"] = colors(v.Le);
    row["emission_weight"] = v.emission_weight;
    row["pdf"] = v.pdf;
    row["emitter_pdf"] = v.emitter_pdf;
    put_emitter(v.nee, row);
    row["wo"] = colors(v.wo);
    row["wi"] = colors(v.wi);
    row["f"] = colors(v.f);
    row["lobe"] = v.lobe;
    row["is_null"] = v.kind == VertexKind::null_surface;
    row["opacity_weight"] = v.opacity_weight;
    row["d_opacity"] = v.d_opacity;
    row["nee_alpha_transmittance"] = v.nee.alpha_transmittance;
    row["weight"] = v.weight;
    row["survival"] = v.survival;
    if (!media) return row;
    row["medium"] = v.medium;
    row["pdf_channels"] = colors(v.arrival.pdf);
    row["segment_weight"] = v.arrival.weight;
    row["events"] = event_rows(path, v.arrival.product.events);
    row["nee_events"] = event_rows(path, v.nee.shadow.events);
    return row;
}

/// In double precision.
inline py::list path_rows(const SceneRows& rows, const py::tuple& camera_numbers,
                          const Options& given, std::uint32_t pixel, std::uint32_t sample) {
    ArrayArgs args("trace_path");
    const SceneNumbers<double> numbers(args, rows);
    const ThinLens camera = thin_lens(camera_numbers);
    const PathOptions options = options_of(args, given);
    const std::int64_t pixels = std::int64_t{camera.width} * camera.height;
    if (pixel >= pixels)
        args.range("pixel", "below " + std::to_string(pixels), std::to_string(pixel));
    const Path<double> path = trace_path(numbers.scene, camera, options, pixel, sample);
    py::list out;
    for (const PathVertex<double>& v : path.vertices)
        out.append(vertex_row(path, v, rows.geometry.media.any()));
    return out;
}

}  // namespace photograd
