#include <doctest/doctest.h>

#include <array>
#include <limits>

#include "photograd/sampling/distribution_2d.h"

using namespace photograd;

TEST_CASE("a choice has the probability of its weight and gives its number back") {
    const std::array<double, 4> weights{1.0, 0.0, 2.0, 5.0};
    const Distribution1D choice(weights);
    CHECK(choice.total() == 8.0);
    CHECK(choice.pmf(0) == 0.125);
    CHECK(choice.pmf(1) == 0.0);
    CHECK(choice.pmf(3) == 0.625);
    CHECK(choice.sample(0.0).index == 0);
    CHECK(choice.sample(0.0625).rest == 0.5);
    CHECK(choice.sample(0.125).index == 2);  // where two bins meet, and an empty one lies between
    CHECK(choice.sample(0.125).rest == 0.0);
    CHECK(choice.sample(0.374).index == 2);
    CHECK(choice.sample(0.6875).index == 3);
    CHECK(choice.sample(0.6875).rest == 0.5);
}

TEST_CASE("empty bins at either end are never sampled") {
    const std::array<double, 5> weights{0.0, 1.0, 1.0, 0.0, 0.0};
    const Distribution1D choice(weights);
    CHECK(choice.sample(0.0).index == 1);
    CHECK(choice.sample(1.0 - 1e-16).index == 2);
}

TEST_CASE("numbers that are none, and weights that are none, stay inside of the table") {
    const std::array<double, 3> weights{1.0, 1.0, 1.0}, none{0.0, 0.0, 0.0};
    CHECK(Distribution1D(weights).sample(1.0).index == 2);
    CHECK(Distribution1D(weights).sample(std::numeric_limits<double>::quiet_NaN()).index <= 2);
    CHECK(Distribution1D(none).total() == 0.0);
    CHECK(Distribution1D(none).sample(0.5).index == 2);
}

TEST_CASE("cells of a table are sampled by their share of the whole") {
    const double table[2][3] = {{0.0, 1.0, 3.0}, {4.0, 0.0, 0.0}};
    const Distribution2D cells(2, 3, [&](std::int64_t r, std::int64_t c) { return table[r][c]; });
    CHECK(cells.total() == 8.0);
    double mass = 0.0;
    std::array<int, 6> counts{};
    constexpr int strata = 64;
    for (int i = 0; i < strata; ++i)
        for (int j = 0; j < strata; ++j) {
            const CellChoice cell = cells.sample((i + 0.5) / strata, (j + 0.5) / strata);
            ++counts[static_cast<std::size_t>(3 * cell.row + cell.column)];
            CHECK(cell.pmf == doctest::Approx(table[cell.row][cell.column] / 8.0));
            CHECK(cell.rest_row >= 0.0);
            CHECK(cell.rest_row < 1.0);
            mass += 1.0;
        }
    for (std::size_t k = 0; k < 6; ++k)
        CHECK(counts[k] / mass == doctest::Approx(table[k / 3][k % 3] / 8.0));
}
