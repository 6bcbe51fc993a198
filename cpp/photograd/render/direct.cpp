#include "photograd/render/direct.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "photograd/core/parallel.h"
#include "photograd/core/scatter.h"
#include "photograd/render/direct_sample.h"
#include "photograd/render/pixel_strata.h"

namespace photograd {
namespace {

constexpr int lanes = RayPacket::width;
constexpr int tile_size = 8;  // pixels along an edge: the unit of work, whatever the thread count

template <class R>
Ray<R> camera_ray(const PinholeView& view, int column, int row, const Vec2<R>& offset) {
    const R x = (R(column) + offset.x - R(view.cx)) / R(view.fx);
    const R y = (R(row) + offset.y - R(view.cy)) / R(view.fy);
    const double* m = view.world_from_camera;
    Ray<R> ray;
    for (int k = 0; k < 3; ++k, m += 4) {
        ray.origin[k] = R(m[3]);
        ray.direction[k] = R(m[0]) * x + R(m[1]) * y + R(m[2]);
    }
    ray.direction = normalize(ray.direction);
    return ray;
}

template <class R>
void put_ray(RayPacket& packet, int k, const Ray<R>& ray, bool active) {
    for (int axis = 0; axis < 3; ++axis) {
        packet.origin[axis][k] = float(ray.origin[axis]);
        packet.direction[axis][k] = float(ray.direction[axis]);
    }
    packet.t_min[k] = 0;
    packet.t_max[k] = std::numeric_limits<float>::infinity();
    packet.active[k] = active;
}

struct Tile {
    int column, row, width, height;  // in pixels; narrower at the image's border

