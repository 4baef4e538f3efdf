#include "patina/brdf/physical_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/parallel.h"

namespace patina::brdf {

using optics::Mueller;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Of the cubic between whole degrees at grazing incidence (mueller_table_test measures it).
constexpr double specular_interpolation_error = 2e-5;

using Complex4 = Eigen::Matrix<std::complex<double>, 4, 4>;
using Pauli = Eigen::Matrix2cd;

// The 16 matrices sigma_j x sigma_k* / 4 in Stokes order.
const std::array<Complex4, 16>& coherency_basis() {
    static const std::array<Complex4, 16> basis = [] {
        const std::complex<double> i(0, 1);
        std::array<Pauli, 4> sigma;
        sigma[0] << 1, 0, 0, 1;
        sigma[1] << 1, 0, 0, -1;
        sigma[2] << 0, 1, 1, 0;
        sigma[3] << 0, -i, i, 0;
        std::array<Complex4, 16> result;
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k)
                for (int row = 0; row < 2; ++row)
                    for (int column = 0; column < 2; ++column)
                        result[4 * j + k].block<2, 2>(2 * row, 2 * column) =
                            sigma[j](row, column) * sigma[k].conjugate() / 4;
        return result;
    }();
    return basis;
}

// Keeps the worst violation of one law and where it was seen.
struct Worst {
    double excess = -std::numeric_limits<double>::infinity();  // violation / tolerance
    PhysicalCheck check;

    void see(double violation, double tolerance, double wavelength_nm, double mu_o, double mu_i, double phi) {
        const double found = std::isfinite(violation) ? violation / tolerance : std::numeric_limits<double>::infinity();
        if (!(found > excess)) return;
        excess = found;
        check.worst = violation;
        check.tolerance = tolerance;
        check.passed = found <= 1.0;
        check.wavelength_nm = wavelength_nm;
        check.theta_o_deg = degrees(std::acos(mu_o));
        check.theta_i_deg = degrees(std::acos(mu_i));
        check.phi_deg = degrees(phi);
    }
    void merge(const Worst& other) {
        if (other.excess > excess) *this = other;
    }
};

enum Law { positivity, realizability, reciprocity, mirror_symmetry, energy, interpolation, law_count };
using Laws = std::array<Worst, law_count>;

// What the checks of one wavelength share.
struct Context {
    const MuellerTable& table;
    const PhysicalCheckOptions& options;
    int w;
    double wavelength_nm = table.wavelengths_nm[w];
    double error = table.error_estimate.empty() ? 0.0 : table.error_estimate[w];
};

std::vector<double> azimuths(int count) {
    std::vector<double> phi(count);
    for (int p = 0; p < count; ++p) phi[p] = pi * p / (count - 1);
    return phi;
}

// f00 and the coherency matrix at every pair of nodes.
void check_nodes(const Context& c, Laws& laws) {
    const std::vector<double>& mu = c.table.mu;
    const std::vector<double> phi = azimuths(c.options.azimuths);
    const MuellerGrid grid = c.table.evaluate_grid(c.wavelength_nm, mu, mu, phi);
    for (int i = 0; i < grid.incident; ++i) {
        // Rounding and the truncated Fourier series are relative to the largest value for this incidence.
        double largest = 0.0;
        for (int o = 0; o < grid.outgoing; ++o)
            for (int p = 0; p < grid.azimuths; ++p) largest = std::max(largest, grid.at(o, i, p)(0, 0));
        const double scale = largest > 0 ? largest : 1.0;
        const double tolerance = c.options.relative_tolerance;
        for (int o = 0; o < grid.outgoing; ++o)
            for (int p = 0; p < grid.azimuths; ++p) {
                const Mueller& f = grid.at(o, i, p);
                laws[positivity].see(-f(0, 0) / scale, tolerance, c.wavelength_nm, mu[o], mu[i], phi[p]);
                // An error of each element moves an eigenvalue by at most its sum over the matrix' 16 elements / 4.
                laws[realizability].see(-coherency_eigenvalues(f)[0] / scale, 4 * tolerance, c.wavelength_nm, mu[o],
                                        mu[i], phi[p]);
            }
    }
}

// f^m(o, i) = Q f^m(i, o)^T Q, and no coupling of {I,Q} with {U,V} in the azimuthal mean.
void check_symmetries(const Context& c, Laws& laws) {
    const auto& modes = c.table.body[c.w].modes;
    const auto n = static_cast<Eigen::Index>(c.table.mu.size());
    for (Eigen::Index o = 0; o < n; ++o)
        for (Eigen::Index i = 0; i < n; ++i) {
            const double mean = std::abs(modes[0](4 * o, 4 * i)) + std::abs(modes[0](4 * i, 4 * o));
            const double scale = mean > 0 ? mean / 2 : 1.0, mu_o = c.table.mu[o], mu_i = c.table.mu[i];
            const double tolerance = c.options.relative_tolerance;
            for (const Eigen::MatrixXd& mode : modes) {
                const Mueller there = mode.block<4, 4>(4 * o, 4 * i), back = mode.block<4, 4>(4 * i, 4 * o);
                const Mueller reversed = optics::reversal() * back.transpose() * optics::reversal();
                laws[reciprocity].see((there - reversed).lpNorm<Eigen::Infinity>() / scale, tolerance, c.wavelength_nm,
                                      mu_o, mu_i, none);
            }
            const Mueller first = modes[0].block<4, 4>(4 * o, 4 * i);
            const double coupling = std::max(first.topRightCorner<2, 2>().lpNorm<Eigen::Infinity>(),
                                             first.bottomLeftCorner<2, 2>().lpNorm<Eigen::Infinity>());
            laws[mirror_symmetry].see(coupling / scale, tolerance, c.wavelength_nm, mu_o, mu_i, none);
        }
}

