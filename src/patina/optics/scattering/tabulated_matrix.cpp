#include "patina/optics/scattering/tabulated_matrix.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::optics {

namespace {

constexpr std::vector<double> ScatteringTable::*columns[] = {&ScatteringTable::a1, &ScatteringTable::a2,
                                                             &ScatteringTable::a3, &ScatteringTable::a4,
                                                             &ScatteringTable::b1, &ScatteringTable::b2};
constexpr const char* names[] = {"a1", "a2", "a3", "a4", "b1", "b2"};

// Slopes of the cubic spline through (x, y) whose slope is zero at both ends: the tridiagonal system of continuous
// second derivatives (de Boor 1978, chapter IV), by elimination.
std::vector<double> clamped_spline_slopes(const std::vector<double>& x, const std::vector<double>& y) {
    const std::size_t n = x.size();
    std::vector<double> slope(n, 0.0), upper(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
        const double rhs = 3.0 * (right * (y[i] - y[i - 1]) / left + left * (y[i + 1] - y[i]) / right);
        const double pivot = 2.0 * (left + right) - right * upper[i - 1];
        upper[i] = left / pivot;
        slope[i] = (rhs - right * slope[i - 1]) / pivot;
    }
    slope[n - 1] = 0.0;
    for (std::size_t i = n - 1; i-- > 1;) slope[i] -= upper[i] * slope[i + 1];
    return slope;
}

// The spline at ascending points x_out inside the range of x.
Eigen::ArrayXd interpolate(const std::vector<double>& x, const std::vector<double>& y,
                           const std::vector<double>& x_out) {
    const std::vector<double> slope = clamped_spline_slopes(x, y);
    Eigen::ArrayXd out(static_cast<Eigen::Index>(x_out.size()));
    std::size_t i = 0;
    for (std::size_t k = 0; k < x_out.size(); ++k) {
        while (i + 2 < x.size() && x_out[k] > x[i + 1]) ++i;
        const double h = x[i + 1] - x[i], t = (x_out[k] - x[i]) / h, s = 1.0 - t;
        out[k] =
            s * s * ((1 + 2 * t) * y[i] + t * h * slope[i]) + t * t * ((1 + 2 * s) * y[i + 1] - s * h * slope[i + 1]);
    }
    return out;
}

}  // namespace

void validate(const ScatteringTable& table, const SourceLocation& where) {
    const std::size_t count = table.angles_deg.size();
    if (count < 5)
        throw input_error(where, fmt::format("a scattering matrix at {} angles", count),
                          "its shape is unknown between them", "give at least 5 angles, better 181");
    for (std::size_t c = 0; c < 6; ++c)
        if ((table.*columns[c]).size() != count)
            throw input_error(where,
                              fmt::format("{} values of {} for {} angles", (table.*columns[c]).size(), names[c], count),
                              "each angle has one", "complete the table");
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = table.angles_deg[i];
        if (!std::isfinite(angle) || (i > 0 && angle <= table.angles_deg[i - 1]))
            throw input_error(where, fmt::format("angle {} is {} degrees", i + 1, angle), "angles ascend",
                              "sort the table");
        for (std::size_t c = 0; c < 6; ++c) {
            const double value = (table.*columns[c])[i];
            const bool legal = std::isfinite(value) && table.a1[i] > 0.0 && std::abs(value) <= table.a1[i] * (1 + 1e-3);
            if (!legal)
                throw input_error(
                    where, fmt::format("{} is {} at {} degrees, where a1 is {}", names[c], value, angle, table.a1[i]),
                    "a1 is positive and no other element exceeds it", "check the order and the units of the columns");
        }
    }
    if (std::abs(table.angles_deg.front()) > 1e-9 || std::abs(table.angles_deg.back() - 180.0) > 1e-9)
        throw input_error(
            where, fmt::format("angles reach from {} to {} degrees", table.angles_deg.front(), table.angles_deg.back()),
            "light is scattered into all directions", "extend the table to 0 and 180");
}

ExpansionCoefficients expand(const ScatteringTable& table, double tolerance, const SourceLocation& where) {
    PATINA_EXPECT(tolerance > 0.0);
    validate(table, where);
    std::vector<double> x(table.angles_deg.size());
    std::transform(table.angles_deg.begin(), table.angles_deg.end(), x.begin(), radians);
    x.front() = 0.0, x.back() = pi;

    // Take as many nodes as resolve the spline: about four to its finest interval.
    double finest = pi;
    for (std::size_t i = 1; i < x.size(); ++i) finest = std::min(finest, x[i] - x[i - 1]);
    const int nodes = std::clamp(static_cast<int>(4.0 * pi / finest), 64, 4096);
    ScatteringMatrix matrix;
    matrix.cosines = math::gauss_legendre(nodes);
    std::vector<double> angles(nodes);
    for (int i = 0; i < nodes; ++i) angles[i] = std::acos(matrix.cosines.nodes[nodes - 1 - i]);

    const double largest = *std::max_element(table.a1.begin(), table.a1.end());
    Eigen::ArrayXd* const elements[] = {&matrix.a1, &matrix.a2, &matrix.a3, &matrix.a4, &matrix.b1, &matrix.b2};
    for (std::size_t c = 0; c < 6; ++c) {
        std::vector<double> y = table.*columns[c];
        for (double& value : y) value /= largest;
        if (c >= 4) y.front() = y.back() = 0.0;
        *elements[c] = interpolate(x, y, angles).reverse();
    }
    if (!(matrix.a1 >= 0.0).all())
        throw input_error(where, "a1 changes so fast that the spline through it becomes negative", "",
                          "give more angles where it is steep");
    normalize(matrix);
    return expand(matrix, tolerance);
}

}  // namespace patina::optics