    Tile(const PinholeView& view, std::int64_t number) {
        const int across = (view.width + tile_size - 1) / tile_size;
        column = static_cast<int>(number % across) * tile_size;
        row = static_cast<int>(number / across) * tile_size;
        width = std::min(tile_size, view.width - column);
        height = std::min(tile_size, view.height - row);
    }
    static std::int64_t count(const PinholeView& view) {
        const auto across = [](int n) { return std::int64_t((n + tile_size - 1) / tile_size); };
        return across(view.width) * across(view.height);
    }
    [[nodiscard]] std::int64_t pixel(const PinholeView& view, int local) const {
        return std::int64_t(row + local / width) * view.width + column + local % width;
    }
};

/// The rays of sixteen samples, wherever they are on their way.
template <class R>
struct Lane {
    int pixel;  // within the tile
    SamplePoints<R> points;
    Ray<R> ray;
    DirectSample<R> sample;
};

/// Everything about a hit that needs no further ray; prepares the two shadow rays.
template <class R>
void meet_surface(const Scene& scene, const DirectLights<R>& lights, const PacketHits& hits, int k,
                  Lane<R>& lane, RayPacket& to_sun, RayPacket& to_sky) {
    const Bvh& bvh = scene.bvh();
    const TrianglePoint<R> p = bvh.surface_point(lane.ray, hits.instance[k], hits.primitive[k]);
    const Vec3<R> normal = dot(p.normal, lane.ray.direction) > R(0) ? -p.normal : p.normal;
    const Frame<R> frame = Frame<R>::from_normal(normal);
    DirectSample<R>& s = lane.sample;
    s.t = p.t;
    s.wo = frame.to_local(-lane.ray.direction);
    s.print = scene.albedo_at(hits.instance[k], hits.primitive[k], p.u, p.v);
    s.sun.w = lights.sun.sample(lane.points.sun);
    s.sun.wi = frame.to_local(s.sun.w);
    s.sun.gain = std::max(s.sun.wi.z, R(0)) / lights.sun.pdf(s.sun.w);
    s.sky.wi = square_to_cosine_hemisphere(lane.points.sky);
    s.sky.w = frame.to_world(s.sky.wi);
    s.sky.gain = s.sky.wi.z > R(0) ? s.sky.wi.z / cosine_hemisphere_pdf(s.sky.wi) : R(0);
    // Far enough from the surface that float rounding of a ray's start cannot put it behind, and far less
    // than any feature that a mesh in float can have.
    const float reach = length(bvh.bounds().hi - bvh.bounds().lo);
    const Vec3<R> start = p.position + R(2e-5f * reach) * normal;
    put_ray(to_sun, k, Ray<R>{start, s.sun.w}, s.sun.gain > R(0));
    put_ray(to_sky, k, Ray<R>{start, s.sky.w}, s.sky.gain > R(0));
}

/// The one loop of both passes: calls visit(pixel within the tile, sample) for every sample of the tile
/// that hits a surface, in an order that depends on nothing else.
template <class R, class Visit>
void for_each_hit(const Scene& scene, const DirectLights<R>& lights, const PinholeView& view,
                  const DirectOptions& options, const Tile& tile, Visit&& visit) {
    const int pixels = tile.width * tile.height;
    const std::int64_t total = std::int64_t(pixels) * options.samples;
    PixelStrata strata(options.seed, static_cast<std::uint32_t>(tile.pixel(view, 0)), options.samples);
    int strata_of = 0;
    std::array<Lane<R>, lanes> lane;
    RayPacket camera, to_sun, to_sky;
    PacketHits hits;
    bool sun_blocked[lanes], sky_blocked[lanes];
    for (std::int64_t first = 0; first < total; first += lanes) {
        const int used = static_cast<int>(std::min<std::int64_t>(lanes, total - first));
        for (int k = 0; k < lanes; ++k) {
            Lane<R>& own = lane[static_cast<std::size_t>(k)];
            if (k < used) {
                const std::int64_t at = first + k;
                own.pixel = static_cast<int>(at / options.samples);
                if (own.pixel != strata_of) {
                    strata_of = own.pixel;
                    const auto number = static_cast<std::uint32_t>(tile.pixel(view, own.pixel));
                    strata = PixelStrata(options.seed, number, options.samples);
                }
                own.points = strata.draw<R>(static_cast<std::uint32_t>(at % options.samples));
                own.ray = camera_ray(view, tile.column + own.pixel % tile.width,
                                     tile.row + own.pixel / tile.width, own.points.pixel);
            }
            put_ray(camera, k, lane[static_cast<std::size_t>(std::min(k, used - 1))].ray, k < used);
        }
        scene.bvh().trace(camera, true, hits);
        bool any = false;
        for (int k = 0; k < lanes; ++k) {
            to_sun.active[k] = to_sky.active[k] = false;
            if (k >= used || hits.primitive[k] < 0) continue;
            meet_surface(scene, lights, hits, k, lane[static_cast<std::size_t>(k)], to_sun, to_sky);
            any = true;
        }
        if (!any) continue;
        scene.bvh().occluded(to_sun, true, sun_blocked);
        scene.bvh().occluded(to_sky, false, sky_blocked);
        for (int k = 0; k < used; ++k) {
            if (hits.primitive[k] < 0) continue;
            Lane<R>& own = lane[static_cast<std::size_t>(k)];
            if (sun_blocked[k]) own.sample.sun.gain = R(0);
            if (sky_blocked[k]) own.sample.sky.gain = R(0);
            visit(own.pixel, own.sample);
        }
    }
}

template <class R>
struct Contribution {
    std::uint32_t row;  // of the table of colours
    Vec3<R> d;
};

/// d_colors[row] += d for all, tile after tile: rows are dealt to owners, each adds its own in that order.
template <class R>
void add_contributions(const std::vector<std::vector<Contribution<R>>>& tiles, std::int64_t colors,
                       OwnerBins& bins, R* d_colors) {
    std::vector<Contribution<R>> all;
    for (const auto& tile : tiles) all.insert(all.end(), tile.begin(), tile.end());
    constexpr std::uint32_t rows_of_owner = 256;
    const int owners = static_cast<int>((colors + rows_of_owner - 1) / rows_of_owner);
    std::vector<std::uint32_t> items(all.size());
    std::iota(items.begin(), items.end(), 0u);
    bin_by_owner(items, owners, [&](std::uint32_t i) { return all[i].row / rows_of_owner; }, bins);
    parallel_for(owners, [&](std::int64_t owner) {
        const auto o = static_cast<std::size_t>(owner);
        for (std::uint32_t j = bins.begin[o]; j < bins.begin[o + 1]; ++j) {
            const Contribution<R>& c = all[bins.order[j]];
            for (int k = 0; k < 3; ++k) d_colors[3 * std::int64_t(c.row) + k] += c.d[k];
        }
    });
}

template <class R>
void add_lights(const DirectLights<R>& d, double* partial) {
    const auto add = [&](const R& x) { *partial++ += x; };
    for_each_scalar(add, d.sun);
    for_each_scalar(add, d.sky);
}

}  // namespace

template <Real R>
void render_direct(const Scene& scene, const R* colors, const DirectLights<R>& lights,
                   const PinholeView& view, const DirectOptions& options, const DirectOutputs<R>& out) {
    parallel_for(Tile::count(view), [&](std::int64_t number) {
        const Tile tile(view, number);
        std::array<Vec3<R>, tile_size * tile_size> radiance;
        std::array<R, tile_size * tile_size> depth{};
        std::array<std::uint32_t, tile_size * tile_size> hit{};
        radiance.fill(Vec3<R>(R(0)));
        for_each_hit(scene, lights, view, options, tile, [&](int pixel, const DirectSample<R>& s) {
            const auto at = static_cast<std::size_t>(pixel);
            radiance[at] += shade(s, mix_colors(s.print, colors), lights);
            depth[at] += s.t;
            ++hit[at];
        });
        for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
            const auto at = static_cast<std::size_t>(pixel);
            const std::int64_t i = tile.pixel(view, pixel);
            for (int k = 0; k < 3; ++k) out.radiance[3 * i + k] = radiance[at][k] / R(options.samples);
            out.alpha[i] = R(hit[at]) / R(options.samples);
            out.depth[i] = hit[at] > 0 ? depth[at] / R(hit[at]) : std::numeric_limits<R>::infinity();
        }
    });
}

