// Sampling paths through media, sixteen side by side: path_walk.h with something between the surfaces.
//
// A ray ends at the first of three: a collision in the medium it is in, which is a vertex; a surface, which is one too; or
// a boundary between media, which is none: the ray goes on behind it, in another medium. So paths reach their vertices
// at different rounds; each counts its own. What covers only in part (coverage.h) is a vertex also where light passes it:
// whoever goes through the hole of a shape's surface is in its interior. Vertex k owns the random numbers that it has without media, block
// `flights` + k of four for the first distance on its segment, and two streams for what a segment and a shadow ray may need
// beyond, however many. Block `flights` - 1 holds the path's channel.
//
// Weights of multiple importance sampling compare the densities of directions alone: both strategies have to get
// through the same media, and any weights that add up to 1 are right.
#pragma once

#include "photograd/render/camera_surroundings.h"
#include "photograd/render/crossing.h"
#include "photograd/render/free_flight.h"
#include "photograd/render/path_walk.h"

namespace photograd {

template <Real R>
class VolumeWalk : PathWalk<R> {
    using Base = PathWalk<R>;
    using Lane = typename Base::Lane;
    using Flight = typename FreeFlight<R>::State;

public:
    using Base::path, Base::width;

    VolumeWalk(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
               bool stop_when_black)
        : Base(scene, camera, options, stop_when_black),
          flight_(scene),
          around_(*scene.geometry, camera, options.sampler) {}

    /// Samples the paths of `count` <= 16 camera rays; they are then in path(k), media(k).
    void trace(const Ray<R>* rays, const RandomKey* keys, int count) {
        Base::begin(rays, keys, count);
        for (int k = 0; k < count; ++k) {
            Extra& extra = extras_[k];
            extra.trail.clear();
            extra.around = around_.of(keys[k]);
            extra.from = rays[k].origin;
            extra.shares = Vec3<R>(R(1));
            const Philox4 words = Base::numbers_(keys[k], flights - 1);
            extra.channel = std::min(2, static_cast<int>(3 * uniform_from<R>(words[0])));
            begin_segment(lanes_[k], extra);
        }
        while (follow()) {
            if (Base::may_ask()) ask_lights();
            for (int k = 0; k < count; ++k)
                if (lanes_[k].alive && extras_[k].at_vertex) go_on(lanes_[k], extras_[k]);
        }
    }
    [[nodiscard]] const MediaTrail<R>& media(int k) const { return extras_[k].trail; }

private:
    static constexpr std::uint32_t flights = 1 << 14;  // more blocks than vertices own
    static constexpr int most_boundaries = 1024;       // on one segment; then the path is given up

    struct Extra {
        MediaTrail<R> trail;
        Surroundings around;  // of the ray
        Vec3<R> from;         // where its present stretch starts, exactly
        Flight flight;
        int channel = 0;       // whose coefficients draw the distances of this path
        Vec3<R> shares{R(1)};  // of the channels in having drawn it so far; their mean is 1
        bool at_vertex = false;
        int boundaries = 0;
    };
    struct Shadow {
        Surroundings around;
        Vec3<R> from, origin;
        Flight flight;
        int boundaries = 0;
    };

    const PathGeometry& geometry() const { return *scene_.geometry; }
    static int vertex_of(const Lane& lane) { return static_cast<int>(lane.path.size()) - 1; }

    void begin_segment(Lane& lane, Extra& extra) {
        const auto next = static_cast<std::uint32_t>(lane.path.size());
        const Philox4 words = Base::numbers_(lane.key, flights + next);
        extra.flight = {};
        extra.flight.channel = extra.channel;
        extra.flight.first_u = uniform_from<R>(words[0]);
        extra.flight.numbers = FlightNumbers(lane.key, 1 + 2 * next);
        extra.flight.product = extra.trail.start();
        extra.boundaries = 0;
    }

    /// Follows all rays to what is next; returns whether any is under way or has a vertex to go on from.
    bool follow() {
        RayPacket packet{};
        bool any = false;
        for (int k = 0; k < width; ++k) {
            const Lane& lane = lanes_[k];
            packet.active[k] = false;
            if (!lane.alive) continue;
            any = true;
            set_lane(packet, k, lane.ray.origin, lane.ray.direction,
                     std::numeric_limits<float>::infinity(), lane.time);
        }
        if (!any) return false;
        PacketHits found;
        geometry().bvh.trace(packet, false, found);
        for (int k = 0; k < width; ++k) {
            Lane& lane = lanes_[k];
            if (!lane.alive) continue;
            const bool met = found.primitive[k] >= 0;
            if (met)
                lane.hit = surface_hit(geometry(), lane.ray, found.instance[k], found.primitive[k],
                                       found.t[k], lane.time);
            advance(lane, extras_[k], met);
        }
        return true;
    }

