#include "patina/spectral/observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "patina/spectral/cie_tables.h"

namespace patina::spectral {

namespace {

const cie::ObserverTable& table_of(Observer observer, int component) {
    static constexpr const cie::ObserverTable* tables[2][3] = {{&cie::x_2deg, &cie::y_2deg, &cie::z_2deg},
                                                               {&cie::x_10deg, &cie::y_10deg, &cie::z_10deg}};
    return *tables[observer == Observer::cie1931_2deg ? 0 : 1][component];
}

constexpr int neighbours = 6;

// Of the values at 0, 1, 2 ... in Lagrange's polynomial through all of them.
std::array<double, neighbours> polynomial_weights(double x) {
    std::array<double, neighbours> weights;
    for (int i = 0; i < neighbours; ++i) {
        weights[i] = 1.0;
        for (int j = 0; j < neighbours; ++j)
            if (j != i) weights[i] *= (x - j) / (i - j);
    }
    return weights;
}

}  // namespace

Eigen::Vector3d colour_matching(Observer observer, double wavelength_nm) {
    if (!(wavelength_nm >= cie::observer_min_nm && wavelength_nm <= cie::observer_max_nm))
        return Eigen::Vector3d::Zero();

    const double position = (wavelength_nm - cie::observer_min_nm) / cie::observer_step_nm;
    const int first =
        std::clamp(static_cast<int>(position) - neighbours / 2 + 1, 0, cie::observer_samples - neighbours);
    const std::array<double, neighbours> weights = polynomial_weights(position - first);
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c) {
        const cie::ObserverTable& table = table_of(observer, c);
        for (int k = 0; k < neighbours; ++k) result[c] += weights[k] * table[first + k];
    }
    // Where zbar ends the polynomial swings below zero by some 1e-6.
    return result.cwiseMax(0.0);
}

double luminance_integral_nm(Observer observer) {
    const cie::ObserverTable& y = table_of(observer, 1);
    return cie::observer_step_nm * std::accumulate(y.begin(), y.end(), 0.0);
}

double photopic_efficiency(double wavelength_nm) {
    return colour_matching(Observer::cie1931_2deg, wavelength_nm)[1];
}

}  // namespace patina::spectral
