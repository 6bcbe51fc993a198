// The second pass of photon mapping: a camera's paths through smooth surfaces to one that photons lie on.
#include "photograd/core/parallel.h"
#include "photograd/render/path_samples.h"
#include "photograd/render/photon_map.h"

namespace photograd {
namespace {

constexpr int width = RayPacket::width;

struct View {
    RandomKey key;
    Ray<double> ray;
    Vec3<double> beta, L;
    bool alive = false;
};

class PhotonPicture {
public:
    PhotonPicture(const PathScene<double>& scene, const PhotonMap& map, const PathOptions& options)
        : scene_(scene), map_(map), options_(options), numbers_(options.sampler) {}

    /// Follows up to sixteen views until none is left.
    void follow(View (&views)[width]) {
        for (int depth = 0; depth < options_.max_depth; ++depth) {
            RayPacket packet{};
            bool any = false;
            for (int k = 0; k < width; ++k) {
                packet.active[k] = false;
                if (!views[k].alive) continue;
                any = true;
                set_lane(packet, k, views[k].ray.origin, views[k].ray.direction,
                         std::numeric_limits<float>::infinity());
            }
            if (!any) return;
            PacketHits found;
            scene_.geometry->bvh.trace(packet, depth == 0, found);
            for (int k = 0; k < width; ++k)
                if (views[k].alive)
                    arrive(views[k], depth, found.instance[k], found.primitive[k], found.t[k]);
        }
    }
    [[nodiscard]] SampleNumbers& numbers() { return numbers_; }

private:
    void arrive(View& view, int depth, std::int32_t instance, std::int32_t primitive, float t) {
        view.alive = false;
        if (primitive < 0) {
            view.L += view.beta * scene_.behind(view.ray.direction).radiance;
            return;
        }
        const PathGeometry& geometry = *scene_.geometry;
        const SurfaceHit<double> hit = surface_hit(geometry, view.ray, instance, primitive, t);
        const auto m =
            static_cast<std::size_t>(geometry.material[static_cast<std::size_t>(hit.shape)]);
        const std::span<const TextureUse> uses = geometry.textures.of(m);
        Material<double> own;
        if (!uses.empty())
            own = textured(scene_.materials[m], uses, geometry.textures, scene_.texels, hit.uv);
        const Material<double>& material = uses.empty() ? scene_.materials[m] : own;
        const Vec3<double> back = -view.ray.direction;
        const SurfaceSide<double> side(hit, back, material.transmits());
        if (material.has_opacity && passes(view, depth, m, material, hit, side)) return;
        if (dot(hit.outside, back) > 0) view.L += view.beta * scene_.emitted(hit.shape, hit.uv);
        if (material.is_specular())
            go_on(view, depth, material, hit, side);
        else
            view.L += view.beta * reflected(material, hit, side);
    }

    /// Whether the view goes on behind a surface that covers only in part.
    bool passes(View& view, int depth, std::size_t number, const Material<double>& material,
                const SurfaceHit<double>& hit, const SurfaceSide<double>& side) {
        const Philox4 words = numbers_(view.key, 1 + static_cast<std::uint32_t>(depth));
        view.alive = goes_straight_on(scene_, number, material, hit, side,
                                      uniform_from<double>(words[1]), view.ray, view.beta);
        return view.alive;
    }

    /// What the photons around a place send to the viewer.
    [[nodiscard]] Vec3<double> reflected(const Material<double>& material,
                                         const SurfaceHit<double>& hit,
                                         const SurfaceSide<double>& side) const {
        Vec3<double> sum(0);
        const bool transmits = material.transmits();
        map_.for_each_near(hit.position, [&](const Photon& photon) {
            const bool across = dot(photon.back, side.normal) < 0;
            if (!lies_on(photon, across ? -side.normal : side.normal)) return;
            const Vec3<double> wi = side.frame.to_local(photon.back);
            if (!side.agrees(photon.back, wi) || (!transmits && !(side.wo.z * wi.z > 0))) return;
            const double slope = std::abs(wi.z / dot(photon.back, side.normal));
            sum += material.f(side.wo, wi) * photon.flux * slope;
        });
        return sum * map_.density();
    }

    void go_on(View& view, int depth, const Material<double>& material,
               const SurfaceHit<double>& hit, const SurfaceSide<double>& side) {
        const Philox4 words = numbers_(view.key, 1 + static_cast<std::uint32_t>(depth));
        const ScatterSample<double> next =
            material.sample(side.wo, Vec2<double>(0.0), uniform_from<double>(words[0]));
        if (!(next.pdf > 0)) return;
        const Vec3<double> out = side.frame.to_world(next.wi);
        if (!side.agrees(out, next.wi)) return;
        view.beta *= next.value * (1 / next.pdf);
        view.ray = {side.start(hit.position, out, scene_.geometry->offset), out};
        view.alive = true;
    }

    const PathScene<double>& scene_;
    const PhotonMap& map_;
    PathOptions options_;
    SampleNumbers numbers_;
};

}  // namespace

void trace_photons(const PathScene<double>& scene, const PhotonMap& map, const ThinLens& camera,
                   const PathOptions& options, const SampleRange& samples, const PathSums& sums) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        PhotonPicture picture(scene, map, options);
        const std::int64_t begin = chunk * chunk_pixels,
                           end = std::min(begin + chunk_pixels, pixels),
                           total = (end - begin) * samples.count;
        for (std::int64_t first = 0; first < total; first += width) {
            View views[width];
            const auto pixel_of = [&](int k) { return begin + (first + k) / samples.count; };
            const int count = static_cast<int>(std::min<std::int64_t>(width, total - first));
            for (int k = 0; k < count; ++k) {
                View& view = views[k];
                view.key =
                    key_of(options, pixel_of(k),
                           samples.first + static_cast<std::uint32_t>((first + k) % samples.count));
                view.ray = sample_ray<double>(camera, view.key, picture.numbers());
                view.beta = Vec3<double>(1);
                view.L = Vec3<double>(0);
                view.alive = true;
            }
            picture.follow(views);
            for (int k = 0; k < count; ++k)
                for (int c = 0; c < 3; ++c) {
                    sums.radiance[3 * pixel_of(k) + c] += views[k].L[c];
                    sums.squares[3 * pixel_of(k) + c] += views[k].L[c] * views[k].L[c];
                }
        }
    });
}

}  // namespace photograd
