#include "patina/spectral/whiteness.h"

#include <cmath>

#include "patina/core/contract.h"
#include "patina/spectral/colorimetry.h"

namespace patina::spectral {

namespace {

// ASTM E313-20, table 1: yellowness, white point, and the coefficient of x in the tint.
struct Coefficients {
    double c_x, c_z, white_x, white_y, tint_x;
};

const Coefficients& coefficients(WhitenessLight light, Observer observer) {
    static constexpr Coefficients table[2][2] = {
        {{1.2769, 1.0592, 0.3101, 0.3161, 1000.0}, {1.2871, 1.0781, 0.3104, 0.3191, 900.0}},
        {{1.2985, 1.1335, 0.3127, 0.3290, 1000.0}, {1.3013, 1.1498, 0.3138, 0.3310, 900.0}},
    };
    return table[light == WhitenessLight::d65][observer == Observer::cie1964_10deg];
}

}  // namespace

Whiteness astm_e313_whiteness(const Eigen::Vector3d& xyz, WhitenessLight light, Observer observer) {
    const Coefficients& c = coefficients(light, observer);
    const double y_percent = 100.0 * xyz[1];
    const Eigen::Vector2d xy = chromaticity(xyz);
    const double dx = c.white_x - xy[0], dy = c.white_y - xy[1];

    const double index = y_percent + 800.0 * dx + 1700.0 * dy;
    const double tint = c.tint_x * dx - 650.0 * dy;
    return {index, tint, index > 40.0 && index < 5.0 * y_percent - 280.0 && std::abs(tint) < 3.0};
}

double astm_e313_yellowness(const Eigen::Vector3d& xyz, WhitenessLight light, Observer observer) {
    PATINA_EXPECT(xyz[1] > 0.0);
    const Coefficients& c = coefficients(light, observer);
    return 100.0 * (c.c_x * xyz[0] - c.c_z * xyz[2]) / xyz[1];
}

}  // namespace patina::spectral
