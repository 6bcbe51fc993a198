#include "photograd/render/direct.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "photograd/bsdf/lambert.h"
#include "photograd/core/scatter.h"
#include "photograd/render/pixel_strata.h"
#include "photograd/render/ray_lanes.h"

namespace photograd {
namespace {

constexpr int width = RayPacket::width;
constexpr std::int64_t chunk_pixels = 64;  // of one task
constexpr std::int64_t slab_chunks = 64;   // whose contributions are kept at a time
constexpr int owner_entries = 64;          // albedo entries of one owner
constexpr float shadow_offset = 1e-4f;     // of the scene's size, against self-shadowing
constexpr float infinity = std::numeric_limits<float>::infinity();

/// One light sample of a hit: a direction and what multiplies f L there. weight = cos / pdf.
template <class R>
struct LightSample {
    Vec3<R> world, local;
    R weight = R(0);
};

/// One camera sample that met a surface.
template <class R>
struct Hit {
    bool valid = false;
    R t;
    Vec3<R> position, normal, wo;  // normal towards the viewer, wo in the shading frame
    AlbedoTaps<R> taps;
    LightSample<R> sun, sky;
};

template <class R>
Hit<R> shade(const DirectScene<R>& scene, const Ray<R>& ray, std::int32_t instance,
             std::int32_t primitive, const SamplePoints<R>& points) {
    const TrianglePoint<R> point = scene.bvh->surface_point(ray, instance, primitive);
    Hit<R> hit;
    hit.valid = true;
    hit.t = point.t;
    hit.position = point.position;
    hit.normal = dot(point.normal, ray.direction) > R(0) ? -point.normal : point.normal;
    hit.taps = albedo_taps(*scene.bvh, scene.layouts, instance, primitive, point.u, point.v);
    const Frame<R> frame = Frame<R>::from_normal(hit.normal);
    hit.wo = frame.to_local(-ray.direction);
    hit.sun.world = scene.sun.sample(points.sun);
    hit.sun.local = frame.to_local(hit.sun.world);
    if (hit.sun.local.z > R(0)) hit.sun.weight = hit.sun.local.z / scene.sun.pdf(hit.sun.world);
    const Lambert<R> lobe;  // its sampling depends on no parameter
    hit.sky.local = lobe.sample(hit.wo, points.sky);
    hit.sky.world = frame.to_world(hit.sky.local);
    const R pdf = lobe.pdf(hit.wo, hit.sky.local);
    if (pdf > R(0)) hit.sky.weight = hit.sky.local.z / pdf;
    return hit;
}

/// Sets the weight of light samples that something stands in front of to zero.
template <class R>
void cast_shadows(const DirectScene<R>& scene, Hit<R>* hits, LightSample<R> Hit<R>::* light,
                  bool side_by_side) {
    const Box& box = scene.bvh->bounds();
    float size = 0;
    for (int axis = 0; axis < 3; ++axis) size = std::max(size, box.hi[axis] - box.lo[axis]);
    RayPacket packet{};
    bool any = false;
    for (int k = 0; k < width; ++k) {
        const LightSample<R>& sample = hits[k].*light;
        packet.active[k] = false;
        if (!hits[k].valid || !(sample.weight > R(0))) continue;
        set_lane(packet, k, hits[k].position + hits[k].normal * R(shadow_offset * size),
                 sample.world, infinity);
        any = true;
    }
    if (!any) return;
    bool blocked[width];
    scene.bvh->occluded(packet, side_by_side, blocked);
    for (int k = 0; k < width; ++k)
        if (packet.active[k] && blocked[k]) (hits[k].*light).weight = R(0);
}

/// Traces up to `width` samples of one pixel, from sample `first` on.
template <class R>
void trace_samples(const DirectScene<R>& scene, const Pinhole& camera, const DirectOptions& options,
                   const PixelStrata& strata, std::int64_t pixel, int first, Hit<R>* hits) {
    RayPacket packet{};
    Ray<R> rays[width];
    SamplePoints<R> points[width];
    const int used = std::min(width, options.spp - first);
    for (int k = 0; k < width; ++k) {
        hits[k].valid = false;
        packet.active[k] = false;
        if (k >= used) continue;
        points[k] = strata.draw<R>(static_cast<std::uint32_t>(first + k));
        const Vec2<R>& at = points[k].pixel;
        const std::int64_t column = pixel % camera.width, row = pixel / camera.width;
        rays[k] = camera.ray(R(column) + at.x, R(row) + at.y);
        set_lane(packet, k, rays[k].origin, rays[k].direction, infinity);
    }
    PacketHits found;
    scene.bvh->trace(packet, true, found);
    for (int k = 0; k < used; ++k) {
        if (found.primitive[k] < 0) continue;
        hits[k] = shade(scene, rays[k], found.instance[k], found.primitive[k], points[k]);
    }
    cast_shadows(scene, hits, &Hit<R>::sun, true);
    cast_shadows(scene, hits, &Hit<R>::sky, false);
}

/// The one loop of both passes: visit(pixel, hit) for every sample that met a surface, in order.
template <class R, class Visit>
void for_each_hit(const DirectScene<R>& scene, const Pinhole& camera, const DirectOptions& options,
                  std::int64_t begin, std::int64_t end, Visit&& visit) {
    Hit<R> hits[width];
    for (std::int64_t pixel = begin; pixel < end; ++pixel) {
        const PixelStrata strata(options.seed, static_cast<std::uint32_t>(pixel),
                                 static_cast<std::uint32_t>(options.spp));
        for (int first = 0; first < options.spp; first += width) {
            trace_samples(scene, camera, options, strata, pixel, first, hits);
            for (const Hit<R>& hit : hits)
                if (hit.valid) visit(pixel, hit);
        }
    }
}

template <class R>
Vec3<R> reflected(const DirectScene<R>& scene, const Hit<R>& hit) {
    const Lambert<R> bsdf{look_up(hit.taps, scene.albedo)};
    return bsdf.f(hit.wo, hit.sun.local) * scene.sun.L(hit.sun.world) * hit.sun.weight +
           bsdf.f(hit.wo, hit.sky.local) * scene.sky.L(hit.sky.world) * hit.sky.weight;
}

/// Adjoint of `reflected`: returns d_albedo of the point, adds to the lights.
template <class R>
Vec3<R> reflected_backward(const DirectScene<R>& scene, const Hit<R>& hit, const Vec3<R>& d_out,
                           Sun<R>& d_sun, Sky<R>& d_sky) {
    const Lambert<R> bsdf{look_up(hit.taps, scene.albedo)};
    Lambert<R> d_bsdf{Vec3<R>(R(0))};
    const Vec3<R> to_sun = d_out * hit.sun.weight, to_sky = d_out * hit.sky.weight;
    bsdf.f_backward(hit.wo, hit.sun.local, to_sun * scene.sun.L(hit.sun.world), d_bsdf);
    bsdf.f_backward(hit.wo, hit.sky.local, to_sky * scene.sky.L(hit.sky.world), d_bsdf);
    scene.sun.L_backward(hit.sun.world, to_sun * bsdf.f(hit.wo, hit.sun.local), d_sun);
    scene.sky.L_backward(hit.sky.world, to_sky * bsdf.f(hit.wo, hit.sky.local), d_sky);
    return d_bsdf.albedo;
}

/// What one sample adds to one entry of the albedo array.
template <class R>
struct AlbedoContribution {
    std::uint32_t entry;
    Vec3<R> d;
};

/// Binned owners: contributions of a slab, in pixel order, each added by the owner of its entry.
template <class R>
void scatter(const std::vector<std::vector<AlbedoContribution<R>>>& chunks, std::int64_t entries,
             R* d_albedo) {
    std::vector<AlbedoContribution<R>> all;
    for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
    std::vector<std::uint32_t> items(all.size());
    for (std::uint32_t i = 0; i < items.size(); ++i) items[i] = i;
    const int owners = static_cast<int>((entries + owner_entries - 1) / owner_entries);
    OwnerBins bins;
    bin_by_owner(
        items, owners, [&](std::uint32_t i) { return all[i].entry / owner_entries; }, bins);
    parallel_for(owners, [&](std::int64_t owner) {
        const auto k = static_cast<std::size_t>(owner);
        for (std::uint32_t j = bins.begin[k]; j < bins.begin[k + 1]; ++j) {
            const AlbedoContribution<R>& c = all[bins.order[j]];
            for (int channel = 0; channel < 3; ++channel)
                d_albedo[3 * static_cast<std::int64_t>(c.entry) + channel] += c.d[channel];
        }
    });
}

constexpr std::size_t light_numbers = 12;  // radiance of the sun, zenith, horizon, ground

template <class R>
void add_lights(const Sun<R>& sun, const Sky<R>& sky, double* total) {
    const Vec3<R> parts[4] = {sun.radiance, sky.zenith, sky.horizon, sky.ground};
    for (int part = 0; part < 4; ++part)
        for (int c = 0; c < 3; ++c) total[3 * part + c] += static_cast<double>(parts[part][c]);
}

}  // namespace

template <Real R>
void render_direct(const DirectScene<R>& scene, const Pinhole& camera, const DirectOptions& options,
                   const DirectImage<R>& image) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const R share = R(1) / R(options.spp);
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * chunk_pixels,
                           end = std::min(begin + chunk_pixels, pixels);
        std::fill(image.radiance + 3 * begin, image.radiance + 3 * end, R(0));
        std::fill(image.alpha + begin, image.alpha + end, R(0));
        std::fill(image.depth + begin, image.depth + end, R(0));
        for_each_hit(scene, camera, options, begin, end,
                     [&](std::int64_t pixel, const Hit<R>& hit) {
                         const Vec3<R> L = reflected(scene, hit);
                         for (int c = 0; c < 3; ++c) image.radiance[3 * pixel + c] += L[c] * share;
                         image.alpha[pixel] += share;
                         image.depth[pixel] += hit.t * share;
                     });
    });
}

