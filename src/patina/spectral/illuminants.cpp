#include "patina/spectral/illuminants.h"

#include <cmath>

#include <fmt/format.h>

#include "patina/spectral/cie_tables.h"

namespace patina::spectral {

namespace {

std::vector<double> grid(double first_nm, double step_nm, int count) {
    std::vector<double> wavelengths_nm(count);
    for (int i = 0; i < count; ++i) wavelengths_nm[i] = first_nm + i * step_nm;
    return wavelengths_nm;
}

double rounded(double value) {
    return std::round(value * 1000.0) / 1000.0;
}

// Chromaticity on the daylight locus (CIE 15:2004, equations 3.3 and 3.4), then the weights of S1 and S2 (3.6).
Spectrum daylight_phase(double t, bool rounded_weights) {
    const double x = t <= 7000.0 ? -4.6070e9 / (t * t * t) + 2.9678e6 / (t * t) + 0.09911e3 / t + 0.244063
                                 : -2.0064e9 / (t * t * t) + 1.9018e6 / (t * t) + 0.24748e3 / t + 0.237040;
    const double y = -3.000 * x * x + 2.870 * x - 0.275;
    const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
    double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    if (rounded_weights) {
        m1 = rounded(m1);
        m2 = rounded(m2);
    }

    std::vector<double> values(cie::daylight_samples);
    for (int i = 0; i < cie::daylight_samples; ++i)
        values[i] = cie::daylight_s0[i] + m1 * cie::daylight_s1[i] + m2 * cie::daylight_s2[i];
    return Spectrum(grid(cie::daylight_min_nm, cie::daylight_step_nm, cie::daylight_samples), std::move(values),
                    Outside::zero);
}

Spectrum lamp(const cie::LampTable& table) {
    return Spectrum(grid(cie::lamp_min_nm, cie::lamp_step_nm, cie::lamp_samples), {table.begin(), table.end()},
                    Outside::zero);
}

struct NamedIlluminant {
    const char* name;
    Spectrum (*make)();
};

constexpr NamedIlluminant illuminants[] = {{"A", illuminant_a}, {"D50", illuminant_d50}, {"D65", illuminant_d65},
                                           {"E", illuminant_e}, {"F2", illuminant_f2},   {"F11", illuminant_f11}};

}  // namespace

Spectrum illuminant_e() {
    return Spectrum(100.0);
}

Spectrum illuminant_a() {
    constexpr double c2_nm_k = 1.435e7, temperature_k = 2848.0, reference_nm = 560.0;
    std::vector<double> wavelengths_nm = grid(300.0, 5.0, 107), values;
    for (double wavelength_nm : wavelengths_nm)
        values.push_back(100.0 * std::pow(reference_nm / wavelength_nm, 5) *
                         std::expm1(c2_nm_k / (temperature_k * reference_nm)) /
                         std::expm1(c2_nm_k / (temperature_k * wavelength_nm)));
    return Spectrum(std::move(wavelengths_nm), std::move(values), Outside::zero);
}

Spectrum daylight(double correlated_colour_temperature_k) {
    const double t = correlated_colour_temperature_k;
    if (!(t >= 4000.0 && t <= 25000.0))
        throw input_error({}, fmt::format("daylight of {} K", t), "the CIE defines daylight from 4000 K to 25000 K",
                          t < 4000.0 ? "use a black body below 4000 K" : "");
    return daylight_phase(t, false);
}

// The CIE fixed the temperatures with c2 = 1.4380e-2 m K; today's constant moves them by 1.4388/1.4380.
Spectrum illuminant_d65() {
    return daylight_phase(6500.0 * 1.4388 / 1.4380, true);
}
Spectrum illuminant_d50() {
    return daylight_phase(5000.0 * 1.4388 / 1.4380, true);
}

Spectrum illuminant_f2() {
    return lamp(cie::f2);
}
Spectrum illuminant_f11() {
    return lamp(cie::f11);
}

Spectrum illuminant(std::string_view name, const SourceLocation& where) {
    for (const NamedIlluminant& candidate : illuminants)
        if (name == candidate.name) return candidate.make();
    throw input_error(where, fmt::format("unknown illuminant \"{}\"", name), {},
                      did_you_mean(name, illuminant_names()));
}

std::vector<std::string> illuminant_names() {
    std::vector<std::string> names;
    for (const NamedIlluminant& candidate : illuminants) names.emplace_back(candidate.name);
    return names;
}

double blackbody_radiance(double wavelength_nm, double temperature_k) {
    constexpr double planck_js = 6.62607015e-34, light_m_s = 299792458.0, boltzmann_j_k = 1.380649e-23;
    if (temperature_k <= 0.0) return 0.0;
    const double wavelength_m = wavelength_nm * 1e-9;
    const double exponent = planck_js * light_m_s / (wavelength_m * boltzmann_j_k * temperature_k);
    const double per_m = 2.0 * planck_js * light_m_s * light_m_s / std::pow(wavelength_m, 5) / std::expm1(exponent);
    return per_m * 1e-9;
}

}  // namespace patina::spectral
