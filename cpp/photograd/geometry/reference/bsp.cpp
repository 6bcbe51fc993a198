#include "photograd/geometry/reference/bsp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "photograd/core/errors.h"

namespace photograd {
namespace {

using Polygons = std::vector<BspPolygon>;

enum Side { in_plane = 0, front = 1, back = 2, crossing = 3 };  // crossing = front | back

/// All triangles as polygons, the plane of each, and what is as near to a plane as rounding: it
/// then lies in the plane, or cuts would leave slivers without end.
struct Workshop {
    Polygons polygons;
    std::vector<BspPlane> planes;
    double tolerance = 0;

    explicit Workshop(const Mesh& mesh) {
        for (std::uint32_t f = 0; f < static_cast<std::uint32_t>(mesh.face_count()); ++f) {
            BspPolygon polygon{{}, static_cast<std::int32_t>(f)};
            for (int k = 0; k < 3; ++k) {
                polygon.points.push_back(mesh.vertex<double>(mesh.corners(f)[k]));
                for (int axis = 0; axis < 3; ++axis)
                    tolerance = std::max(tolerance, 1e-10 * std::abs(polygon.points.back()[axis]));
            }
            const Vec3<double>& a = polygon.points[0];
            const Vec3<double> n = normalize(cross(polygon.points[1] - a, polygon.points[2] - a));
            planes.push_back({n, dot(n, a)});
            polygons.push_back(std::move(polygon));
        }
    }

    [[nodiscard]] const BspPlane& plane_of(std::int32_t face) const {
        return planes[static_cast<std::size_t>(face)];
    }

    /// Where a polygon lies, seen from the plane of `face`; what was cut from that face lies in it.
    [[nodiscard]] Side side_of(const BspPolygon& polygon, std::int32_t face) const {
        if (polygon.face == face) return in_plane;
        int side = in_plane;
        for (const Vec3<double>& p : polygon.points) {
            const double h = plane_of(face).height(p);
            if (h > tolerance) side |= front;
            if (h < -tolerance) side |= back;
        }
        return static_cast<Side>(side);
    }

    /// Of `candidates` polygons spread over the list, the face whose plane cuts few others and
    /// leaves as many in front as behind; a cut counts as much as four polygons out of balance.
    [[nodiscard]] std::int32_t best_face(const Polygons& list, int candidates) const {
        std::int32_t best = list.front().face;
        double least = std::numeric_limits<double>::infinity();
        const std::size_t tries = std::min(list.size(), static_cast<std::size_t>(candidates));
        for (std::size_t k = 0; k < tries; ++k) {
            const std::int32_t face = list[k * list.size() / tries].face;
            int count[4] = {};
            for (const BspPolygon& polygon : list) ++count[side_of(polygon, face)];
            const double cost = 4.0 * count[crossing] + std::abs(count[front] - count[back]);
            if (cost >= least) continue;
            least = cost;
            best = face;
        }
        return best;
    }
};

/// Walks around the polygon: corners go to their side, those in the plane and crossing points to
/// both sides.
std::pair<BspPolygon, BspPolygon> cut(const BspPolygon& polygon, const BspPlane& plane,
                                      double tolerance) {
    std::pair<BspPolygon, BspPolygon> halves{{{}, polygon.face}, {{}, polygon.face}};
    const std::size_t n = polygon.points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3<double>&p = polygon.points[i], &q = polygon.points[(i + 1) % n];
        const double hp = plane.height(p), hq = plane.height(q);
        if (hp >= -tolerance) halves.first.points.push_back(p);
        if (hp <= tolerance) halves.second.points.push_back(p);
        if ((hp > tolerance && hq < -tolerance) || (hp < -tolerance && hq > tolerance)) {
            const Vec3<double> x = p + (hp / (hp - hq)) * (q - p);
            halves.first.points.push_back(x);
            halves.second.points.push_back(x);
        }
    }
    return halves;
}

/// Deals out a list of polygons: those in the plane of `face` to `within`, which stay in this node.
void divide(const Workshop& shop, Polygons& list, std::int32_t face, Polygons& within,
            Polygons& in_front, Polygons& behind) {
    for (BspPolygon& polygon : list) {
        switch (shop.side_of(polygon, face)) {
            case in_plane: within.push_back(std::move(polygon)); break;
            case front: in_front.push_back(std::move(polygon)); break;
            case back: behind.push_back(std::move(polygon)); break;
            case crossing: {
                auto halves = cut(polygon, shop.plane_of(face), shop.tolerance);
                in_front.push_back(std::move(halves.first));
                behind.push_back(std::move(halves.second));
            }
        }
    }
}

void check_positive(const char* argument, int value) {
    if (value < 1) fail(ErrorKind::range, "BspTree", argument, "at least 1", std::to_string(value));
}

}  // namespace