template <Real R>
void render_direct_backward(const DirectScene<R>& scene, const Pinhole& camera,
                            const DirectOptions& options, const R* d_radiance, R* d_albedo,
                            Sun<R>& d_sun, Sky<R>& d_sky) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const std::int64_t chunks = (pixels + chunk_pixels - 1) / chunk_pixels;
    const R share = R(1) / R(options.spp);
    std::vector<double> lights(static_cast<std::size_t>(chunks) * light_numbers, 0.0);
    for (std::int64_t slab = 0; slab < chunks; slab += slab_chunks) {
        const std::int64_t count = std::min(slab_chunks, chunks - slab);
        std::vector<std::vector<AlbedoContribution<R>>> kept(static_cast<std::size_t>(count));
        parallel_for(count, [&](std::int64_t k) {
            const std::int64_t begin = (slab + k) * chunk_pixels;
            Sun<R> sun{Vec3<R>(R(0))};
            Sky<R> sky{Vec3<R>(R(0)), Vec3<R>(R(0)), Vec3<R>(R(0))};
            auto& out = kept[static_cast<std::size_t>(k)];
            for_each_hit(scene, camera, options, begin, std::min(begin + chunk_pixels, pixels),
                         [&](std::int64_t pixel, const Hit<R>& hit) {
                             const R* d = d_radiance + 3 * pixel;
                             const Vec3<R> d_out = Vec3<R>(d[0], d[1], d[2]) * share;
                             const Vec3<R> d_point =
                                 reflected_backward(scene, hit, d_out, sun, sky);
                             for (int tap = 0; tap < hit.taps.count; ++tap)
                                 out.push_back({static_cast<std::uint32_t>(hit.taps.entry[tap]),
                                                d_point * hit.taps.weight[tap]});
                         });
            add_lights(sun, sky, &lights[static_cast<std::size_t>(slab + k) * light_numbers]);
        });
        scatter(kept, scene.albedo_count, d_albedo);
    }
    double total[light_numbers] = {};
    for (std::size_t i = 0; i < lights.size(); ++i) total[i % light_numbers] += lights[i];
    Vec3<R>* parts[4] = {&d_sun.radiance, &d_sky.zenith, &d_sky.horizon, &d_sky.ground};
    for (int part = 0; part < 4; ++part)
        for (int c = 0; c < 3; ++c) (*parts[part])[c] += static_cast<R>(total[3 * part + c]);
}

template void render_direct(const DirectScene<float>&, const Pinhole&, const DirectOptions&,
                            const DirectImage<float>&);
template void render_direct(const DirectScene<double>&, const Pinhole&, const DirectOptions&,
                            const DirectImage<double>&);
template void render_direct_backward(const DirectScene<float>&, const Pinhole&,
                                     const DirectOptions&, const float*, float*, Sun<float>&,
                                     Sky<float>&);
template void render_direct_backward(const DirectScene<double>&, const Pinhole&,
                                     const DirectOptions&, const double*, double*, Sun<double>&,
                                     Sky<double>&);

}  // namespace photograd
