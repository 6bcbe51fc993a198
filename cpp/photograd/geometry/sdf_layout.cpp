#include "photograd/geometry/sdf_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "photograd/core/errors.h"

namespace photograd {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Where a node stands: scale times its own point is shape_from_world of the world's.
struct SdfFrame {
    Affine shape_from_world;
    double scale = 1;

    [[nodiscard]] Vec3<double> axis(std::size_t i) const {  // in the world
        const auto& m = shape_from_world.m;
        return {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
    }
    [[nodiscard]] Vec3<double> shift() const {
        const auto& m = shape_from_world.m;
        return {m[3], m[7], m[11]};
    }
    [[nodiscard]] Vec3<double> center() const {  // M p + c = 0
        const Vec3<double> c = shift();
        return -(c.x * axis(0) + c.y * axis(1) + c.z * axis(2));
    }
    /// Of the child that is turned by `quat`, then moved by `moved`: q' = R^T (q - scale moved).
    [[nodiscard]] SdfFrame placed(const double* quat, const double* moved) const {
        double r[3][3];
        rotation_matrix(UnitQuaternion<double>::of(quat).n, r);
        SdfFrame out{*this};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                double sum = 0;
                for (std::size_t j = 0; j < 3; ++j) {
                    const double own = shape_from_world.m[4 * j + k];
                    sum += r[j][i] * (k < 3 ? own : own - scale * moved[j]);
                }
                out.shape_from_world.m[4 * i + k] = sum;
            }
        return out;
    }
};

SdfReach around(const Vec3<double>& center, const Vec3<double>& half) {
    return {center - half, center + half};
}

/// A half space <n, p> <= height has an end only where it is cut off along an axis.
SdfReach of_plane(const SdfFrame& frame, const SdfStep& step, double swell) {
    const Vec3<double> own = normalize(Vec3<double>(step.x[0], step.x[1], step.x[2]));
    const Vec3<double> n = own.x * frame.axis(0) + own.y * frame.axis(1) + own.z * frame.axis(2);
    const double height = step.x[3] + swell - dot(own, frame.shift());
    SdfReach out{Vec3<double>(-infinite), Vec3<double>(infinite)};
    for (int k = 0; k < 3; ++k) {
        constexpr double level = 1e-12;
        if (!(std::abs(n[(k + 1) % 3]) < level && std::abs(n[(k + 2) % 3]) < level)) continue;
        if (n[k] > 0)
            out.hi[k] = height;
        else
            out.lo[k] = -height;
    }
    return out;
}

/// Where the distance from a shape is at most `swell`.
SdfReach of_shape(const SdfFrame& frame, const SdfStep& step, double swell) {
    const auto& x = step.x;
    Vec3<double> half(swell);
    for (int k = 0; k < 3; ++k) {
        const double along = std::abs(frame.axis(1)[k]);  // how far the Y axis runs along k
        switch (step.kind) {
            case SdfKind::sphere: half[k] += x[0]; break;
            case SdfKind::torus:
                half[k] += x[0] * std::sqrt(std::max(0.0, 1 - along * along)) + x[1];
                break;
            case SdfKind::capsule: half[k] += x[0] * along + x[1]; break;
            case SdfKind::box:
                for (std::size_t i = 0; i < 3; ++i) half[k] += x[i] * std::abs(frame.axis(i)[k]);
                break;
            default: return of_plane(frame, step, swell);
        }
    }
    return around(frame.center(), half);
}

SdfReach joined(SdfReach a, const SdfReach& b) {
    for (int k = 0; k < 3; ++k) {
        a.lo[k] = std::min(a.lo[k], b.lo[k]);
        a.hi[k] = std::max(a.hi[k], b.hi[k]);
    }
    return a;
}
SdfReach common(SdfReach a, const SdfReach& b) {
    for (int k = 0; k < 3; ++k) {
        a.lo[k] = std::max(a.lo[k], b.lo[k]);
        a.hi[k] = std::min(a.hi[k], b.hi[k]);
    }
    return a;
}

class Layout {
public:
    Layout(const Sdf& body, const double* numbers) : body_(body), numbers_(numbers) {}

    /// Adds the steps of a node, and tells where its distance is at most `swell`.
    SdfReach add(std::int32_t at, const SdfFrame& frame, double swell) {
        const SdfNode& node = body_.nodes()[static_cast<std::size_t>(at)];
        const double* x = numbers_ + node.numbers;
        switch (node.kind) {
            case SdfKind::place: return add(node.first, frame.placed(x, x + 4), swell);
            case SdfKind::scale: {
                SdfFrame larger = frame;
                larger.scale *= x[0];
                return add(node.first, larger, swell);
            }
            case SdfKind::round: {
                const double radius = x[0] * frame.scale;
                const SdfReach reach = add(node.first, frame, swell + radius);
                steps.push_back({node.kind, {radius}, {}});
                return reach;
            }
            default: break;
        }
        if (sdf_child_count(node.kind) == 0) return add_shape(node, frame, swell);
        // A smooth union takes at most width / 4 off the smaller distance.
        const double width = node.kind == SdfKind::smooth_unite ? x[0] * frame.scale : 0;
        const SdfReach a = add(node.first, frame, swell + width / 4),
                       b = add(node.second, frame, swell + width / 4);
        --waiting_;
        steps.push_back({node.kind, {width}, {}});
        if (node.kind == SdfKind::subtract) return a;
        return node.kind == SdfKind::intersect ? common(a, b) : joined(a, b);
    }
    std::vector<SdfStep> steps;

private:
    SdfReach add_shape(const SdfNode& node, const SdfFrame& frame, double swell) {
        if (++waiting_ > SdfStep::deepest)
            fail(ErrorKind::scene, "SdfSolid", "body",
                 "at most " + std::to_string(SdfStep::deepest) + " combinations within one another",
                 "more", "make the deeper one the first of each two");
        SdfStep step{node.kind, {}, frame.shape_from_world};
        // All numbers are lengths but a plane's normal.
        const int count = sdf_number_count(node.kind);
        for (int i = 0; i < count; ++i) {
            const double own = numbers_[node.numbers + i];
            const bool direction = node.kind == SdfKind::plane && i < 3;
            step.x[static_cast<std::size_t>(i)] = direction ? own : own * frame.scale;
        }
        steps.push_back(step);
        return of_shape(frame, step, swell);
    }

    const Sdf& body_;
    const double* numbers_;
    int waiting_ = 0;  // distances on the stack
};

}  // namespace

std::vector<SdfStep> lay_out(const Sdf& body, const double* numbers, SdfReach& reach) {
    Layout layout(body, numbers);
    reach = layout.add(static_cast<std::int32_t>(body.nodes().size()) - 1, {}, 0);
    return std::move(layout.steps);
}

}  // namespace photograd
