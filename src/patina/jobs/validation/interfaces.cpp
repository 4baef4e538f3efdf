// Interfaces: Fresnel's closed forms, absorbing coats, slabs of glass, and layers that must return all light.

#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/jobs/validation/benchmark.h"
#include "patina/math/quadrature.h"
#include "patina/optics/fresnel.h"

namespace patina::jobs::validation {

namespace {

constexpr double infinite = HUGE_VAL;

// Closed forms in components: reflectance, polarization, phase difference of total reflection, energy.
void run_fresnel(const rt::Solver*, Comparison& comparison) {
    constexpr double exact = 1e-14;  // a few roundings
    for (const double n : {1.3, 1.5, 2.7}) {
        const double normal = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
        comparison.add(0, optics::fresnel_reflection(1.0, 1.0, n)(0, 0), normal, exact);
        comparison.add(0, optics::fresnel_reflection(0.0, 1.0, n)(0, 0), 1.0, exact);
        // Brewster: tan theta = n; the reflected light is wholly s polarized.
        const optics::Mueller brewster = optics::fresnel_reflection(1.0 / std::sqrt(1 + n * n), 1.0, n);
        comparison.add(1, brewster(1, 0) / brewster(0, 0), -1.0, exact);
        // Born & Wolf (1999), eq. 1.5.63: tan(delta/2) = cos sqrt(sin^2 - 1/n^2)/sin^2 from the dense side.
        for (const double theta_deg : {55.0, 70.0, 85.0}) {
            const double c = std::cos(radians(theta_deg)), s2 = 1 - c * c;
            if (s2 * n * n <= 1.0) continue;
            const optics::Mueller total = optics::fresnel_reflection(c, n, 1.0);
            const double delta = 2 * std::atan(c * std::sqrt(s2 - 1 / (n * n)) / s2);
            comparison.add(2, std::abs(std::atan2(total(2, 3), total(2, 2))), delta, 1e-13);
            comparison.add(0, total(0, 0), 1.0, exact);
        }
        for (const double mu : {0.1, 0.5, 0.9})
            comparison.add(
                3, optics::fresnel_reflection(mu, 1.0, n)(0, 0) + optics::fresnel_transmission(mu, 1.0, n)(0, 0), 1.0,
                exact);
    }
}

// An absorbing coat of index n on a Lambertian base: light crosses it by Beer-Lambert, and bounces between base and
// interface with the diffuse factor K = 2 int R_inside exp(-2 tau/mu) mu dmu.
rt::Problem absorbing_coat() {
    return {1.0, {{0.3, 0.0, scalar_expansion({0.0, 0.0}), 1.5}}, rt::LambertianBase{0.6}};
}

double coat_brdf(double mu_i, double mu_o) {
    const double n = 1.5, tau = 0.3, reflectance = 0.6, critical = std::sqrt(1 - 1 / (n * n));
    double returned = 0.0;
    // The substitution mu = critical + (1 - critical) s^2 takes the root of Fresnel's coefficients at the critical
    // angle away.
    for (const math::Quadrature rule = math::gauss_legendre(200, 0.0, 1.0); const int k : {0, 1}) {
        for (int i = 0; i < rule.size(); ++i) {
            const double s = rule.nodes[i];
            const double mu = k == 0 ? critical * s : critical + (1 - critical) * s * s;
            const double jacobian = k == 0 ? critical : 2 * (1 - critical) * s;
            returned += 2 * rule.weights[i] * jacobian * mu * optics::fresnel_reflection(mu, n, 1.0)(0, 0) *
                        std::exp(-2 * tau / mu);
        }
    }
    const auto crossing = [&](double mu) {
        return optics::fresnel_transmission(mu, 1.0, n)(0, 0) * std::exp(-tau / optics::refracted_cosine(mu, 1.0, n));
    };
    return crossing(mu_i) * crossing(mu_o) * reflectance / (pi * n * n * (1 - reflectance * returned));
}

void run_coat(const rt::Solver* solver, Comparison& comparison) {
    for (const double mu_i : {1.0, 0.6, 0.2}) {
        std::vector<RadianceValue> values;
        for (const double mu_o : {1.0, 0.7, 0.3, 0.1})
            values.push_back({0.0, true, mu_o, 30.0, 0, coat_brdf(mu_i, mu_o), 1e-6});
        compare_field(*solver, absorbing_coat(), mu_i, 1 / (pi * mu_i), {.streams = 32, .samples = 200'000}, values,
                      comparison);
    }
}

// Prahl's adding-doubling of a Henyey-Greenstein slab, g = 0.9, index 1.4, between air and slides of glass.
struct SlabRow {
    double albedo, optical_thickness;
    bool slide_above, slide_below;
    double reflectance;
};
constexpr SlabRow slab_rows[] = {{0.5, 1.0, false, false, 0.03859},
                                 {0.5, 1.0, true, true, 0.05563},
                                 {0.5, infinite, true, false, 0.04255},
                                 {0.0, infinite, true, false, 0.04110}};

// Media around the scattering layer are layers that scatter nothing. Glass absorbs a trace: between two media of lower
// index light could run for ever in it.
rt::Problem slab(const SlabRow& row) {
    const optics::ExpansionCoefficients none = scalar_expansion({0.0, 0.0});
    const rt::Layer scattering{row.optical_thickness, row.albedo, henyey_greenstein(0.9, 100), 1.4},
        glass{1e-7, 0.0, none, 1.5}, air{0.0, 0.0, none, 1.0};
    rt::Problem problem{1.0, {}, rt::BlackBase{}};
    if (row.slide_above) problem.layers.push_back(glass);
    problem.layers.push_back(scattering);
    if (row.optical_thickness == infinite) return problem;
    if (row.slide_below) problem.layers.push_back(glass);
    problem.layers.push_back(air);
    return problem;
}

// Plane albedo for one incidence, specular parts included: the solver's field integrated over the hemisphere.
struct PlaneAlbedo {
    double value, statistical;  // five standard errors; those of the directions are correlated, so they are added
};
PlaneAlbedo plane_albedo(const rt::Solver& solver, const rt::Problem& problem, double mu_i,
                         const rt::SolveOptions& options) {
    const math::Quadrature rule = math::gauss_legendre(24, 0.0, 1.0);
    // The mean over azimuths: of eight, exact up to order 7; higher ones of these laws are none or, at normal
    // incidence, not there.
    rt::FieldRequest request{.mu_i = mu_i, .optical_depths = {0.0}, .mu_o = rule.nodes, .phi = {}};
    const int azimuths = mu_i == 1.0 ? 1 : 8;
    for (int k = 0; k < azimuths; ++k) request.phi.push_back(pi * (k + 0.5) / azimuths);
    const rt::Field field = solver.field(problem, request, options);
    PlaneAlbedo albedo{(rt::specular_surface(problem, mu_i) + rt::specular_coherent(problem, mu_i))(0, 0), 0.0};
    for (int i = 0; i < rule.size(); ++i)
        for (int k = 0; k < azimuths; ++k) {
            const double weight = 2 * rule.weights[i] * rule.nodes[i] / (mu_i * azimuths);
            albedo.value += weight * field.upward[0][i][k][0];
            if (solver.is_statistical()) albedo.statistical += 5 * weight * field.upward_error[0][i][k][0];
        }
    return albedo;
}

// Total reflectance at normal incidence.
void run_slab(const rt::Solver* solver, Comparison& comparison) {
    for (const SlabRow& row : slab_rows) {
        const PlaneAlbedo albedo =
            plane_albedo(*solver, slab(row), 1.0, {.streams = 32, .scalar = true, .samples = 4'000});
        comparison.add(0, albedo.value, row.reflectance, (row.albedo > 0.0 ? 1e-3 : 1e-5) + albedo.statistical);
    }
}

// All light comes back from a deep layer that absorbs nothing.
rt::Problem half_space(double index) {
    return {1.0, {{infinite, 1.0, henyey_greenstein(0.5, 16), index}}, rt::BlackBase{}};
}
rt::Problem white_stack() {
    return {1.0,
            {{3.0, 1.0, henyey_greenstein(0.5, 16), 1.5}, {7.0, 1.0, henyey_greenstein(0.2, 8), 1.7}},
            rt::LambertianBase{1.0}};
}

// Plane albedo at every node, with what the interfaces reflect unscattered; of random walks at two incidences.
void add_albedos(const rt::Solver& solver, const rt::Problem& problem, Comparison& comparison) {
    if (solver.is_statistical()) {
        for (const double mu_i : {0.3, 1.0}) {
            const PlaneAlbedo albedo = plane_albedo(solver, problem, mu_i, {.samples = 1'500});
            comparison.add(0, albedo.value, 1.0, albedo.statistical);
        }
        return;
    }
    const rt::Reflection reflection = solver.reflection(problem, {.streams = 16});
    const Eigen::MatrixXd& mean = reflection.modes.front();
    for (std::size_t i = 0; i < reflection.mu.size(); ++i) {
        double albedo =
            (rt::specular_surface(problem, reflection.mu[i]) + rt::specular_coherent(problem, reflection.mu[i]))(0, 0);
        for (std::size_t o = 0; o < reflection.mu.size(); ++o)
            albedo += 2 * pi * reflection.weights[o] * reflection.mu[o] * mean(4 * o, 4 * i);
        comparison.add(0, albedo, 1.0, 1e-10);
    }
}

}  // namespace

std::vector<Benchmark> interface_benchmarks() {
    std::vector<Benchmark> result;
    result.push_back({"Fresnel's formulas",
                      "Born & Wolf (1999), Principles of Optics, section 1.5",
                      "normal and grazing incidence, Brewster's angle, total reflection",
                      "1e-14 (phase 1e-13): rounding",
                      {},
                      run_fresnel,
                      {"R", "Q/I", "phase", "energy"}});
    result.push_back({"Absorbing coat on a Lambertian base",
                      "Beer-Lambert and Fresnel in closed form, internal reflections summed",
                      "BRDF, coat of index 1.5 and optical thickness 0.3",
                      "1e-6: the quadrature of 32 streams at the critical angle",
                      {absorbing_coat()},
                      run_coat});
    result.push_back(
        {"Slab between air and glass",
         "adding-doubling of S. A. Prahl (IAD; Prahl, van Gemert & Welch 1993, Appl. Opt. 32, 559)",
         "total reflectance at normal incidence, Henyey-Greenstein g = 0.9, unpolarized Fresnel, scalar",
         "1e-3: the few quadrature points and truncated forward peak of the reference; 1e-5 where nothing scatters",
         {slab(slab_rows[0])},
         run_slab});
    result.push_back({"Conservative half-space",
                      "plane albedo is exactly 1 (van de Hulst 1980, chapter 5)",
                      "plane albedo at every node, index matched and under an interface",
                      "1e-10: rounding grown by the doublings",
                      {half_space(1.0), half_space(1.5)},
                      [](const rt::Solver* solver, Comparison& comparison) {
                          for (const double index : {1.0, 1.5}) add_albedos(*solver, half_space(index), comparison);
                      }});
    result.back().too_long_for_random_walks = "walks in a conservative half-space have no mean length";
    result.push_back(
        {"White furnace",
         "two conservative layers of different index on a white base return all light",
         "plane albedo at every node",
         "1e-10: rounding",
         {white_stack()},
         [](const rt::Solver* solver, Comparison& comparison) { add_albedos(*solver, white_stack(), comparison); }});
    return result;
}

}  // namespace patina::jobs::validation
