#include "patina/jobs/table_accuracy.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/contract.h"

namespace patina::jobs {

namespace {

// Interpolation polynomials err most near the ends of the cosine's range, where these angles lie closest in cosine.
constexpr double zenith_angles_deg[] = {
    0, 3, 17, 29, 39, 48, 56, 62, 67, 71, 74.5, 78, 81, 83.5, largest_judged_zenith_deg};
constexpr int azimuths = 10;
static_assert(judged_values == std::size(zenith_angles_deg) * std::size(zenith_angles_deg) * azimuths * 16);

}  // namespace

brdf::MuellerGrid between_nodes(const BodySolution& body) {
    std::vector<double> mu, phi;
    for (const double angle_deg : zenith_angles_deg) mu.push_back(std::cos(radians(angle_deg)));
    for (int k = 0; k < azimuths; ++k) phi.push_back(radians(20.0 * k));
    brdf::MuellerTable table;
    table.wavelengths_nm = {550.0};
    table.mu = body.reflection.mu;
    table.mu_weights = body.reflection.weights;
    table.body = {{body.reflection.modes}};
    table.specular_theta_deg = specular_angles_deg();
    table.once_scattered = {body.once_scattered};
    return table.evaluate_grid(550.0, mu, mu, phi);
}

std::span<const double> to_values(const brdf::MuellerGrid& grid) {
    return {grid.values.front().data(), 16 * grid.values.size()};
}

brdf::MuellerGrid to_grid(std::span<const double> values) {
    PATINA_EXPECT(values.size() == judged_values);
    const int angles = static_cast<int>(std::size(zenith_angles_deg));
    brdf::MuellerGrid grid{angles, angles, azimuths, std::vector<optics::Mueller>(values.size() / 16)};
    std::copy(values.begin(), values.end(), grid.values.front().data());
    return grid;
}

double largest_difference(const brdf::MuellerGrid& a, const brdf::MuellerGrid& b) {
    PATINA_EXPECT(a.values.size() == b.values.size());
    double largest = 0.0;
    for (std::size_t k = 0; k < a.values.size(); ++k)
        largest = std::max(largest, (a.values[k] - b.values[k]).cwiseAbs().maxCoeff());
    return largest;
}

double intensity_scale(const brdf::MuellerGrid& grid) {
    double largest = darkest_scale;
    for (const optics::Mueller& value : grid.values) largest = std::max(largest, value(0, 0));
    return largest;
}

}  // namespace patina::jobs
