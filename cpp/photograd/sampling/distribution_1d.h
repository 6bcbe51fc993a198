// A choice among n things in proportion to their weights.
//
//   cdf[i] = (w_0 + ... + w_{i-1}) / (w_0 + ... + w_{n-1})
//
// A uniform u falls between cdf[i] and cdf[i + 1] with probability pmf = w_i / sum. How far it fell
// between them is uniform again and serves as a fresh number, and neighboring u stay neighbors:
// strata survive the choice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace photograd {

/// A sample of a distribution: which, how far through its share in [0, 1), and its probability.
struct Choice {
    std::int64_t index;
    double rest, pmf;
};

/// Turns weights in cdf[1 .. n] into the table above, and returns their sum. Without any weight the
/// last one has it all, so that tables stay valid; a caller that must not draw then looks at the
/// sum.
inline double accumulate_cdf(std::span<double> cdf) {
    double total = 0.0;
    cdf.front() = 0.0;
    for (double& entry : cdf.subspan(1)) entry = total += entry;
    if (total > 0.0)
        for (double& entry : cdf.subspan(1)) entry /= total;
    cdf.back() = 1.0;
    return total;
}

/// The bin of u: the first whose end lies beyond u. Empty bins begin and end at one place and are
/// never found.
inline Choice choose(std::span<const double> cdf, double u) {
    const auto ends = cdf.subspan(1);
    const auto found = std::upper_bound(ends.begin(), ends.end(), u) - ends.begin();
    // u < 1 always finds one; 1 and NaN would not.
    const auto i = std::min(static_cast<std::size_t>(found), ends.size() - 1);
    const double pmf = cdf[i + 1] - cdf[i];
    const double rest = pmf > 0.0 ? (u - cdf[i]) / pmf : 0.0;
    return {static_cast<std::int64_t>(i), rest, pmf};
}

class Distribution1D {
public:
    Distribution1D() = default;
    /// Weights: at least one, finite and not negative (the caller has checked).
    explicit Distribution1D(std::span<const double> weights) : cdf_{0.0} {
        cdf_.insert(cdf_.end(), weights.begin(), weights.end());
        total_ = accumulate_cdf(cdf_);
    }
    [[nodiscard]] Choice sample(double u) const { return choose(cdf_, u); }
    [[nodiscard]] double pmf(std::int64_t i) const {
        const auto k = static_cast<std::size_t>(i);
        return cdf_[k + 1] - cdf_[k];
    }
    [[nodiscard]] double total() const { return total_; }

private:
    std::vector<double> cdf_;
    double total_ = 0.0;
};

}  // namespace photograd
