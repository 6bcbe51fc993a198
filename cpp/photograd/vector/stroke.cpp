#include "photograd/vector/stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "photograd/core/atan.h"
#include "photograd/core/sincos.h"

namespace photograd {
namespace {

using Point = Vec2<double>;

Point left_of(Point u) { return {-u.y, u.x}; }
double inner(Point a, Point b) { return a.x * b.x + a.y * b.y; }

/// A segment as the walk meets it: its number, its length, its direction, of unit length.
struct Leg {
    std::uint32_t segment;
    double length;
    Point along;
    [[nodiscard]] Leg back() const { return {segment, length, -along}; }
};

/// The walk around a polyline, with that on its left side as it goes.
class OutlineWalk {
public:
    OutlineWalk(const Polyline& line, const StrokeStyle& style, StrokeOutline& out)
        : style_(style), out_(out) {
        const auto point = [&](std::size_t i) {
            return Point(line.points[2 * i], line.points[2 * i + 1]);
        };
        for (std::uint32_t i = 0; i < line.corner.size(); ++i)
            if (kept_.empty() || point(kept_.back()) != point(i)) kept_.push_back(i);
        // A corner among points at one place makes that place a corner.
        while (style.closed && kept_.size() > 1 && point(kept_.back()) == point(kept_[0]))
            kept_.pop_back();
        if (kept_.size() < 2) return;
        for (std::size_t k = 0; k < kept_.size(); ++k) {
            const std::size_t end = k + 1 < kept_.size() ? kept_[k + 1] : line.corner.size();
            bool corner = false;
            for (std::size_t i = kept_[k]; i < end; ++i) corner = corner || line.corner[i];
            corner_.push_back(corner);
        }
        const std::size_t segments = kept_.size() - (style.closed ? 0 : 1);
        for (std::size_t k = 0; k < segments; ++k) {
            const std::uint32_t a = kept_[k], b = kept_[(k + 1) % kept_.size()];
            const Point d = point(b) - point(a);
            const double length = std::sqrt(inner(d, d));
            legs_.push_back({static_cast<std::uint32_t>(k), length, d * (1 / length)});
            out.segments.insert(out.segments.end(), {a, b});
        }
    }

