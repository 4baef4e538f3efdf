#include "patina/optics/dispersion_formula.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "patina/core/contract.h"

namespace patina::optics {

namespace {

using Coefficients = std::vector<double>;

double at(const Coefficients& c, size_t i) {
    return i < c.size() ? c[i] : 0.0;
}

// C1 + sum over the pairs that follow of term(C2, C3).
template <class Term>
double sum_of_pairs(const Coefficients& c, size_t first, Term term) {
    double sum = 0.0;
    for (size_t i = first; i + 1 < c.size(); i += 2) sum += term(c[i], c[i + 1]);
    return sum;
}

// n^2 = C1 + C2 l^C3/(l^2 - C4^C5) + C6 l^C7/(l^2 - C8^C9) + C10 l^C11 + ...
double mixed_formula(const Coefficients& c, double l) {
    double n2 = c[0];
    for (size_t i : {1, 5})
        if (at(c, i) != 0.0) n2 += c[i] * std::pow(l, c[i + 1]) / (l * l - std::pow(c[i + 2], c[i + 3]));
    return n2 + sum_of_pairs(c, 9, [l](double a, double b) { return a * std::pow(l, b); });
}

// Herzberger: n = C1 + C2 L + C3 L^2 + C4 l^2 + C5 l^4 + C6 l^6 with L = 1/(l^2 - 0.028).
double herzberger(const Coefficients& c, double l2) {
    const double pole = 1.0 / (l2 - 0.028);
    return c[0] + at(c, 1) * pole + at(c, 2) * pole * pole + l2 * (at(c, 3) + l2 * (at(c, 4) + l2 * at(c, 5)));
}

}  // namespace

std::string DispersionFormula::count_problem(int number, int count) {
    switch (number) {
        case 4: {
            const bool sensible = count == 1 || count == 5 || (count >= 9 && count % 2 == 1);
            return sensible ? "" : fmt::format("formula 4 has 1, 5, 9, 11, 13, ... coefficients, not {}", count);
        }
        case 7:
            return count >= 1 && count <= 6 ? "" : fmt::format("formula 7 has 1 to 6 coefficients, not {}", count);
        case 8:
            return count == 4 ? "" : fmt::format("formula 8 has 4 coefficients, not {}", count);
        case 9:
            return count == 6 ? "" : fmt::format("formula 9 has 6 coefficients, not {}", count);
        default:
            return count % 2 == 1 ? "" : fmt::format("formula {} has 1, 3, 5, ... coefficients, not {}", number, count);
    }
}

DispersionFormula::DispersionFormula(int number, std::vector<double> coefficients)
    : number_(number), coefficients_(std::move(coefficients)) {
    PATINA_EXPECT(number >= first_number && number <= last_number);
    PATINA_EXPECT(count_problem(number, static_cast<int>(coefficients_.size())).empty());
}

double DispersionFormula::operator()(double wavelength_um) const {
    const Coefficients& c = coefficients_;
    const double l = wavelength_um, l2 = l * l;
    double n = 0.0;
    switch (number_) {
        case 1:
            n = std::sqrt(1.0 + c[0] + sum_of_pairs(c, 1, [=](double a, double b) { return a * l2 / (l2 - b * b); }));
            break;
        case 2:
            n = std::sqrt(1.0 + c[0] + sum_of_pairs(c, 1, [=](double a, double b) { return a * l2 / (l2 - b); }));
            break;
        case 3:
            n = std::sqrt(c[0] + sum_of_pairs(c, 1, [=](double a, double b) { return a * std::pow(l, b); }));
            break;
        case 4:
            n = std::sqrt(mixed_formula(c, l));
            break;
        case 5:
            n = c[0] + sum_of_pairs(c, 1, [=](double a, double b) { return a * std::pow(l, b); });
            break;
        case 6:
            n = 1.0 + c[0] + sum_of_pairs(c, 1, [=](double a, double b) { return a / (b - 1.0 / l2); });
            break;
        case 7:
            n = herzberger(c, l2);
            break;
        case 8: {
            // (n^2 - 1)/(n^2 + 2) = C1 + C2 l^2/(l^2 - C3) + C4 l^2
            const double ratio = c[0] + c[1] * l2 / (l2 - c[2]) + c[3] * l2;
            n = std::sqrt((1.0 + 2.0 * ratio) / (1.0 - ratio));
            break;
        }
        case 9: {
            // n^2 = C1 + C2/(l^2 - C3) + C4 (l - C5)/((l - C5)^2 + C6)
            const double d = l - c[4];
            n = std::sqrt(c[0] + c[1] / (l2 - c[2]) + c[3] * d / (d * d + c[5]));
            break;
        }
    }
    return std::isfinite(n) ? n : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace patina::optics
