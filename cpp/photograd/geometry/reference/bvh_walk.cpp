#include "photograd/geometry/reference/bvh_walk.h"

namespace photograd {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Makes `best` the hit on triangle f, if there is one in [t_min, best.t].
void try_triangle(const Mesh& mesh, std::uint32_t f, const Ray<double>& ray, double t_min,
                  NearestHit& best) {
    const std::uint32_t* c = mesh.corners(f);
    const TrianglePoint<double> p = triangle_point(
        ray, mesh.vertex<double>(c[0]), mesh.vertex<double>(c[1]), mesh.vertex<double>(c[2]));
    // A ray within the plane has no number here, and no comparison is true.
    if (!(p.u >= 0 && p.v >= 0 && p.u + p.v <= 1 && p.t >= t_min && p.t <= best.t)) return;
    const auto primitive = static_cast<std::int32_t>(f);
    if (p.t == best.t && best.primitive >= 0 && best.primitive < primitive) return;
    best = {p.t, p.u, p.v, primitive};
}

NearestHit or_none(NearestHit best) {
    if (best.primitive < 0) best.t = infinity;
    return best;
}

}  // namespace

NearestHit walk_bvh(const Mesh& mesh, const BvhTree& tree, const Ray<double>& ray, double t_min,
                    double t_max, bool any, Visits& visits) {
    struct Entry {
        std::int32_t node;
        double enter;
    };
    // A node is taken off before its two children are put on: one entry more a level.
    Entry stack[BvhTree::deepest + 2];
    int size = 0;
    const auto push_if_met = [&](std::int32_t node) {
        double enter;
        ++visits.boxes;
        if (meets(tree.nodes[static_cast<std::size_t>(node)].box, ray, t_min, t_max, enter))
            stack[size++] = {node, enter};
    };
    NearestHit best{t_max, 0, 0, -1};
    push_if_met(0);
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.enter > best.t) continue;  // something nearer was found meanwhile
        const BvhNode& node = tree.nodes[static_cast<std::size_t>(entry.node)];
        if (node.count == 0) {
            const int before = size;
            push_if_met(entry.node + 1);
            push_if_met(node.right);
            // The nearer child on top: what it holds may spare us the other one.
            if (size == before + 2 && stack[size - 1].enter > stack[size - 2].enter)
                std::swap(stack[size - 1], stack[size - 2]);
            continue;
        }
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
            ++visits.triangles;
            try_triangle(mesh, tree.order[static_cast<std::size_t>(i)], ray, t_min, best);
            if (any && best.primitive >= 0) return best;
        }
        t_max = best.t;
    }
    return or_none(best);
}

NearestHit try_all_triangles(const Mesh& mesh, const Ray<double>& ray, double t_min, double t_max) {
    NearestHit best{t_max, 0, 0, -1};
    for (std::uint32_t f = 0; f < static_cast<std::uint32_t>(mesh.face_count()); ++f)
        try_triangle(mesh, f, ray, t_min, best);
    return or_none(best);
}

}  // namespace photograd