// Largest S0 of all reflected light for a unit beam of any polarization: with the row (r0, r), r0 + |r|.
void check_energy(const Context& c, Laws& laws) {
    const MuellerTable& table = c.table;
    for (double mu_i : table.mu) {
        const Mueller specular = table.specular(c.wavelength_nm, mu_i);
        const double body = table.body_albedo(c.wavelength_nm, mu_i);
        const double body_q = table.body_albedo(c.wavelength_nm, mu_i, {1, 1, 0, 0}) - body;
        const Eigen::Vector3d polarized(specular(0, 1) + body_q, specular(0, 2), specular(0, 3));
        const double reflected = specular(0, 0) + body + polarized.norm();
        // The flux of an error that is everywhere as large as estimated is pi times it; the specular part is
        // interpolated.
        laws[energy].see(reflected - 1, c.options.relative_tolerance + specular_interpolation_error + pi * c.error,
                         c.wavelength_nm, none, mu_i, none);
    }
}

// f00 halfway between the nodes and along the normal; closer to grazing than the lowest node nothing is promised.
void check_between_nodes(const Context& c, Laws& laws) {
    const std::vector<double>& mu = c.table.mu;
    std::vector<double> between;
    for (std::size_t k = 1; k < mu.size(); ++k) between.push_back((mu[k - 1] + mu[k]) / 2);
    between.push_back(1.0);
    const std::vector<double> phi = azimuths(c.options.azimuths);
    const MuellerGrid grid = c.table.evaluate_grid(c.wavelength_nm, between, between, phi);
    for (int i = 0; i < grid.incident; ++i) {
        double largest = 0.0;
        for (int o = 0; o < grid.outgoing; ++o)
            for (int p = 0; p < grid.azimuths; ++p) largest = std::max(largest, grid.at(o, i, p)(0, 0));
        const double scale = largest > 0 ? largest : 1.0;
        for (int o = 0; o < grid.outgoing; ++o)
            for (int p = 0; p < grid.azimuths; ++p)
                laws[interpolation].see(-grid.at(o, i, p)(0, 0) / scale, c.options.interpolation_tolerance,
                                        c.wavelength_nm, between[o], between[i], phi[p]);
    }
}

struct LawText {
    const char *name, *explanation;
};
constexpr LawText texts[law_count] = {
    {"positivity", "no unpolarized light is reflected as negative light; worst: -f00 / largest f00 of the incidence"},
    {"realizability",
     "every Mueller matrix is a sum of Jones matrices' (Cloude 1986); worst: -least coherency eigenvalue / "
     "largest f00 of the incidence"},
    {"reciprocity",
     "f(i,o) = Q f(o,i)^T Q, Q = diag(1,1,-1,1), mode by mode; worst: difference / azimuthal mean of f00"},
    {"mirror_symmetry", "the azimuthal mean couples I,Q with U,V in neither direction; worst: coupling / mean of f00"},
    {"energy",
     "body and specular reflection return at most the incident flux, whatever its polarization; worst: largest "
     "reflectance - 1"},
    {"interpolation", "f00 stays positive between the nodes; worst: -f00 / largest f00 of the incidence"},
};

}  // namespace

Eigen::Vector4d coherency_eigenvalues(const Mueller& mueller) {
    const std::array<Complex4, 16>& basis = coherency_basis();
    Complex4 coherency = Complex4::Zero();
    for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 4; ++k) coherency += mueller(j, k) * basis[4 * j + k];
    return Eigen::SelfAdjointEigenSolver<Complex4>(coherency, Eigen::EigenvaluesOnly).eigenvalues();
}

std::vector<PhysicalCheck> check_physics(const MuellerTable& table, const PhysicalCheckOptions& options) {
    PATINA_EXPECT(options.azimuths >= 2 && options.relative_tolerance > 0 && options.interpolation_tolerance > 0);
    const auto wavelengths = static_cast<std::ptrdiff_t>(table.wavelengths_nm.size());
    std::vector<Laws> found(wavelengths);
    parallel_for(0, wavelengths, [&](std::ptrdiff_t w) {
        const Context context{table, options, static_cast<int>(w)};
        check_nodes(context, found[w]);
        check_symmetries(context, found[w]);
        check_energy(context, found[w]);
        check_between_nodes(context, found[w]);
    });

    std::vector<PhysicalCheck> checks;
    for (int law = 0; law < law_count; ++law) {
        Worst worst;
        for (const Laws& laws : found) worst.merge(laws[law]);
        worst.check.name = texts[law].name;
        worst.check.explanation = texts[law].explanation;
        checks.push_back(worst.check);
    }
    return checks;
}

}  // namespace patina::brdf
