// Single scattering: spheres, expansions in generalized spherical functions, and layers that scatter once.

#include <cmath>
#include <complex>

#include "patina/core/constants.h"
#include "patina/jobs/validation/benchmark.h"
#include "patina/jobs/validation/haze_l_single_data.h"
#include "patina/jobs/validation/mie_data.h"
#include "patina/jobs/validation/spheroids_data.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/mie.h"

namespace patina::jobs::validation {

namespace {

using std::complex;

void run_efficiencies(const rt::Solver*, Comparison& comparison) {
    for (const auto& row : mie_tables::efficiencies) {
        const complex<double> m(row.index[0], row.index[1]);
        const optics::MieSphere sphere =
            m == 0.0 ? optics::MieSphere::perfect_conductor(row.x) : optics::MieSphere(row.x, m);
        const double computed[3] = {sphere.extinction_efficiency(), sphere.scattering_efficiency(), sphere.asymmetry()};
        for (int c = 0; c < 3; ++c)
            if (!std::isnan(row.value[c])) comparison.add(c, computed[c], row.value[c], row.unit[c]);
    }
}

void run_amplitudes(const rt::Solver*, Comparison& comparison) {
    const optics::MieSphere sphere(1.0, {1.5, 1.0});
    for (const auto& row : mie_tables::amplitudes) {
        const double cosine = std::cos(radians(row[0]));
        const optics::MieAmplitudes s = sphere.amplitudes(std::span(&cosine, 1));
        const double computed[4] = {s.s1[0].real(), -s.s1[0].imag(), s.s2[0].real(), -s.s2[0].imag()};
        for (int c = 0; c < 4; ++c) comparison.add(c, computed[c], row[c + 1], 1e-6);
    }
}

void run_matrix(const rt::Solver*, Comparison& comparison) {
    const optics::MieSphere sphere(2 * pi * 0.525 / 0.6328, 1.55);
    const auto s11_of = [&](double theta_deg, double(&ratios)[3]) {
        const double cosine = theta_deg == 180.0 ? -1.0 : std::cos(radians(theta_deg));
        const optics::MieAmplitudes s = sphere.amplitudes(std::span(&cosine, 1));
        const double s11 = (std::norm(s.s2[0]) + std::norm(s.s1[0])) / 2,
                     s12 = (std::norm(s.s2[0]) - std::norm(s.s1[0])) / 2;
        const complex<double> product = s.s2[0] * std::conj(s.s1[0]);
        ratios[0] = -s12 / s11;
        ratios[1] = product.real() / s11;
        ratios[2] = product.imag() / s11;
        return s11;
    };
    double ratios[3];
    const double forward = s11_of(0.0, ratios);
    for (const auto& row : mie_tables::matrix) {
        const double s11 = s11_of(row[0], ratios) / forward;
        comparison.add(0, s11, row[1], 2e-6);
        for (int c = 0; c < 3; ++c) comparison.add(c + 1, ratios[c], row[c + 2], 2e-6);
    }
}

optics::ExpansionCoefficients coefficients(std::span<const double[6]> rows) {
    optics::ExpansionCoefficients x;
    for (const auto& row : rows) {
        x.alpha1.push_back(row[0]);
        x.alpha2.push_back(row[1]);
        x.alpha3.push_back(row[2]);
        x.alpha4.push_back(row[3]);
        x.beta1.push_back(row[4]);
        x.beta2.push_back(row[5]);
    }
    return x;
}

// Their b1 and b2 are expanded with generalized spherical functions P = -d: the coefficients are ours.
void run_spheroids(const rt::Solver*, Comparison& comparison) {
    const optics::ExpansionCoefficients x = coefficients(spheroids::coefficients);
    for (const auto& row : spheroids::matrix) {
        const optics::ScatteringElements f =
            optics::evaluate(x, row.theta_deg == 180.0 ? -1.0 : std::cos(radians(row.theta_deg)));
        const double pairs[6][2] = {{f.a1, row.f11}, {f.a2, row.f22}, {f.a3, row.f33},
                                    {f.a4, row.f44}, {f.b1, row.f12}, {f.b2, row.f34}};
        constexpr int component[6] = {0, 1, 1, 1, 2, 3};
        for (int e = 0; e < 6; ++e) comparison.add(component[e], pairs[e][0], pairs[e][1], 2.5e-4);
    }
}

// What a layer scatters once is the derivative of its radiance with respect to the albedo at albedo 0.
constexpr double faint = 1e-7;
rt::Problem haze_layer() {
    return {1.0, {{haze_l::optical_thickness, faint, coefficients(haze_l::coefficients), 1.0}}, rt::BlackBase{}};
}

void run_haze(const rt::Solver* solver, Comparison& comparison) {
    std::vector<RadianceValue> values;
    for (const auto& row : haze_l::radiances)
        for (int s = 0; s < 3; ++s)
            values.push_back({row.upward ? 0.0 : haze_l::optical_thickness, row.upward, row.mu_o, row.phi_deg, s,
                              row.stokes[s], 1.5e-6});
    compare_field(*solver, haze_layer(), haze_l::mu_i, 1 / faint,
                  {.streams = 32, .fourier_tolerance = 0.0, .samples = 100'000}, values, comparison);
}

}  // namespace

std::vector<Benchmark> single_scattering_benchmarks() {
    std::vector<Benchmark> result;
    result.push_back({"Mie efficiencies",
                      "Wiscombe (1979), NCAR/TN-140+STR; Du (2004), Appl. Opt. 43, 1951, table 1",
                      "extinction, scattering, asymmetry of 37 spheres, x up to 10^4",
                      "one unit of the last printed digit",
                      {},
                      run_efficiencies,
                      {"Q_ext", "Q_sca", "g", ""}});
    result.push_back({"Mie amplitudes",
                      "Wiscombe (1979), x = 1, m = 1.5 + i",
                      "S1 and S2 at 6 angles",
                      "1e-6: one unit of the last digit",
                      {},
                      run_amplitudes,
                      {"Re S1", "Im S1", "Re S2", "Im S2"}});
    result.push_back({"Mie scattering matrix",
                      "Bohren & Huffman (1983), appendix A",
                      "scattering matrix at 21 angles",
                      "2e-6: two units of the last digit, the book's single precision",
                      {},
                      run_matrix,
                      {"S11", "S12", "S33", "S34"}});
    result.push_back({"Spheroids",
                      "Mishchenko (1991), J. Opt. Soc. Am. A 8, 871; T-matrix code, built-in test",
                      "scattering matrix from the expansion coefficients, 19 angles",
                      "2.5e-4: 57 coefficients rounded at 5e-6 each",
                      {},
                      run_spheroids,
                      {"F11", "F22-F44", "F12", "F34"}});
    result.push_back(
        {"Haze L, scattered once",
         "de Haan, Bosma & Hovenier (1987), Astron. Astrophys. 183, 371, model haze L; digits of SORD (S. Korkin)",
         "I, Q, U of single scattering by a layer of optical thickness 0.2",
         "1.5e-6: one and a half units of the last digit",
         {haze_layer()},
         run_haze});
    return result;
}

}  // namespace patina::jobs::validation