BspTree::BspTree(const Mesh& mesh, const BspOptions& options) {
    check_positive("candidates", options.candidates);
    check_positive("max_polygons", options.max_polygons);
    // A list of tasks, not recursion: the tree of a convex body is as deep as it has faces.
    struct Task {
        Polygons polygons;
        std::int32_t parent;
        bool in_front;
        std::int32_t depth;
    };
    Workshop shop(mesh);
    std::vector<Task> tasks;
    const auto most = static_cast<std::size_t>(options.max_polygons);
    std::size_t waiting = shop.polygons.size();
    tasks.push_back({std::move(shop.polygons), -1, false, 0});
    while (!tasks.empty()) {
        if (polygons_.size() + waiting > most)
            fail(ErrorKind::range, "BspTree", "max_polygons",
                 "a mesh that falls into at most " + std::to_string(most) + " polygons", "more",
                 "cut a simpler mesh, or raise the limit");
        Task task = std::move(tasks.back());
        tasks.pop_back();
        waiting -= task.polygons.size();
        const auto here = static_cast<std::int32_t>(nodes_.size());
        if (task.parent >= 0) {
            BspNode& parent = nodes_[static_cast<std::size_t>(task.parent)];
            (task.in_front ? parent.front : parent.back) = here;
        }
        const std::int32_t face = shop.best_face(task.polygons, options.candidates);
        const auto first = static_cast<std::int32_t>(polygons_.size());
        Polygons in_front, behind;
        divide(shop, task.polygons, face, polygons_, in_front, behind);
        const std::int32_t count = static_cast<std::int32_t>(polygons_.size()) - first;
        nodes_.push_back({shop.plane_of(face), -1, -1, first, count, task.depth});
        waiting += in_front.size() + behind.size();
        if (!in_front.empty()) tasks.push_back({std::move(in_front), here, true, task.depth + 1});
        if (!behind.empty()) tasks.push_back({std::move(behind), here, false, task.depth + 1});
    }
}

void BspTree::back_to_front(const Vec3<double>& eye, std::uint32_t* order) const {
    // A node comes up twice: first to put its halves in order, then, as ~node, for its own
    // polygons.
    std::vector<std::int32_t> stack{0};
    while (!stack.empty()) {
        const std::int32_t top = stack.back();
        stack.pop_back();
        const BspNode& node = nodes_[static_cast<std::size_t>(top < 0 ? ~top : top)];
        if (top < 0) {
            for (std::int32_t i = 0; i < node.count; ++i)
                *order++ = static_cast<std::uint32_t>(node.first + i);
            continue;
        }
        const bool in_front = node.plane.height(eye) > 0;
        const std::int32_t near = in_front ? node.front : node.back;
        const std::int32_t far = in_front ? node.back : node.front;
        if (near >= 0) stack.push_back(near);
        stack.push_back(~top);
        if (far >= 0) stack.push_back(far);  // on top: comes first
    }
}

}  // namespace photograd
