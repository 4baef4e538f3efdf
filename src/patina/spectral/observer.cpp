#include "patina/spectral/observer.h"

#include <algorithm>
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

}  // namespace

Eigen::Vector3d colour_matching(Observer observer, double wavelength_nm) {
    if (!(wavelength_nm >= cie::observer_min_nm && wavelength_nm <= cie::observer_max_nm))
        return Eigen::Vector3d::Zero();

    const double position = (wavelength_nm - cie::observer_min_nm) / cie::observer_step_nm;
    const int i = std::min(static_cast<int>(position), cie::observer_samples - 2);
    const double t = position - i;
    Eigen::Vector3d result;
    for (int c = 0; c < 3; ++c) {
        const cie::ObserverTable& table = table_of(observer, c);
        result[c] = (1.0 - t) * table[i] + t * table[i + 1];
    }
    return result;
}

double luminance_integral_nm(Observer observer) {
    const cie::ObserverTable& y = table_of(observer, 1);
    return cie::observer_step_nm * std::accumulate(y.begin(), y.end(), 0.0);
}

double photopic_efficiency(double wavelength_nm) {
    return colour_matching(Observer::cie1931_2deg, wavelength_nm)[1];
}

}  // namespace patina::spectral
