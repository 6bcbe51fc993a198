// Particles from the lights through a scene, sixteen side by side: the same light as that of path_walk.h, from its
// other end.
//
// A particle that arrives from the direction a (unit, back to where it came from) goes on along b, which the material
// samples as if a were its viewer. What it then stands for follows from what a camera that looks from b would see,
// L(b) = f(b, a) L(a) |a n|, with n the shading normal and m the geometric one [Veach1997, Ch. 5]:
//
//   weight = f(b, a) |a n| |b m| / (|a m| pdf(b))
//
// Two things make it differ from the weight of a camera's path, f(a, b) |b n| / pdf(b). Shading normals: areas are those
// of the true surface, and only with n = m is the weight what one expects. Refraction: radiance changes by the square
// of the ratio of indices where a cone of rays narrows, watts do not. A rough model is asked for f(b, a), its arguments in
// the camera's order. A lobe of a smooth one has a weight W for the radiance there, and W' for the way back; the factors
// eta^2 and 1 / eta^2 cancel in
//
//   weight = sqrt(W W') |a n| |b m| / (|a m| |b n|)
//
// which holds whatever the lobe, as long as it is its own way back. What lies between surfaces is the part of
// volume_particles.h.
//
// Numbers are a function of seed, particle and vertex: block 0 chooses the light and the place, 1 the way, 2 + k what
// vertex k does, 2^20 + k whether it is passed (coverage.h). The step of the key is 1, so that they are not those of a picture of the same seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "photograd/render/coverage.h"
#include "photograd/render/ray_lanes.h"
#include "photograd/scene/emit.h"

namespace photograd {

struct ParticleOptions {
    int max_depth = 64;     // segments of the longest way; 1 lands straight from the lights
    int roulette_from = 4;  // the first surface at which a particle may end by chance
    std::uint64_t seed = 0;
};

inline constexpr int walk_width = RayPacket::width;

/// Particles `first` to `first + count - 1`, at most sixteen, as their lights send them.
inline Particle emitted_particle(const PathScene<double>& scene, std::uint64_t seed,
                                 std::uint64_t number) {
    const RandomKey key{seed, 1, static_cast<std::uint32_t>(number),
                        static_cast<std::uint32_t>(number >> 32)};
    const Philox4 where = random_block(key, 0), way = random_block(key, 1);
    return emit(scene, uniform_from<double>(where[0]),
                {uniform_from<double>(where[1]), uniform_from<double>(where[2])},
                {uniform_from<double>(way[0]), uniform_from<double>(way[1])});
}

/// One straight piece of a particle's way.
struct Flight {
    Ray<double> ray;                // unit direction
    double length;                  // infinite where nothing is met
    Vec3<double> flux;              // W
    int depth;                      // surfaces met before
    bool smooth;                    // all of those were smooth
    const SurfaceHit<double>* hit;  // where it ends, or null
    const Material<double>* material;
};

class ParticleWalk {
public:
    ParticleWalk(const PathScene<double>& scene, const ParticleOptions& options)
        : scene_(scene), options_(options) {}

    /// visit(flight) for all flights of particles `first` to `first + count - 1`, at most sixteen, in a fixed order.
    template <class Visit>
    void follow(std::uint64_t first, int count, Visit&& visit) {
        for (int k = 0; k < walk_width; ++k) {
            lanes_[k].alive = k < count;
            if (lanes_[k].alive) start(lanes_[k], first + static_cast<std::uint64_t>(k));
        }
        for (int depth = 0; depth < options_.max_depth && fly(); ++depth)
            for (Lane& lane : lanes_) {
                if (!lane.alive) continue;
                lane.alive = lane.hit.has_value();
                visit(Flight{lane.ray, lane.length, lane.flux * lane.beta, depth, lane.smooth,
                             lane.alive ? &*lane.hit : nullptr,
                             lane.alive ? &material_of(lane) : nullptr});
                if (lane.alive) scatter(lane, depth);
            }
    }

protected:  // what a walk through media shares
    struct Lane {
        bool alive = false, smooth = true, textured = false;
        bool far = false;  // its light is at infinity
        RandomKey key;
        Ray<double> ray;
        Vec3<double> flux, beta;  // as it left the light; what surfaces have left of it
        double length = 0;
        std::optional<SurfaceHit<double>> hit;
        Material<double> own;  // where the material has textures
    };

    void start(Lane& lane, std::uint64_t number) const {
        const Particle particle = emitted_particle(scene_, options_.seed, number);
        lane.key = {options_.seed, 1, static_cast<std::uint32_t>(number),
                    static_cast<std::uint32_t>(number >> 32)};
        lane.ray = {particle.origin, particle.direction};
        lane.flux = particle.flux;
        lane.beta = Vec3<double>(1);
        lane.smooth = true;
        lane.far = particle.far;
        lane.alive = !is_black(lane.flux);
    }

    /// Finds where all flights end; returns whether there are any.
    bool fly() {
        RayPacket packet{};
        bool any = false;
        for (int k = 0; k < walk_width; ++k) {
            packet.active[k] = false;
            if (!lanes_[k].alive) continue;
            any = true;
            set_lane(packet, k, lanes_[k].ray.origin, lanes_[k].ray.direction,
                     std::numeric_limits<float>::infinity());
        }
        if (!any) return false;
        PacketHits found;
        scene_.geometry->bvh.trace(packet, false, found);
        for (int k = 0; k < walk_width; ++k) {
            Lane& lane = lanes_[k];
            if (!lane.alive) continue;
            lane.hit.reset();
            lane.length = std::numeric_limits<double>::infinity();
            if (found.primitive[k] < 0) continue;
            lane.hit = surface_hit(*scene_.geometry, lane.ray, found.instance[k],
                                   found.primitive[k], found.t[k]);
            lane.length = length(lane.hit->position - lane.ray.origin);
            look_up_textures(lane);
        }
        return true;
    }
    void look_up_textures(Lane& lane) const {
        const std::size_t m = number_of(lane);
        const SurfaceTextures& textures = scene_.geometry->textures;
        const std::span<const TextureUse> uses = textures.of(m);
        lane.textured = !uses.empty();
        if (lane.textured)
            lane.own = textured(scene_.materials[m], uses, textures, scene_.texels, lane.hit->uv);
    }

