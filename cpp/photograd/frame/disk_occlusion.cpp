#include "photograd/frame/disk_occlusion.h"

#include <algorithm>
#include <cmath>

#include "photograd/frame/chunk_sums.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

constexpr std::int32_t leaf_size = 4;

Vec3<double> row(const double* rows, std::int64_t i) {
    return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
}

/// What a disk hides of a surface at `point`.
double hidden_by(const Vec3<double>& center, const Vec3<double>& disk_normal, double area,
                 const Vec3<double>& point, const Vec3<double>& normal) {
    const Vec3<double> v = center - point;
    const double squared = dot(v, v);
    if (!(squared > 0.0)) return 0.0;
    const double emitter = -dot(v, disk_normal), receiver = dot(v, normal);
    if (!(emitter > 0.0 && receiver > 0.0)) return 0.0;
    return area * emitter * receiver / (squared * (pi * squared + area));
}

}  // namespace

DiskTree::DiskTree(const Disks& disks) {
    disks_.resize(static_cast<std::size_t>(disks.count));
    for (std::int64_t i = 0; i < disks.count; ++i)
        disks_[static_cast<std::size_t>(i)] = {row(disks.centers, i), row(disks.normals, i),
                                               disks.areas[i], static_cast<std::int32_t>(i)};
    if (disks.count > 0) build(0, static_cast<std::int32_t>(disks.count));
}

std::int32_t DiskTree::build(std::int32_t first, std::int32_t last) {
    const auto number = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    const auto begin = disks_.begin() + first, end = disks_.begin() + last;
    Node node;
    node.first = first, node.last = last;
    Vec3<double> low = begin->center, high = low;
    for (auto disk = begin; disk != end; ++disk) {
        node.area += disk->area;
        node.center += disk->center * disk->area;
        node.normal += disk->normal * disk->area;
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], disk->center[k]);
            high[k] = std::max(high[k], disk->center[k]);
        }
    }
    node.center = node.center * (1.0 / node.area), node.normal = node.normal * (1.0 / node.area);
    for (auto disk = begin; disk != end; ++disk)
        node.radius =
            std::max(node.radius, length(disk->center - node.center) + std::sqrt(disk->area / pi));
    if (last - first > leaf_size) {
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
        const std::int32_t middle = first + (last - first) / 2;
        // Numbers break ties: the same tree from any library's sort.
        std::sort(begin, end, [axis](const Disk& a, const Disk& b) {
            if (a.center[axis] != b.center[axis]) return a.center[axis] < b.center[axis];
            return a.number < b.number;
        });
        build(first, middle);
        node.right = build(middle, last);
    }
    nodes_[static_cast<std::size_t>(number)] = node;
    return number;
}

std::vector<double> DiskTree::mean_parts(const double* parts) const {
    std::vector<double> out;
    for (const Node& node : nodes_) {
        double sum = 0.0;
        for (std::int32_t i = node.first; i < node.last; ++i) {
            const Disk& disk = disks_[static_cast<std::size_t>(i)];
            sum += parts[disk.number] * disk.area;
        }
        out.push_back(sum / node.area);
    }
    return out;
}

template <Real R>
void DiskTree::look_up(const double* parts, double opening, double radius, std::int64_t count,
                       const R* points, const R* normals, R* visible) const {
    const std::vector<double> means = mean_parts(parts);
    const auto hidden = [&](const Vec3<double>& point, const Vec3<double>& normal,
                            std::vector<std::int32_t>& rest) {
        double sum = 0.0;
        std::size_t at = 0;
        while (true) {
            const Node& node = nodes_[at];
            const Vec3<double> away = node.center - point;
            const double distance = length(away);
            const bool beyond = distance - node.radius > radius || dot(away, normal) < -node.radius;
            const bool far = distance > opening * node.radius;
            if (!beyond && !far && node.right > 0) {
                rest.push_back(node.right);
                at += 1;  // its left child
                continue;
            }
            if (!beyond && far && distance <= radius) {
                sum += means[at] * hidden_by(node.center, node.normal, node.area, point, normal);
            } else if (!beyond) {
                for (std::int32_t i = node.first; i < node.last; ++i) {
                    const Disk& disk = disks_[static_cast<std::size_t>(i)];
                    if (length(disk.center - point) <= radius)
                        sum += parts[disk.number] *
                               hidden_by(disk.center, disk.normal, disk.area, point, normal);
                }
            }
            if (rest.empty()) return sum;
            at = static_cast<std::size_t>(rest.back());
            rest.pop_back();
        }
    };
    for_chunks(count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
        std::vector<std::int32_t> rest;  // empty before and after each point
        for (std::int64_t i = first; i < last; ++i) {
            const Vec3<double> point{double(points[3 * i]), double(points[3 * i + 1]),
                                     double(points[3 * i + 2])};
            const Vec3<double> normal{double(normals[3 * i]), double(normals[3 * i + 1]),
                                      double(normals[3 * i + 2])};
            const bool dark = nodes_.empty() || dot(normal, normal) == 0.0;
            visible[i] = dark ? R(1) : R(std::max(0.0, 1.0 - hidden(point, normal, rest)));
        }
    });
}

template void DiskTree::look_up(const double*, double, double, std::int64_t, const float*,
                                const float*, float*) const;
template void DiskTree::look_up(const double*, double, double, std::int64_t, const double*,
                                const double*, double*) const;

}  // namespace photograd