template <Real R>
void render_direct_backward(const Scene& scene, const R* colors, const DirectLights<R>& lights,
                            const PinholeView& view, const DirectOptions& options,
                            const R* d_radiance, R* d_colors, DirectLights<R>& d_lights) {
    // Slabs of about 2^17 samples bound the memory of contributions: four a sample.
    const std::int64_t tiles = Tile::count(view);
    const std::int64_t slab = std::max<std::int64_t>(
        1, (1 << 17) / (std::int64_t(tile_size) * tile_size * options.samples));
    std::array<double, 12> light_sums{};
    OwnerBins bins;
    for (std::int64_t start = 0; start < tiles; start += slab) {
        std::vector<std::vector<Contribution<R>>> contributions(
            static_cast<std::size_t>(std::min(slab, tiles - start)));
        sum_partials<double>(std::ssize(contributions), light_sums, [&](std::int64_t chunk, auto partial) {
            const Tile tile(view, start + chunk);
            auto& own = contributions[static_cast<std::size_t>(chunk)];
            for_each_hit(scene, lights, view, options, tile, [&](int pixel, const DirectSample<R>& s) {
                const R* d = d_radiance + 3 * tile.pixel(view, pixel);
                const Vec3<R> d_shade = Vec3<R>(d[0], d[1], d[2]) / R(options.samples);
                Vec3<R> d_albedo(R(0));
                DirectLights<R> d_sample{{Vec3<R>(R(0))}, {Vec3<R>(R(0)), Vec3<R>(R(0)), Vec3<R>(R(0))}};
                shade_backward(s, mix_colors(s.print, colors), lights, d_shade, d_albedo, d_sample);
                add_lights(d_sample, partial.data());
                for (std::size_t k = 0; k < 4; ++k)
                    if (s.print.weight[k] != R(0))
                        own.push_back({static_cast<std::uint32_t>(s.print.texel[k]),
                                       s.print.weight[k] * d_albedo});
            });
        });
        add_contributions(contributions, scene.colors(), bins, d_colors);
    }
    const double* sum = light_sums.data();
    const auto add = [&](R& x) { x += R(*sum++); };
    for_each_scalar(add, d_lights.sun);
    for_each_scalar(add, d_lights.sky);
}

template void render_direct(const Scene&, const float*, const DirectLights<float>&, const PinholeView&,
                            const DirectOptions&, const DirectOutputs<float>&);
template void render_direct(const Scene&, const double*, const DirectLights<double>&,
                            const PinholeView&, const DirectOptions&, const DirectOutputs<double>&);
template void render_direct_backward(const Scene&, const float*, const DirectLights<float>&,
                                     const PinholeView&, const DirectOptions&, const float*, float*,
                                     DirectLights<float>&);
template void render_direct_backward(const Scene&, const double*, const DirectLights<double>&,
                                     const PinholeView&, const DirectOptions&, const double*, double*,
                                     DirectLights<double>&);

}  // namespace photograd
