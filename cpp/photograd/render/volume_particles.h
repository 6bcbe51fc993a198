// Particles through media: particle_walk.h with something between the surfaces.
//
// They fly as camera paths do (free_flight.h), and a phase function is the same from both ends. What a particle stands for
// at the end of a stretch is
//
//   flux  times  product of the steps  over  the mean chance of its channels to have come so far
//
// A flight has no memory. So one that passes a receiver is drawn in two: up to it, where what is left is counted, and on
// from there. A collision beyond takes nothing from what has landed, one before lands nowhere.
#pragma once

#include "photograd/render/camera_surroundings.h"
#include "photograd/render/crossing.h"
#include "photograd/render/free_flight.h"
#include "photograd/render/particle_walk.h"

namespace photograd {

class VolumeParticleWalk : ParticleWalk {
    using Segment = FreeFlight<double>::State;

public:
    VolumeParticleWalk(const PathScene<double>& scene, const ParticleOptions& options)
        : ParticleWalk(scene, options), flight_(scene) {}

    /// Follows particles `first` to `first + count - 1`, at most sixteen, in a fixed order. For each straight way
    /// gate(ray, length) says at which distance it passes the receiver, or below 0; land(flux) is what comes so far.
    template <class Gate, class Land>
    void follow(std::uint64_t first, int count, Gate&& gate, Land&& land) {
        for (int k = 0; k < walk_width; ++k) {
            lanes_[k].alive = k < count;
            if (lanes_[k].alive)
                leave(lanes_[k], extras_[k], first + static_cast<std::uint64_t>(k));
        }
        while (fly())
            for (int k = 0; k < walk_width; ++k)
                if (lanes_[k].alive) advance(lanes_[k], extras_[k], gate, land);
    }

private:
    static constexpr int most_boundaries = 1024;        // on one way; then it is given up
    static constexpr std::uint32_t flights = 1u << 31;  // steps of keys, beyond those of pictures

    struct Extra {
        Surroundings around;
        Vec3<double> from;  // where the present stretch starts, exactly
        Segment under_way;
        MediaTrail<double> trail;
        int channel = 0;
        Vec3<double> shares{1.0};  // as in volume_walk.h
        int depth = 0, boundaries = 0;
        bool landed = false;  // on this straight way
    };

    const PathGeometry& geometry() const { return *scene_.geometry; }

    void leave(Lane& lane, Extra& extra, std::uint64_t number) const {
        start(lane, number);
        const MediaGeometry& media = geometry().media;
        if (lane.far && media.world >= 0)  // which has no end
            lane.flux *=
                transmittance(scene_.media[static_cast<std::size_t>(media.world)].sigma_t, endless);
        lane.alive = !is_black(lane.flux);
        if (!lane.alive) return;
        extra.around = surroundings_of(geometry(), lane.ray.origin);
        extra.channel =
            std::min(2, static_cast<int>(3 * uniform_from<double>(random_block(lane.key, 1)[2])));
        extra.shares = Vec3<double>(1);
        extra.depth = 0;
        begin(lane, extra, lane.ray.origin);
    }
    /// A straight way from a light, a surface or a collision.
    void begin(const Lane& lane, Extra& extra, const Vec3<double>& from) const {
        extra.from = from;
        extra.trail.clear();
        extra.under_way = {};
        extra.under_way.channel = extra.channel;
        extra.under_way.first_u = -1;
        extra.under_way.numbers =
            FlightNumbers(lane.key, flights + static_cast<std::uint32_t>(extra.depth));
        extra.under_way.product = extra.trail.start();
        extra.boundaries = 0;
        extra.landed = false;
    }
    /// What the way so far has left, and how channels share in having drawn it.
    static Vec3<double> left(const Extra& extra, Vec3<double>& shares) {
        const Vec3<double> chance = extra.shares * extra.under_way.chance;
        const double weight = 3 / (chance.x + chance.y + chance.z);
        shares = chance * weight;
        return extra.under_way.product.value * weight;
    }
    /// Goes `distance` on in a medium; false, at a collision, if it does not come so far.
    bool travel(const Lane& lane, Extra& extra, std::int32_t medium, double distance) const {
        double t = 0;
        const bool collides = medium >= 0 && flight_.fly(medium, extra.from, lane.ray.direction,
                                                         distance, extra.under_way, extra.trail, t);
        extra.from += lane.ray.direction * (collides ? t : distance);
        return !collides;
    }

    template <class Gate, class Land>
    void advance(Lane& lane, Extra& extra, Gate& gate, Land& land) const {
        const MediaGeometry& media = geometry().media;
        const bool met = lane.hit.has_value();
        const std::int32_t medium = met ? extra.around.medium(media) : media.world;
        double distance = met ? length(lane.hit->position - extra.from) : endless;
        double at = extra.landed ? -1 : gate(lane.ray, lane.length);
        if (at >= 0) {
            at += dot(lane.ray.origin - extra.from, lane.ray.direction);
            if (!travel(lane, extra, medium, at)) return collide(lane, extra, medium);
            Vec3<double> shares;
            land(lane.flux * lane.beta * left(extra, shares));
            extra.landed = true;
            distance = std::max(distance - at, 0.0);
        }
        if (!travel(lane, extra, medium, distance)) return collide(lane, extra, medium);
        lane.alive = met;
        if (!met) return;
        if (is_boundary(geometry(), lane.hit->shape)) {
            cross_straight(geometry(), *lane.hit, lane.ray.direction, extra.around, extra.from,
                           lane.ray.origin);
            lane.alive = ++extra.boundaries <= most_boundaries;
            return;
        }
        const Vec3<double> arrived = lane.ray.direction;
        if (!arrive(lane, extra)) return;
        scatter(lane, extra.depth++);
        if (!lane.alive) return;
        cross_if_through(geometry(), *lane.hit, arrived, lane.ray.direction, extra.around);
        begin(lane, extra, lane.hit->position);
    }
    /// Weighs what arrives somewhere; whether it may go on from there.
    bool arrive(Lane& lane, Extra& extra) const {
        lane.beta *= left(extra, extra.shares);
        lane.alive = extra.depth + 1 < options_.max_depth && !is_black(lane.beta);
        return lane.alive;
    }
    void collide(Lane& lane, Extra& extra, std::int32_t medium) const {
        if (!arrive(lane, extra)) return;
        const AnyPhase<double>& phase = *scene_.media[static_cast<std::size_t>(medium)].phase;
        const Philox4 words = random_block(lane.key, 2 + static_cast<std::uint32_t>(extra.depth));
        const Vec3<double> out = phase.sample(
            lane.ray.direction, {uniform_from<double>(words[0]), uniform_from<double>(words[1])});
        const double c = dot(lane.ray.direction, out);
        lane.beta *= phase.p(c) / phase.pdf(c);
        lane.alive = survives(lane, extra.depth++, uniform_from<double>(words[3]));
        lane.smooth = false;
        lane.ray = {extra.from, out};
        begin(lane, extra, extra.from);
    }

    FreeFlight<double> flight_;
    Extra extras_[walk_width];
};

}  // namespace photograd
