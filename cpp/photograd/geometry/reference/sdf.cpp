#include "photograd/geometry/reference/sdf.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/ops/sdf_combine.h"
#include "photograd/ops/sdf_shapes.h"

namespace photograd {
namespace {

Vec3<double> three(const double* x) { return {x[0], x[1], x[2]}; }

void add_three(const Vec3<double>& v, double* out) {
    for (int k = 0; k < 3; ++k) out[k] += v[k];
}

[[noreturn]] void refuse(std::size_t node, const std::string& expected, const std::string& got) {
    fail(ErrorKind::range, "Sdf", "nodes", expected, got + " in node " + std::to_string(node));
}

}  // namespace

int sdf_number_count(SdfKind kind) {
    switch (kind) {
        case SdfKind::sphere:
        case SdfKind::smooth_unite:
        case SdfKind::scale:
        case SdfKind::round: return 1;
        case SdfKind::torus:
        case SdfKind::capsule: return 2;
        case SdfKind::box: return 3;
        case SdfKind::plane: return 4;
        case SdfKind::place: return 7;
        default: return 0;
    }
}

int sdf_child_count(SdfKind kind) {
    if (kind < SdfKind::unite) return 0;
    return kind < SdfKind::place ? 2 : 1;
}

Sdf::Sdf(std::vector<SdfNode> nodes) : nodes_(std::move(nodes)) {
    if (nodes_.empty()) refuse(0, "at least one node", "none");
    std::vector<int> depth(nodes_.size(), 1), parents(nodes_.size(), 0);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const SdfNode& node = nodes_[i];
        if (node.kind < SdfKind::sphere || node.kind > SdfKind::round)
            refuse(i, "a known kind", std::to_string(static_cast<int>(node.kind)));
        const std::int32_t children[2] = {node.first, node.second};
        for (int k = 0; k < sdf_child_count(node.kind); ++k) {
            const auto child = static_cast<std::size_t>(children[k]);
            if (children[k] < 0 || child >= i || parents[child]++ > 0)
                refuse(i, "children that are earlier nodes without a parent",
                       std::to_string(children[k]));
            depth[i] = std::max(depth[i], depth[child] + 1);
        }
        if (depth[i] > deepest)
            refuse(i, "a depth of at most " + std::to_string(deepest), std::to_string(depth[i]));
        if (node.numbers != number_count_)
            refuse(i, "numbers one after another", std::to_string(node.numbers));
        number_count_ += sdf_number_count(node.kind);
        if (i + 1 < nodes_.size()) continue;
        const auto orphans = std::count(parents.begin(), parents.end() - 1, 0);
        if (orphans > 0) refuse(i, "one root", std::to_string(orphans + 1) + " of them");
    }
}

const char* Sdf::fault(const double* numbers) const {
    for (std::int64_t i = 0; i < number_count_; ++i)
        if (!std::isfinite(numbers[i])) return "finite numbers";
    for (const SdfNode& node : nodes_) {
        const double* x = numbers + node.numbers;
        if (node.kind == SdfKind::plane) {
            if (!(length(three(x)) > 0)) return "normals of some length";
        } else if (node.kind == SdfKind::place) {
            if (!(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] > 0))
                return "quaternions of some length";
        } else if (!std::all_of(x, x + sdf_number_count(node.kind),
                                [](double v) { return v > 0; })) {
            return "radii, sizes, widths and factors above 0";
        }
    }
    return nullptr;
}

