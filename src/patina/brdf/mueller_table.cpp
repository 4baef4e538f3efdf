#include "patina/brdf/mueller_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/brdf/interpolation.h"
#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/math/quadrature.h"

namespace patina::brdf {

using optics::Mueller;
using optics::Stokes;

namespace {

// Throws unless the axis has at least `smallest` finite values, strictly ascending within [lower, upper].
void require_axis(const SourceLocation& where, const char* name, const std::vector<double>& axis, std::size_t smallest,
                  double lower, double upper) {
    if (axis.size() < smallest)
        throw input_error(where, fmt::format("{} has {} values", name, axis.size()),
                          fmt::format("at least {} are needed", smallest));
    for (std::size_t k = 0; k < axis.size(); ++k) {
        if (!(axis[k] >= lower && axis[k] <= upper))
            throw input_error(where, fmt::format("{}[{}] is {}", name, k, axis[k]),
                              fmt::format("it must lie in {} .. {}", lower, upper));
        if (k > 0 && !(axis[k] > axis[k - 1]))
            throw input_error(where, fmt::format("{} does not ascend at index {}", name, k),
                              fmt::format("{} follows {}", axis[k], axis[k - 1]));
    }
}

void require_count(const SourceLocation& where, const char* name, std::size_t found, std::size_t expected,
                   const char* axis) {
    if (found != expected)
        throw input_error(where, fmt::format("{} has {} entries where {} has {}", name, found, axis, expected));
}

void require_finite(const SourceLocation& where, const char* name, bool finite, double wavelength_nm) {
    if (!finite) throw input_error(where, fmt::format("{} holds a NaN or infinity at {} nm", name, wavelength_nm));
}

void require_specular(const SourceLocation& where, const char* name, const MuellerTable& table,
                      const std::vector<std::vector<Mueller>>& specular) {
    require_count(where, name, specular.size(), table.wavelengths_nm.size(), "wavelengths_nm");
    for (std::size_t w = 0; w < specular.size(); ++w) {
        require_count(where, name, specular[w].size(), table.specular_theta_deg.size(), "specular_theta_deg");
        for (const Mueller& mueller : specular[w])
            require_finite(where, name, mueller.allFinite(), table.wavelengths_nm[w]);
    }
}

// sqrt(1 - mu^2) for odd modes, 1 for even ones: what a mode has that no polynomial in mu follows near mu = 1.
double odd_factor(int m, double mu) {
    return m % 2 == 0 ? 1.0 : std::sqrt((1 - mu) * (1 + mu));
}

// Weights that carry the node values of mode m to `mu`: interpolation of f^m / odd_factor, times odd_factor(mu).
Eigen::VectorXd mode_weights(const Eigen::VectorXd& lagrange, const std::vector<double>& nodes, int m, double mu) {
    if (m % 2 == 0) return lagrange;
    Eigen::VectorXd weights = lagrange * odd_factor(m, mu);
    for (std::size_t k = 0; k < nodes.size(); ++k) weights[k] /= odd_factor(m, nodes[k]);
    return weights;
}

// The dependence on azimuth of element (row, column) of mode m, without the factor (2 - delta_m0).
double azimuth_factor(int row, int column, double cos_m_phi, double sin_m_phi) {
    if ((row < 2) == (column < 2)) return cos_m_phi;
    return row < 2 ? -sin_m_phi : sin_m_phi;
}

// The body BRDF at one tabulated wavelength.
Mueller evaluate_modes(const BodyModes& body, const std::vector<double>& nodes, const Eigen::VectorXd& lagrange_o,
                       const Eigen::VectorXd& lagrange_i, double mu_o, double mu_i, double phi) {
    const auto n = static_cast<Eigen::Index>(nodes.size());
    Mueller result = Mueller::Zero();
    for (int m = 0; m < static_cast<int>(body.modes.size()); ++m) {
        const Eigen::MatrixXd& mode = body.modes[m];
        const Eigen::VectorXd weights_o = mode_weights(lagrange_o, nodes, m, mu_o);
        const Eigen::VectorXd weights_i = mode_weights(lagrange_i, nodes, m, mu_i);

        // Interpolate the incident axis first: whole columns are contiguous.
        Eigen::MatrixX4d columns = Eigen::MatrixX4d::Zero(4 * n, 4);
        for (Eigen::Index i = 0; i < n; ++i) columns += weights_i[i] * mode.middleCols<4>(4 * i);
        Mueller value = Mueller::Zero();
        for (Eigen::Index o = 0; o < n; ++o) value += weights_o[o] * columns.middleRows<4>(4 * o);

        // Add the mode with its azimuth dependence.
        const double multiplicity = m == 0 ? 1.0 : 2.0, c = std::cos(m * phi), s = std::sin(m * phi);
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                result(row, column) += multiplicity * azimuth_factor(row, column, c, s) * value(row, column);
    }
    return result;
}

// (4 K x 4 N): the interpolation of mode m from the nodes to K directions, acting on each Stokes component alike.
Eigen::MatrixXd interpolation_matrix(const BarycentricInterpolation& interpolation, const std::vector<double>& nodes,
                                     std::span<const double> mu, int m) {
    const auto n = static_cast<Eigen::Index>(nodes.size()), count = static_cast<Eigen::Index>(mu.size());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(4 * count, 4 * n);
    for (Eigen::Index k = 0; k < count; ++k) {
        const Eigen::VectorXd weights = mode_weights(interpolation.weights(mu[k]), nodes, m, mu[k]);
        for (Eigen::Index j = 0; j < n; ++j) result.block<4, 4>(4 * k, 4 * j).diagonal().setConstant(weights[j]);
    }
    return result;
}

// Mode m between the tabulated wavelengths; modes that one of the neighbours lacks count as zero there.
Eigen::MatrixXd mode_at(const std::vector<BodyModes>& body, const LinearInterval& interval, std::size_t m,
                        Eigen::Index size) {
    Eigen::MatrixXd mode = Eigen::MatrixXd::Zero(size, size);
    const auto add = [&](int w, double weight) {
        if (weight != 0.0 && m < body[w].modes.size()) mode += weight * body[w].modes[m];
    };
    add(interval.lower, 1 - interval.upper_weight);
    add(interval.upper, interval.upper_weight);
    return mode;
}

// The closed forms of one wavelength, made ready for a number of evaluations.
std::vector<OnceScatteredLight> lights(const MuellerTable& table, int w, std::size_t evaluations) {
    std::vector<OnceScatteredLight> result;
    if (table.once_scattered.empty()) return result;
    for (const OnceScattered& layer : table.once_scattered[w])
        result.emplace_back(layer, table.specular_theta_deg, evaluations);
    return result;
}

void add_once_scattered(const MuellerTable& table, int w, double weight, std::span<const double> mu_o,
                        std::span<const double> mu_i, std::span<const double> phi, MuellerGrid& grid) {
    if (weight == 0.0) return;
    for (const OnceScatteredLight& light : lights(table, w, grid.values.size())) {
        auto value = grid.values.begin();
        for (const double out : mu_o)
            for (const double in : mu_i)
                for (const double azimuth : phi) *value++ += weight * light(out, in, azimuth);
    }
}

// Flux of the once scattered light of the Stokes vectors (1,0,0,0) and (0,1,0,0), by quadrature of the upper
// hemisphere.
Eigen::RowVector2d once_scattered_albedo(const MuellerTable& table, int w, double mu_i) {
    constexpr int zeniths = 96, azimuths = 180;
    const math::Quadrature rule = math::gauss_legendre(zeniths, 0.0, 1.0);
    Eigen::RowVector2d flux = Eigen::RowVector2d::Zero();
    for (const OnceScatteredLight& light : lights(table, w, zeniths * azimuths))
        for (int o = 0; o < zeniths; ++o)
            for (int p = 0; p < azimuths; ++p)
                flux += rule.weights[o] * rule.nodes[o] * (2 * pi / azimuths) *
                        light(rule.nodes[o], mu_i, 2 * pi * (p + 0.5) / azimuths).block<1, 2>(0, 0);
    return flux;
}

void require_once_scattered(const SourceLocation& where, const MuellerTable& table) {
    if (table.once_scattered.empty()) return;
    require_count(where, "once_scattered", table.once_scattered.size(), table.wavelengths_nm.size(), "wavelengths_nm");
    for (std::size_t w = 0; w < table.once_scattered.size(); ++w)
        for (const OnceScattered& layer : table.once_scattered[w]) {
            if (!(layer.index_ratio > 0.0 && std::isfinite(layer.index_ratio) && layer.optical_thickness >= 0.0))
                throw input_error(where, fmt::format("once_scattered has no sense at {} nm", table.wavelengths_nm[w]),
                                  "an index ratio is above 0, an optical thickness not below");
            require_count(where, "once_scattered light", layer.down.size(), table.specular_theta_deg.size(),
                          "specular_theta_deg");
            require_count(where, "once_scattered light", layer.up.size(), layer.down.size(), "specular_theta_deg");
            const optics::ExpansionCoefficients& x = layer.scattering;
            for (const auto* list : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2}) {
                require_count(where, "once_scattered scattering", list->size(), x.alpha1.size(), "its order");
                for (const double value : *list)
                    require_finite(where, "once_scattered", std::isfinite(value), table.wavelengths_nm[w]);
            }
            if (x.order() < 2 || x.order() > 100'000)
                throw input_error(where, fmt::format("once_scattered scattering is of order {}", x.order()),
                                  "2 to 100000 make sense");
            for (const auto* list : {&layer.down, &layer.up})
                for (const Mueller& mueller : *list)
                    require_finite(where, "once_scattered", mueller.allFinite(), table.wavelengths_nm[w]);
        }
}

}  // namespace

void MuellerTable::validate(const SourceLocation& where) const {
    require_axis(where, "wavelengths_nm", wavelengths_nm, 1, 1.0, 1e9);
    require_axis(where, "mu", mu, 2, 0.0, 1.0);
    require_count(where, "mu_weights", mu_weights.size(), mu.size(), "mu");
    for (double weight : mu_weights)
        if (!(weight > 0 && weight <= 1)) throw input_error(where, fmt::format("a weight of mu is {}", weight));
    if (mu.back() >= 1.0 || mu.front() <= 0.0)
        throw input_error(where, "mu reaches an end of the interval", "quadrature nodes lie inside (0, 1)");

    require_count(where, "body", body.size(), wavelengths_nm.size(), "wavelengths_nm");
    const auto size = static_cast<Eigen::Index>(4 * mu.size());
    for (std::size_t w = 0; w < body.size(); ++w) {
        if (body[w].modes.empty())
            throw input_error(where, fmt::format("body has no Fourier mode at {} nm", wavelengths_nm[w]));
        for (const Eigen::MatrixXd& mode : body[w].modes) {
            if (mode.rows() != size || mode.cols() != size)
                throw input_error(
                    where,
                    fmt::format("a Fourier mode at {} nm is {} x {}", wavelengths_nm[w], mode.rows(), mode.cols()),
                    fmt::format("{} nodes make {} x {}", mu.size(), size, size));
            require_finite(where, "body", mode.allFinite(), wavelengths_nm[w]);
        }
    }

    require_axis(where, "specular_theta_deg", specular_theta_deg, 1, 0.0, 90.0);
    require_specular(where, "specular_surface", *this, specular_surface);
    require_specular(where, "specular_coherent", *this, specular_coherent);
    require_once_scattered(where, *this);
    if (!error_estimate.empty()) {
        require_count(where, "error_estimate", error_estimate.size(), wavelengths_nm.size(), "wavelengths_nm");
        for (std::size_t w = 0; w < error_estimate.size(); ++w)
            require_finite(where, "error_estimate", std::isfinite(error_estimate[w]) && error_estimate[w] >= 0,
                           wavelengths_nm[w]);
    }
}

Mueller MuellerTable::evaluate(double wavelength_nm, double mu_o, double mu_i, double phi) const {
    PATINA_EXPECT(mu_o >= 0 && mu_o <= 1 && mu_i >= 0 && mu_i <= 1 && std::isfinite(phi));
    const BarycentricInterpolation interpolation(mu);
    const Eigen::VectorXd lagrange_o = interpolation.weights(mu_o), lagrange_i = interpolation.weights(mu_i);
    const auto at = [&](int w) -> Mueller {
        return evaluate_modes(body[w], mu, lagrange_o, lagrange_i, mu_o, mu_i, phi) +
               evaluate_once_scattered(w, mu_o, mu_i, phi);
    };

    const LinearInterval interval = linear_interval(wavelengths_nm, wavelength_nm);
    if (interval.upper_weight == 0.0) return at(interval.lower);
    return (1 - interval.upper_weight) * at(interval.lower) + interval.upper_weight * at(interval.upper);
}

int MuellerTable::orders(double wavelength_nm) const {
    const LinearInterval interval = linear_interval(wavelengths_nm, wavelength_nm);
    return static_cast<int>(std::max(body[interval.lower].modes.size(), body[interval.upper].modes.size()));
}

Eigen::MatrixXd MuellerTable::mode(double wavelength_nm, int m, std::span<const double> mu_o,
                                   std::span<const double> mu_i) const {
    const LinearInterval interval = linear_interval(wavelengths_nm, wavelength_nm);
    const BarycentricInterpolation interpolation(mu);
    return interpolation_matrix(interpolation, mu, mu_o, m) *
           mode_at(body, interval, static_cast<std::size_t>(m), static_cast<Eigen::Index>(4 * mu.size())) *
           interpolation_matrix(interpolation, mu, mu_i, m).transpose();
}

MuellerGrid MuellerTable::evaluate_grid(double wavelength_nm, std::span<const double> mu_o,
                                        std::span<const double> mu_i, std::span<const double> phi) const {
    const auto inside = [](double x) { return x >= 0 && x <= 1; };
    PATINA_EXPECT(std::ranges::all_of(mu_o, inside) && std::ranges::all_of(mu_i, inside));
    const int count = orders(wavelength_nm);
    MuellerGrid grid{static_cast<int>(mu_o.size()), static_cast<int>(mu_i.size()), static_cast<int>(phi.size()), {}};
    grid.values.assign(mu_o.size() * mu_i.size() * phi.size(), Mueller::Zero());
    for (int m = 0; m < count; ++m) {
        const Eigen::MatrixXd values = mode(wavelength_nm, m, mu_o, mu_i);

        // The azimuth dependence of the 16 elements, one matrix an azimuth.
        std::vector<Mueller> azimuth(phi.size());
        for (std::size_t p = 0; p < phi.size(); ++p) {
            const double multiplicity = m == 0 ? 1.0 : 2.0, c = std::cos(m * phi[p]), s = std::sin(m * phi[p]);
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column)
                    azimuth[p](row, column) = multiplicity * azimuth_factor(row, column, c, s);
        }

        // Add the mode at every direction.
        auto value = grid.values.begin();
        for (int o = 0; o < grid.outgoing; ++o)
            for (int i = 0; i < grid.incident; ++i) {
                const Mueller amplitude = values.block<4, 4>(4 * o, 4 * i);
                for (int p = 0; p < grid.azimuths; ++p) *value++ += azimuth[p].cwiseProduct(amplitude);
            }
    }
    const LinearInterval interval = linear_interval(wavelengths_nm, wavelength_nm);
    add_once_scattered(*this, interval.lower, 1 - interval.upper_weight, mu_o, mu_i, phi, grid);
    add_once_scattered(*this, interval.upper, interval.upper_weight, mu_o, mu_i, phi, grid);
    return grid;
}