    /// A stretch of a ray, up to a surface or without end.
    void advance(Lane& lane, Extra& extra, bool met) {
        extra.at_vertex = false;
        const MediaGeometry& media = geometry().media;
        // What meets nothing is in no shape, whatever rounding at edges has made of it.
        const std::int32_t medium = met ? extra.around.medium(media) : media.world;
        const R distance = met ? length(lane.hit.position - extra.from) : R(endless);
        R t = R(0);
        if (medium >= 0 && flight_.fly(medium, extra.from, lane.ray.direction, distance,
                                       extra.flight, extra.trail, t)) {
            collide(lane, extra.from + lane.ray.direction * t);
            return end_segment(lane, extra, medium);
        }
        if (met && is_boundary(geometry(), lane.hit.shape)) return pass_boundary(lane, extra);
        Base::arrive(lane, met);
        end_segment(lane, extra, MediaGeometry::vacuum);
    }
    void collide(Lane& lane, const Vec3<R>& position) {
        PathVertex<R>& v = lane.path.emplace_back();
        v.shape = SceneLights::none;
        v.direction = lane.ray.direction;
        v.pdf = lane.pdf;
        v.wo = -v.direction;
        lane.hit = {SceneLights::none, -1, position, Vec3<R>(R(0)), Vec3<R>(R(0))};
    }
    void end_segment(Lane& lane, Extra& extra, std::int32_t medium) {
        MediumVertex<R>& m = extra.trail.vertices.emplace_back();
        m.medium = medium;
        m.arrival = extra.flight.product;
        m.chance = extra.shares * extra.flight.chance;
        m.weight = R(3) / (m.chance.x + m.chance.y + m.chance.z);
        extra.shares = m.chance * m.weight;
        lane.beta *= extra.flight.carried * m.weight;
        extra.at_vertex = true;
        if (vertex_of(lane) + 1 == options_.max_depth) lane.alive = false;
        if (stop_when_black_ && Base::is_black(lane.beta)) lane.alive = false;
    }
    void pass_boundary(Lane& lane, Extra& extra) const {
        cross_straight(geometry(), lane.hit, lane.ray.direction, extra.around, extra.from,
                       lane.ray.origin);
        if (++extra.boundaries > most_boundaries) lane.alive = false;
    }