double Sdf::distance(std::int32_t at, const double* numbers, const Vec3<double>& p) const {
    const SdfNode& node = nodes_[static_cast<std::size_t>(at)];
    const double* x = numbers + node.numbers;
    const auto child = [&](std::int32_t which, const Vec3<double>& where) {
        return distance(which, numbers, where);
    };
    switch (node.kind) {
        case SdfKind::sphere: return sdf_sphere(p, x[0]);
        case SdfKind::plane: return sdf_plane(p, three(x), x[3]);
        case SdfKind::torus: return sdf_torus(p, x[0], x[1]);
        case SdfKind::box: return sdf_box(p, three(x));
        case SdfKind::capsule: return sdf_capsule(p, x[0], x[1]);
        case SdfKind::unite: return std::min(child(node.first, p), child(node.second, p));
        case SdfKind::intersect: return std::max(child(node.first, p), child(node.second, p));
        case SdfKind::subtract: return std::max(child(node.first, p), -child(node.second, p));
        case SdfKind::smooth_unite:
            return smooth_union(child(node.first, p), child(node.second, p), x[0]);
        case SdfKind::place: return child(node.first, to_shape(p, x, three(x + 4)));
        case SdfKind::scale: return x[0] * child(node.first, p / x[0]);
        case SdfKind::round: return child(node.first, p) - x[0];
    }
    return 0;  // no other kind gets past the constructor
}

void Sdf::backward(std::int32_t at, const double* numbers, const Vec3<double>& p, double d_f,
                   Vec3<double>& d_p, double* d_numbers) const {
    const SdfNode& node = nodes_[static_cast<std::size_t>(at)];
    const double* x = numbers + node.numbers;
    double* d_x = d_numbers + node.numbers;
    const auto child = [&](std::int32_t which) { return distance(which, numbers, p); };
    const auto pass = [&](std::int32_t which, double d, const Vec3<double>& where,
                          Vec3<double>& d_where) {
        backward(which, numbers, where, d, d_where, d_numbers);
    };
    Vec3<double> d_three(0), d_local(0);
    switch (node.kind) {
        case SdfKind::sphere: sdf_sphere_backward(p, d_f, d_p, d_x[0]); break;
        case SdfKind::plane:
            sdf_plane_backward(p, three(x), d_f, d_p, d_three, d_x[3]);
            add_three(d_three, d_x);
            break;
        case SdfKind::torus: sdf_torus_backward(p, x[0], d_f, d_p, d_x[0], d_x[1]); break;
        case SdfKind::box:
            sdf_box_backward(p, three(x), d_f, d_p, d_three);
            add_three(d_three, d_x);
            break;
        case SdfKind::capsule: sdf_capsule_backward(p, x[0], d_f, d_p, d_x[0], d_x[1]); break;
        case SdfKind::unite:
            pass(child(node.first) <= child(node.second) ? node.first : node.second, d_f, p, d_p);
            break;
        case SdfKind::intersect:
            pass(child(node.first) >= child(node.second) ? node.first : node.second, d_f, p, d_p);
            break;
        case SdfKind::subtract: {
            const bool outer = child(node.first) >= -child(node.second);
            pass(outer ? node.first : node.second, outer ? d_f : -d_f, p, d_p);
            break;
        }
        case SdfKind::smooth_unite: {
            double d_a = 0, d_b = 0;
            smooth_union_backward(child(node.first), child(node.second), x[0], d_f, d_a, d_b,
                                  d_x[0]);
            pass(node.first, d_a, p, d_p);
            pass(node.second, d_b, p, d_p);
            break;
        }
        case SdfKind::place: {
            pass(node.first, d_f, to_shape(p, x, three(x + 4)), d_local);
            to_shape_backward(p, x, three(x + 4), d_local, d_p, d_x, d_three);
            add_three(d_three, d_x + 4);
            break;
        }
        case SdfKind::scale: {
            // f = s g(q), q = p / s:   d_g = s d_f,   d_p = d_q / s,   d_s = g d_f - <d_q, q> / s
            const Vec3<double> q = p / x[0];
            pass(node.first, x[0] * d_f, q, d_local);
            d_p += d_local / x[0];
            d_x[0] += d_f * distance(node.first, numbers, q) - dot(d_local, q) / x[0];
            break;
        }
        case SdfKind::round: pass(node.first, d_f, p, d_p); d_x[0] -= d_f;
    }
}

}  // namespace photograd