    /// Lets the material choose a direction; ends the way where it has none, or by roulette.
    void scatter(Lane& lane, int depth) const {
        lane.alive = false;
        const Material<double>& material = material_of(lane);
        const Vec3<double> back = -lane.ray.direction;
        const SurfaceSide<double> side(*lane.hit, back, material.transmits());
        if (material.has_opacity && passes(lane, material, side, depth)) return;
        const Philox4 words = random_block(lane.key, 2 + static_cast<std::uint32_t>(depth));
        const Vec2<double> u2(uniform_from<double>(words[0]), uniform_from<double>(words[1]));
        Vec3<double> out;
        const ScatterSample<double> next =
            draw(material, *lane.hit, side, u2, uniform_from<double>(words[2]), out);
        if (!(next.pdf > 0)) return;
        lane.beta *= weight(material, *lane.hit, side, back, out, next);
        if (!survives(lane, depth, uniform_from<double>(words[3]))) return;
        lane.smooth = lane.smooth && next.lobe >= 0;
        lane.ray = {side.start(lane.hit->position, out, scene_.geometry->offset), out};
        lane.alive = true;
    }
    /// False where a way ends, black or by roulette.
    bool survives(Lane& lane, int depth, double u) const {
        if (is_black(lane.beta)) return false;
        if (depth < options_.roulette_from) return true;
        const double survival =
            std::clamp(std::max({lane.beta.x, lane.beta.y, lane.beta.z}), 0.05, 0.95);
        if (u >= survival) return false;
        lane.beta *= 1 / survival;
        return true;
    }
    /// Whether the particle goes straight on behind a surface that covers only in part.
    bool passes(Lane& lane, const Material<double>& material, const SurfaceSide<double>& side,
                int depth) const {
        constexpr std::uint32_t cover_block = 1u << 20;  // behind those of all vertices
        const Philox4 words =
            random_block(lane.key, cover_block + static_cast<std::uint32_t>(depth));
        if (!goes_straight_on(scene_, number_of(lane), material, *lane.hit, side,
                              uniform_from<double>(words[0]), lane.ray, lane.beta))
            return false;
        lane.alive = !is_black(lane.beta);
        return true;
    }
    /// A direction `out` and its density. Where normals are bent, half of the directions of rough models are drawn as
    /// around the geometric one: those that the surface can see and its shading normal cannot are then drawn as well.
    static ScatterSample<double> draw(const Material<double>& material,
                                      const SurfaceHit<double>& hit,
                                      const SurfaceSide<double>& side, const Vec2<double>& u2,
                                      double u, Vec3<double>& out) {
        const bool bent = !material.is_specular() && side.frame.normal != side.normal;
        SurfaceHit<double> level = hit;
        level.shading = hit.outside;
        const SurfaceSide<double> flat =
            bent ? SurfaceSide<double>(level, side.frame.to_world(side.wo), material.transmits())
                 : side;
        const SurfaceSide<double>& used = bent && u < 0.5 ? flat : side;
        ScatterSample<double> next = material.sample(used.wo, u2, u);
        if (!(next.pdf > 0)) return {};
        out = used.frame.to_world(next.wi);
        if (!used.agrees(out, next.wi)) return {};
        if (bent)
            next.pdf = 0.5 * (material.pdf(side.wo, side.frame.to_local(out)) +
                              material.pdf(flat.wo, flat.frame.to_local(out)));
        return next;
    }
    /// What is left of a particle that goes on along `out`; see above.
    static Vec3<double> weight(const Material<double>& material, const SurfaceHit<double>& hit,
                               const SurfaceSide<double>& side, const Vec3<double>& back,
                               const Vec3<double>& out, const ScatterSample<double>& next) {
        const double areas = std::abs(dot(out, side.normal) / dot(back, side.normal));
        if (next.lobe >= 0) {
            const Vec3<double> home = material.value(next.wi, side.wo, next.lobe);
            Vec3<double> both;
            for (int c = 0; c < 3; ++c) both[c] = std::sqrt(next.value[c] * home[c]);
            return both * (areas * std::abs(side.wo.z / next.wi.z) / next.pdf);
        }
        // The frame is that which a viewer at `out` would see.
        const SurfaceSide<double> seen(hit, out, material.transmits());
        const Vec3<double> wi = seen.frame.to_local(back);
        if (!seen.agrees(back, wi)) return Vec3<double>(0);
        if (!(seen.wo.z * wi.z > 0) && !material.transmits()) return Vec3<double>(0);
        return material.f(seen.wo, wi) * (std::abs(wi.z) * areas / next.pdf);
    }

    static bool is_black(const Vec3<double>& v) { return v.x == 0 && v.y == 0 && v.z == 0; }
    [[nodiscard]] std::size_t number_of(const Lane& lane) const {
        return static_cast<std::size_t>(
            scene_.geometry->material[static_cast<std::size_t>(lane.hit->shape)]);
    }
    [[nodiscard]] const Material<double>& material_of(const Lane& lane) const {
        return lane.textured ? lane.own : scene_.materials[number_of(lane)];
    }

    const PathScene<double>& scene_;
    ParticleOptions options_;
    Lane lanes_[walk_width];
};

}  // namespace photograd