Mueller MuellerTable::evaluate_once_scattered(int w, double mu_o, double mu_i, double phi) const {
    Mueller sum = Mueller::Zero();
    for (const OnceScatteredLight& light : lights(*this, w, 1)) sum += light(mu_o, mu_i, phi);
    return sum;
}

Mueller MuellerTable::specular(double wavelength_nm, double mu_i) const {
    PATINA_EXPECT(mu_i >= 0 && mu_i <= 1);
    const CubicInterval angle = cubic_interval(specular_theta_deg, degrees(std::acos(mu_i)));
    const auto at = [&](int w) {
        Mueller sum = Mueller::Zero();
        for (int k = 0; k < angle.count; ++k)
            sum += angle.weights[k] * (specular_surface[w][angle.first + k] + specular_coherent[w][angle.first + k]);
        return sum;
    };
    const LinearInterval interval = linear_interval(wavelengths_nm, wavelength_nm);
    return (1 - interval.upper_weight) * at(interval.lower) + interval.upper_weight * at(interval.upper);
}

double MuellerTable::body_albedo(double wavelength_nm, double mu_i, const Stokes& incident) const {
    PATINA_EXPECT(mu_i >= 0 && mu_i <= 1);
    const LinearInterval interval = linear_interval(wavelengths_nm, wavelength_nm);
    const Eigen::VectorXd lagrange = BarycentricInterpolation(mu).weights(mu_i);

    // R = 2 pi int mu_o f^0 d mu_o: only the azimuthal mean carries flux.
    const auto at = [&](int w) {
        const Eigen::MatrixXd& mean = body[w].modes.front();
        double flux = 0.0;
        for (std::size_t o = 0; o < mu.size(); ++o)
            for (std::size_t i = 0; i < mu.size(); ++i)
                flux += mu_weights[o] * mu[o] * lagrange[i] *
                        mean.block<1, 2>(4 * o, 4 * i).dot(incident.head<2>().transpose());
        return (2 * pi * flux + once_scattered_albedo(*this, w, mu_i).dot(incident.head<2>())) / incident[0];
    };
    return (1 - interval.upper_weight) * at(interval.lower) + interval.upper_weight * at(interval.upper);
}

}  // namespace patina::brdf
