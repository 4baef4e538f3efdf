#pragma once
// The nine dispersion formulas of the refractiveindex.info database ("Dispersion formulas", M. N. Polyanskiy),
// wavelength in um, coefficients C1, C2, ... as its pages list them.

#include <string>
#include <vector>

namespace patina::optics {

class DispersionFormula {
  public:
    static constexpr int first_number = 1, last_number = 9;

    // Empty when `count` coefficients make sense for the formula, else what it needs, for an error message.
    static std::string count_problem(int number, int count);

    // The coefficients must have a sensible count.
    DispersionFormula(int number, std::vector<double> coefficients);

    // n, or NaN where the formula has none (a pole, n^2 < 0).
    double operator()(double wavelength_um) const;

  private:
    int number_;
    std::vector<double> coefficients_;
};

}  // namespace patina::optics