    void ask_lights() {
        Shadow shadows[width];
        bool any = false;
        for (int k = 0; k < width; ++k) {
            Lane& lane = lanes_[k];
            lane.shadow = lane.alive && extras_[k].at_vertex && find_light(lane, extras_[k]);
            if (!lane.shadow) continue;
            any = true;
            begin_shadow(lane, extras_[k], shadows[k]);
        }
        while (any) any = follow_shadows(shadows);
    }
    bool find_light(Lane& lane, const Extra& extra) {
        const int depth = vertex_of(lane);
        if (lane.hit.shape >= 0)
            return !lane.path.back().passed && !Base::sampling_of(lane).is_specular() &&
                   Base::choose_light(lane, depth);
        Base::find_light(lane, depth);
        PathVertex<R>& v = lane.path.back();
        LightVertex<R>& light = v.light;
        if (!(light.pdf > R(0))) return false;
        const auto m = static_cast<std::size_t>(extra.trail.vertices.back().medium);
        const R c = dot(v.direction, light.direction);
        light.wi = light.direction;
        light.f = Vec3<R>(scene_.media[m].phase->p(c));
        light.scatter_pdf = scene_.sampling_media[m].phase->pdf(c);
        light.weight = Base::light_share(light) / light.pdf;
        return true;
    }
    void begin_shadow(const Lane& lane, Extra& extra, Shadow& shadow) const {
        const Vec3<R>& direction = lane.path.back().light.direction;
        shadow.around = extra.around;
        shadow.from = shadow.origin = lane.hit.position;
        if (lane.hit.shape >= 0) {
            shadow.origin = lane.side.start(lane.hit.position, direction, geometry().offset);
            cross_if_through(geometry(), lane.hit, lane.path.back().direction, direction,
                             shadow.around);
        }
        const auto vertex = static_cast<std::uint32_t>(vertex_of(lane));
        shadow.flight.numbers = FlightNumbers(lane.key, 2 + 2 * vertex);
        shadow.flight.first_u = R(-1);
        shadow.flight.product = extra.trail.start();
    }
    /// One stretch of each shadow ray; returns whether any goes on behind a boundary, or behind what covers in part.
    bool follow_shadows(Shadow* shadows) {
        RayPacket packet{};
        for (int k = 0; k < width; ++k) {
            const Lane& lane = lanes_[k];
            packet.active[k] = false;
            if (!lane.shadow) continue;
            if (lane.light_far)
                set_lane(packet, k, shadows[k].origin, lane.path.back().light.direction,
                         std::numeric_limits<float>::infinity(), lane.time);
            else
                set_lane(packet, k, shadows[k].origin, lane.light_end - shadows[k].origin, 1.0f,
                         lane.time);
        }
        PacketHits found;
        geometry().bvh.trace(packet, false, found);
        bool any = false;
        for (int k = 0; k < width; ++k) {
            Lane& lane = lanes_[k];
            if (!lane.shadow) continue;
            lane.shadow = shade(lane, extras_[k], shadows[k], found, k);
            any = any || lane.shadow;
        }
        return any;
    }
    /// Whether the shadow ray goes on.
    bool shade(Lane& lane, Extra& extra, Shadow& shadow, const PacketHits& found, int k) const {
        LightVertex<R>& light = lane.path.back().light;
        const bool met = found.primitive[k] >= 0;
        const Vec3<R> zero(R(0));
        SurfaceHit<R> hit{SceneLights::none, -1, zero, zero, zero};
        if (met) {
            const Ray<R> ray{shadow.origin, light.direction};
            hit = surface_hit(geometry(), ray, found.instance[k], found.primitive[k],
                              found.t[k] * scale_of(lane, shadow), lane.time);
            if (!is_boundary(geometry(), hit.shape) &&
                !leaves_light(scene_, stop_when_black_, hit, light)) {
                light.weight = R(0);
                return false;
            }
        }
        const MediaGeometry& media = geometry().media;
        const bool out = !met && lane.light_far;
        const std::int32_t medium = out ? media.world : shadow.around.medium(media);
        const R distance = met   ? length(hit.position - shadow.from)
                           : out ? R(endless)
                                 : length(lane.light_end - shadow.from);
        if (medium >= 0)
            flight_.absorb(medium, shadow.from, light.direction, distance, shadow.flight,
                           extra.trail);
        extra.trail.vertices.back().shadow = shadow.flight.product;
        if (!met) return false;
        cross_straight(geometry(), hit, light.direction, shadow.around, shadow.from, shadow.origin);
        if (!lane.light_far && !(dot(lane.light_end - shadow.origin, light.direction) > R(0)))
            return false;
        if (++shadow.boundaries <= most_boundaries) return true;
        light.weight = R(0);
        return false;
    }
    /// Length of what the packet takes for a direction.
    float scale_of(const Lane& lane, const Shadow& shadow) const {
        return lane.light_far ? 1.0f : static_cast<float>(length(lane.light_end - shadow.origin));
    }

    void go_on(Lane& lane, Extra& extra) {
        if (lane.path.back().passed)
            Base::pass_on(lane);
        else if (lane.hit.shape >= 0)
            Base::go_on(lane, vertex_of(lane));
        else
            scatter(lane, extra);
        if (!lane.alive) return;
        if (lane.hit.shape >= 0)
            cross_if_through(geometry(), lane.hit, lane.path.back().direction, lane.ray.direction,
                             extra.around);
        extra.from = lane.hit.position;
        begin_segment(lane, extra);
    }
    void scatter(Lane& lane, const Extra& extra) {
        lane.alive = false;
        const int depth = vertex_of(lane);
        PathVertex<R>& v = lane.path.back();
        const auto m = static_cast<std::size_t>(extra.trail.vertices.back().medium);
        const Philox4 words = Base::numbers_(lane.key, 2 + 2 * static_cast<std::uint32_t>(depth));
        const AnyPhase<R>& sampling = *scene_.sampling_media[m].phase;
        v.wi = sampling.sample(v.direction, {uniform_from<R>(words[0]), uniform_from<R>(words[1])});
        const R c = dot(v.direction, v.wi), pdf = sampling.pdf(c);
        v.value = Vec3<R>(scene_.media[m].phase->p(c));
        if (!Base::survives(lane, depth, Vec3<R>(sampling.p(c)), R(1) / pdf,
                            uniform_from<R>(words[3])))
            return;
        lane.pdf = pdf;
        lane.cone = lane.cone.scattered(length(lane.hit.position - lane.previous), pdf);
        lane.previous = lane.hit.position;
        lane.ray = {lane.hit.position, v.wi};
        lane.alive = true;
    }

    using Base::lanes_, Base::options_, Base::scene_, Base::stop_when_black_;
    FreeFlight<R> flight_;
    CameraSurroundings around_;  // the shapes in which the camera stands
    Extra extras_[width];
};

}  // namespace photograd