    void walk() {
        if (legs_.empty() || !(style_.half_width > 0)) return;
        const std::size_t n = legs_.size();
        if (style_.closed) {
            for (std::size_t k = 0; k < n; ++k) turn((k + 1) % n, legs_[k], legs_[(k + 1) % n]);
            end_contour();
            for (std::size_t k = n; k-- > 0;)
                turn((k + 1) % n, legs_[(k + 1) % n].back(), legs_[k].back());
            end_contour();
            return;
        }
        for (std::size_t k = 0; k + 1 < n; ++k) turn(k + 1, legs_[k], legs_[k + 1]);
        cap(n, legs_[n - 1]);
        for (std::size_t k = n - 1; k-- > 0;) turn(k + 1, legs_[k + 1].back(), legs_[k].back());
        cap(0, legs_[0].back());
        end_contour();
    }

private:
    void end_contour() {
        out_.contour_ends.push_back(static_cast<std::int64_t>(out_.vertices.size()));
    }
    /// A vertex that turns with one leg.
    void add(std::size_t at, const Leg& leg, Point r) {
        out_.vertices.push_back({kept_[at], leg.segment, leg.segment, r, left_of(r), Point(0.0)});
    }
    void cap(std::size_t at, const Leg& leg) {
        const Point n = left_of(leg.along);
        add(at, leg, n);
        if (style_.cap == Cap::square) {
            add(at, leg, n + leg.along);
            add(at, leg, leg.along - n);
        }
        if (style_.cap == Cap::round)
            for (int k = 1; k < style_.arc; ++k) {
                const auto turned = sin_cos(std::numbers::pi * k / style_.arc);
                add(at, leg, turned.cos * n + turned.sin * leg.along);
            }
        add(at, leg, -n);
    }
    /// The left side of a corner.
    void turn(std::size_t at, const Leg& in, const Leg& out) {
        const double cross = in.along.x * out.along.y - in.along.y * out.along.x;
        const double cosine = inner(in.along, out.along);
        const Point n1 = left_of(in.along), n2 = left_of(out.along);
        add(at, in, n1);
        if (cross > 0) {  // the left side is the inner one
            const double overlap = style_.half_width * cross;
            if (cosine < 0 || overlap > std::min(in.length, out.length))
                out_.vertices.push_back(
                    {kept_[at], in.segment, out.segment, Point(0.0), Point(0.0), Point(0.0)});
        } else if (!corner_[at] || style_.join == Join::round) {
            arc(at, in, out, polar_angle(cross, cosine));
        } else if (style_.join == Join::miter &&
                   (1 + cosine) * style_.miter_limit * style_.miter_limit >= 2) {
            // The tip (n1 + n2) / (1 + <n1, n2>) is 1 / cos(half of the turn) away.
            const double c = 1 + cosine;
            const Point sum = n1 + n2, r = sum * (1 / c);
            const Point d_in = (left_of(n1) - r * inner(left_of(n1), n2)) * (1 / c);
            const Point d_out = (left_of(n2) - r * inner(n1, left_of(n2))) * (1 / c);
            out_.vertices.push_back({kept_[at], in.segment, out.segment, r, d_in, d_out});
        }
        add(at, out, n2);
    }
    /// Points between the normals; each turns with its share of the two angles.
    void arc(std::size_t at, const Leg& in, const Leg& out, double angle) {
        // On the outer side the turn is to the right; back the way it came, by half a circle.
        const double turned = angle > 0 ? -angle : angle;
        const double pieces = std::ceil(-turned / std::numbers::pi * style_.arc - 1e-9);
        const Point n = left_of(in.along);
        for (double k = 1; k < pieces; ++k) {
            const double share = k / pieces;
            const auto part = sin_cos(turned * share);
            const Point r(part.cos * n.x - part.sin * n.y, part.sin * n.x + part.cos * n.y);
            out_.vertices.push_back({kept_[at], in.segment, out.segment, r,
                                     left_of(r) * (1 - share), left_of(r) * share});
        }
    }

    const StrokeStyle& style_;
    StrokeOutline& out_;
    std::vector<std::uint32_t> kept_;  // points that differ from the one before
    std::vector<bool> corner_;
    std::vector<Leg> legs_;
};

}  // namespace

StrokeOutline stroke_outline(const Polyline& line, const StrokeStyle& style) {
    StrokeOutline out;
    OutlineWalk(line, style, out).walk();
    return out;
}

double stroke_outline_backward(const Polyline& line, const StrokeStyle& style,
                               const StrokeOutline& outline, const double* d_vertices,
                               double* d_points) {
    double d_half_width = 0;
    std::vector<double> d_angle(outline.segments.size() / 2, 0.0);
    for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
        const OutlineVertex& vertex = outline.vertices[i];
        const Point g(d_vertices[2 * i], d_vertices[2 * i + 1]);
        d_points[2 * vertex.point] += g.x;
        d_points[2 * vertex.point + 1] += g.y;
        d_half_width += inner(g, vertex.r);
        d_angle[vertex.in] += style.half_width * inner(g, vertex.d_in);
        d_angle[vertex.out] += style.half_width * inner(g, vertex.d_out);
    }
    for (std::size_t k = 0; k < d_angle.size(); ++k) {
        const std::uint32_t a = outline.segments[2 * k], b = outline.segments[2 * k + 1];
        const Point d(line.points[2 * b] - line.points[2 * a],
                      line.points[2 * b + 1] - line.points[2 * a + 1]);
        const Point turn = left_of(d) * (d_angle[k] / inner(d, d));
        for (int i = 0; i < 2; ++i) {
            d_points[2 * b + static_cast<std::uint32_t>(i)] += turn[i];
            d_points[2 * a + static_cast<std::uint32_t>(i)] -= turn[i];
        }
    }
    return d_half_width;
}

}  // namespace photograd
