#include "photograd/texture/ssim.h"

#include <array>
#include <cmath>
#include <vector>

#include "photograd/core/parallel.h"

namespace photograd {
namespace {

constexpr int taps = ssim_window;

/// The weights of the window along one axis; they add up to one.
template <Real R>
std::array<R, taps> window_weights() {
    std::array<double, taps> weights{};
    double total = 0;
    for (int k = 0; k < taps; ++k) {
        const double offset = (k - (taps - 1) / 2) / 1.5;
        weights[static_cast<std::size_t>(k)] = std::exp(-0.5 * offset * offset);
        total += weights[static_cast<std::size_t>(k)];
    }
    std::array<R, taps> scaled{};
    for (std::size_t k = 0; k < taps; ++k) scaled[k] = R(weights[k] / total);
    return scaled;
}

/// Moments of all windows, and later what becomes of them: planes of rows x columns numbers.
template <class R, int Planes>
struct Moments {
    std::int64_t rows, columns;
    std::vector<R> values;

    Moments(std::int64_t rows_, std::int64_t columns_)
        : rows(rows_),
          columns(columns_),
          values(static_cast<std::size_t>(Planes * rows_ * columns_)) {}
    R* row(int plane, std::int64_t i) { return values.data() + (plane * rows + i) * columns; }
};

/// out[i] = sum_k w_k in[i + k stride]: one row, whose channels lie side by side.
template <class R>
void blur_row(const R* in, const std::array<R, taps>& weights, std::int64_t stride,
              std::int64_t count, R* out) {
    for (std::int64_t i = 0; i < count; ++i) out[i] = R(0);
    for (int k = 0; k < taps; ++k) {
        const R w = weights[static_cast<std::size_t>(k)];
        const R* from = in + k * stride;
        for (std::int64_t i = 0; i < count; ++i) out[i] += w * from[i];
    }
}

/// x, y, x^2, y^2 and x y of each row, blurred along it: five planes of H rows.
template <class R>
Moments<R, 5> blurred_along_rows(const ImageView<const R>& x, const R* y,
                                 const std::array<R, taps>& weights) {
    const std::int64_t c = x.channels, wide = x.shape.width * c;
    Moments<R, 5> along(x.shape.height, wide - (taps - 1) * c);
    parallel_for(along.rows, [&](std::int64_t i) {
        const R* a = x.texels + i * wide;
        const R* b = y + i * wide;
        std::vector<R> product(static_cast<std::size_t>(3 * wide));
        for (std::int64_t j = 0; j < wide; ++j) {
            product[static_cast<std::size_t>(j)] = a[j] * a[j];
            product[static_cast<std::size_t>(wide + j)] = b[j] * b[j];
            product[static_cast<std::size_t>(2 * wide + j)] = a[j] * b[j];
        }
        blur_row(a, weights, c, along.columns, along.row(0, i));
        blur_row(b, weights, c, along.columns, along.row(1, i));
        for (int k = 0; k < 3; ++k)
            blur_row(product.data() + k * wide, weights, c, along.columns, along.row(2 + k, i));
    });
    return along;
}

/// The sum of S over one row of windows; where d is not null its planes get g dS/d(m, p, q).
template <class R>
double similarity_of_row(Moments<R, 5>& along, const std::array<R, taps>& weights, std::int64_t i,
                         R g, Moments<R, 3>* d) {
    const R c1 = R(0.01 * 0.01), c2 = R(0.03 * 0.03);
    const std::int64_t n = along.columns;
    std::vector<R> moment(static_cast<std::size_t>(5 * n));
    for (int k = 0; k < 5; ++k) blur_row(along.row(k, i), weights, n, n, moment.data() + k * n);
    const R *mx = moment.data(), *my = mx + n, *xx = my + n, *yy = xx + n, *xy = yy + n;
    std::vector<R> similarity(static_cast<std::size_t>(n));
    R *dm = nullptr, *dp = nullptr, *dq = nullptr;
    if (d != nullptr) dm = d->row(0, i), dp = d->row(1, i), dq = d->row(2, i);
    for (std::int64_t j = 0; j < n; ++j) {
        const R a1 = 2 * mx[j] * my[j] + c1, b1 = mx[j] * mx[j] + my[j] * my[j] + c1;
        const R a2 = 2 * (xy[j] - mx[j] * my[j]) + c2;
        const R b2 = (xx[j] - mx[j] * mx[j]) + (yy[j] - my[j] * my[j]) + c2;
        const R over = R(1) / (b1 * b2), s = a1 * a2 * over;
        similarity[static_cast<std::size_t>(j)] = s;
        if (d == nullptr) continue;
        dm[j] = g * (2 * my[j] * (a2 - a1) * over + 2 * mx[j] * s * (R(1) / b2 - R(1) / b1));
        dp[j] = -g * s / b2;
        dq[j] = g * 2 * a1 * over;
    }
    double total = 0;
    for (const R s : similarity) total += double(s);
    return total;
}

/// Row i of the adjoint of the blur down the columns: the windows whose rows reach row i.
template <class R>
void spread_down(Moments<R, 3>& d, int plane, std::int64_t i, const std::array<R, taps>& weights,
                 R* out) {
    for (std::int64_t j = 0; j < d.columns; ++j) out[j] = R(0);
    for (int k = 0; k < taps; ++k) {
        const std::int64_t from = i - k;
        if (from < 0 || from >= d.rows) continue;
        const R w = weights[static_cast<std::size_t>(k)];
        const R* row = d.row(plane, from);
        for (std::int64_t j = 0; j < d.columns; ++j) out[j] += w * row[j];
    }
}

/// The mean of S; adds its derivative to d_x unless that is null.
template <Real R>
double similarity(const ImageView<const R>& x, const R* y, double d_value, R* d_x) {
    const auto weights = window_weights<R>();
    Moments<R, 5> along = blurred_along_rows(x, y, weights);
    const std::int64_t c = x.channels, n = along.columns, wide = x.shape.width * c;
    const std::int64_t windows = along.rows - (taps - 1);
    Moments<R, 3> d(d_x != nullptr ? windows : 0, n);
    const R g = R(d_value / double(windows * n));
    std::vector<double> sums(static_cast<std::size_t>(windows));
    parallel_for(windows, [&](std::int64_t i) {
        sums[static_cast<std::size_t>(i)] =
            similarity_of_row(along, weights, i, g, d_x != nullptr ? &d : nullptr);
    });
    if (d_x != nullptr)
        parallel_for(x.shape.height, [&](std::int64_t i) {
            std::vector<R> column(static_cast<std::size_t>(n)),
                row(static_cast<std::size_t>(3 * wide));
            for (int plane = 0; plane < 3; ++plane) {
                spread_down(d, plane, i, weights, column.data());
                R* out = row.data() + plane * wide;
                for (int k = 0; k < taps; ++k) {
                    const R w = weights[static_cast<std::size_t>(k)];
                    for (std::int64_t j = 0; j < n; ++j)
                        out[j + k * c] += w * column[static_cast<std::size_t>(j)];
                }
            }
            const R *a = x.texels + i * wide, *b = y + i * wide;
            const R *dm = row.data(), *dp = dm + wide, *dq = dp + wide;
            for (std::int64_t j = 0; j < wide; ++j)
                d_x[i * wide + j] += dm[j] + 2 * a[j] * dp[j] + b[j] * dq[j];
        });
    double total = 0;
    for (const double sum : sums) total += sum;
    return total / double(windows * n);
}

}  // namespace

template <Real R>
double ssim(const ImageView<const R>& x, const R* y) {
    return similarity<R>(x, y, 0, nullptr);
}

template <Real R>
double ssim_backward(const ImageView<const R>& x, const R* y, double d_value, R* d_x) {
    return similarity<R>(x, y, d_value, d_x);
}

template double ssim(const ImageView<const float>&, const float*);
template double ssim(const ImageView<const double>&, const double*);
template double ssim_backward(const ImageView<const float>&, const float*, double, float*);
template double ssim_backward(const ImageView<const double>&, const double*, double, double*);

}  // namespace photograd
