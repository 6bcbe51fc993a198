#include "photograd/geometry/ray_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "photograd/core/parallel.h"

namespace photograd {
namespace {

constexpr int levels = 5;  // bits of a cell per axis; 2 x 3 x 5 = 30 bits of key
constexpr int digit_bits = 10, digits = 1 << digit_bits;
constexpr std::int64_t block_size =
    65536;  // of the sort; fixed, so the thread count changes nothing

/// Spreads the low 5 bits of x to every sixth place.
std::uint32_t spread(std::uint32_t x) {
    std::uint32_t out = 0;
    for (int b = 0; b < levels; ++b) out |= ((x >> b) & 1u) << (6 * b);
    return out;
}

const std::array<std::uint32_t, 1 << levels>& spread_table() {
    static const auto table = [] {
        std::array<std::uint32_t, 1 << levels> t{};
        for (std::uint32_t i = 0; i < t.size(); ++i) t[i] = spread(i);
        return t;
    }();
    return table;
}

/// NaN lands in cell 0: such rays are refused elsewhere, here they only must not crash.
std::uint32_t cell(float x, float lo, float scale) {
    const float q = (x - lo) * scale;
    return q > 0 ? static_cast<std::uint32_t>(std::min(q, float((1 << levels) - 1))) : 0;
}

std::uint32_t line_key(const Vec3<float>& o, const Vec3<float>& d, const Box& box,
                       const Vec3<float>& scale) {
    // Distance to the box's far side: the nearest of the three planes that d points at.
    float exit = std::numeric_limits<float>::infinity();
    for (int k = 0; k < 3; ++k) {
        const float wall = d[k] > 0 ? box.hi[k] : box.lo[k];
        if (d[k] != 0) exit = std::min(exit, std::max((wall - o[k]) / d[k], 0.0f));
    }
    const auto& spread_bits = spread_table();
    std::uint32_t key = 0;
    for (int k = 0; k < 3; ++k) {
        const float end = exit < std::numeric_limits<float>::infinity() ? o[k] + exit * d[k] : o[k];
        key |= spread_bits[cell(o[k], box.lo[k], scale[k])] << k;
        key |= spread_bits[cell(end, box.lo[k], scale[k])] << (3 + k);
    }
    return key;
}

template <class R>
Vec3<float> load(const R* p) {
    return {float(p[0]), float(p[1]), float(p[2])};
}

/// All of group's rays within a cone of about 10 degrees and starting close together.
template <class R>
bool side_by_side(const RaySpan<R>& rays, std::int64_t first, float reach) {
    const Vec3<float> o = load(rays.origins + 3 * first), d = load(rays.directions + 3 * first);
    for (std::int64_t i = first + 1; i < first + 16; ++i) {
        const Vec3<float> p = load(rays.origins + 3 * i) - o, e = load(rays.directions + 3 * i);
        const float c = dot(d, e);
        if (!(c > 0 && c * c > 0.97f * dot(d, d) * dot(e, e) && dot(p, p) < reach * reach))
            return false;
    }
    return true;
}

}  // namespace

/// One stable pass of a least-significant-digit radix sort: counts per block, prefix sums over
/// (digit, block), then every block scatters to places that are its own. put(place, item) writes.
template <class Put>
void LineOrder::radix_pass(const Keyed* in, std::int64_t n, int shift, Put&& put) {
    const std::int64_t blocks = (n + block_size - 1) / block_size;
    std::vector<std::uint32_t> slot(static_cast<std::size_t>(blocks) * digits, 0);
    const auto each = [&](std::int64_t b, auto&& visit) {
        std::uint32_t* own = &slot[static_cast<std::size_t>(b) * digits];
        for (std::int64_t i = b * block_size; i < std::min(n, (b + 1) * block_size); ++i)
            visit(own[(in[i].key >> shift) & (digits - 1)], in[i]);
    };
    parallel_for(blocks, [&](std::int64_t b) {
        each(b, [](std::uint32_t& count, const Keyed&) { ++count; });
    });
    std::uint32_t total = 0;
    for (std::size_t d = 0; d < digits; ++d)
        for (std::size_t b = 0; b < static_cast<std::size_t>(blocks); ++b) {
            std::uint32_t& p = slot[b * digits + d];
            const std::uint32_t count = p;
            p = total;
            total += count;
        }
    parallel_for(blocks, [&](std::int64_t b) {
        each(b, [&](std::uint32_t& next, const Keyed& item) { put(next++, item); });
    });
}

template <Real R>
bool runs_side_by_side(const RaySpan<R>& rays, const Box& scene) {
    const std::int64_t groups = rays.count / 16, looks = std::min<std::int64_t>(groups, 256);
    if (looks == 0) return true;
    const float reach = 0.02f * length(scene.hi - scene.lo);
    std::int64_t yes = 0;
    for (std::int64_t k = 0; k < looks; ++k)
        yes += side_by_side(rays, 16 * (k * groups / looks), reach);
    return 2 * yes >= looks;
}

template <Real R>
const std::uint32_t* LineOrder::sort(const RaySpan<R>& rays, const Box& scene) {
    const std::int64_t n = rays.count;
    if (n > capacity_) {
        const auto size = static_cast<std::size_t>(n);
        first_ = std::make_unique_for_overwrite<Keyed[]>(size);
        second_ = std::make_unique_for_overwrite<Keyed[]>(size);
        order_ = std::make_unique_for_overwrite<std::uint32_t[]>(size);
        capacity_ = n;
    }
    Vec3<float> scale;
    for (int k = 0; k < 3; ++k)
        scale[k] = float(1 << levels) / std::max(scene.hi[k] - scene.lo[k], 1e-30f);
    parallel_for((n + block_size - 1) / block_size, [&](std::int64_t block) {
        for (std::int64_t i = block * block_size; i < std::min(n, (block + 1) * block_size); ++i)
            first_[static_cast<std::size_t>(i)] = {
                line_key(load(rays.origins + 3 * i), load(rays.directions + 3 * i), scene, scale),
                static_cast<std::uint32_t>(i)};
    });
    const auto into = [](auto& out) {
        return [&out](std::uint32_t slot, const Keyed& item) { out[slot] = item; };
    };
    radix_pass(first_.get(), n, 0, into(second_));
    radix_pass(second_.get(), n, digit_bits, into(first_));
    radix_pass(first_.get(), n, 2 * digit_bits,
               [&](std::uint32_t slot, const Keyed& item) { order_[slot] = item.ray; });
    return order_.get();
}

template bool runs_side_by_side(const RaySpan<float>&, const Box&);
template bool runs_side_by_side(const RaySpan<double>&, const Box&);
template const std::uint32_t* LineOrder::sort(const RaySpan<float>&, const Box&);
template const std::uint32_t* LineOrder::sort(const RaySpan<double>&, const Box&);

}  // namespace photograd
