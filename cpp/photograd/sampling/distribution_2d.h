// A choice among the cells of a table in proportion to their weights: first the row by the sums of
// the rows, then the column within it. pmf = (row's sum / total) (cell / row's sum).
#pragma once

#include "photograd/core/parallel.h"
#include "photograd/sampling/distribution_1d.h"

namespace photograd {

struct CellChoice {
    std::int64_t row, column;
    double rest_row, rest_column;  // how far through the cell, in [0, 1) each
    double pmf;
};

class Distribution2D {
public:
    Distribution2D() = default;
    /// weight(row, column) is finite and not negative. Rows are summed up on all threads, each by
    /// itself.
    template <class Weight>
    Distribution2D(std::int64_t rows, std::int64_t columns, Weight&& weight)
        : stride_(static_cast<std::size_t>(columns) + 1),
          cells_(static_cast<std::size_t>(rows) * stride_) {
        std::vector<double> sums(static_cast<std::size_t>(rows));
        parallel_for(rows, [&](std::int64_t row) {
            const std::span<double> cdf = row_of(row);
            for (std::int64_t column = 0; column < columns; ++column)
                cdf[static_cast<std::size_t>(column) + 1] = weight(row, column);
            sums[static_cast<std::size_t>(row)] = accumulate_cdf(cdf);
        });
        rows_ = Distribution1D(sums);
    }
    [[nodiscard]] CellChoice sample(double u_row, double u_column) const {
        const Choice row = rows_.sample(u_row);
        const Choice column = choose(
            {cells_.data() + static_cast<std::size_t>(row.index) * stride_, stride_}, u_column);
        return {row.index, column.index, row.rest, column.rest, row.pmf * column.pmf};
    }
    [[nodiscard]] double total() const { return rows_.total(); }

private:
    std::span<double> row_of(std::int64_t row) {
        return {cells_.data() + static_cast<std::size_t>(row) * stride_, stride_};
    }

    std::size_t stride_ = 0;
    std::vector<double> cells_;  // a table of stride_ entries for each row
    Distribution1D rows_;
};

}  // namespace photograd
