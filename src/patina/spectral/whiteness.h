#pragma once
// Whiteness and yellowness of near-white materials, ASTM E313-20.

#include <Eigen/Dense>

#include "patina/spectral/observer.h"

namespace patina::spectral {

// The lights for which ASTM E313 gives coefficients.
enum class WhitenessLight { c, d65 };

struct Whiteness {
    double index;  // 100 for the perfect reflecting diffuser; bluish whites lie above
    double tint;   // greenish above 0, reddish below
    bool valid;    // inside the region where the formula holds: 40 < index < 5 Y - 280 and |tint| < 3
};

// From XYZ with Y = 1 for the perfect reflecting diffuser.
Whiteness astm_e313_whiteness(const Eigen::Vector3d& xyz, WhitenessLight light, Observer observer);

// Yellowness index; 0 for every grey, negative for bluish whites. Throws ContractViolation for Y <= 0.
double astm_e313_yellowness(const Eigen::Vector3d& xyz, WhitenessLight light, Observer observer);

}  // namespace patina::spectral
