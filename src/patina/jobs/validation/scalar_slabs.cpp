// Scalar slabs without interfaces: van de Hulst and the test problems of DISORT.

#include <cmath>
#include <span>

#include <fmt/format.h>

#include "patina/jobs/validation/benchmark.h"
#include "patina/jobs/validation/disort_data.h"

namespace patina::jobs::validation {

namespace {

// R or T at mu_o = 0.5 for light at mu_i: van de Hulst (1980), table 12, albedo 0.8, optical thickness 2.
struct HulstRow {
    bool reflection;
    double mu_i, value;
};
constexpr HulstRow hulst_rows[] = {{true, 1.0, 0.28616},  {true, 0.9, 0.30277},  {true, 0.7, 0.34188},
                                   {true, 0.5, 0.39102},  {true, 0.3, 0.45353},  {true, 0.1, 0.53214},
                                   {false, 1.0, 0.14864}, {false, 0.9, 0.14731}, {false, 0.7, 0.13963},
                                   {false, 0.3, 0.09425}, {false, 0.1, 0.06601}};

rt::Problem hulst_slab() {
    return {1.0, {{2.0, 0.8, scalar_expansion({0.0, 0.0}), 1.0}}, rt::BlackBase{}};
}

// I = R mu_i for a beam of flux pi through a plane normal to it.
void run_hulst(const rt::Solver* solver, Comparison& comparison) {
    for (const HulstRow& row : hulst_rows)
        compare_field(*solver, hulst_slab(), row.mu_i, 1.0 / row.mu_i,
                      {.streams = 24, .scalar = true, .samples = 200'000},
                      {{row.reflection ? 0.0 : 2.0, row.reflection, 0.5, 0.0, 0, row.value, 1e-5}}, comparison);
}

optics::ExpansionCoefficients law_of(disort::Law law) {
    const auto listed = [](std::span<const double> coefficients) {
        return scalar_expansion(std::vector<double>(coefficients.begin(), coefficients.end()));
    };
    switch (law) {
        case disort::Law::isotropic:
            return scalar_expansion({0.0, 0.0});
        case disort::Law::rayleigh:
            return scalar_expansion({0.0, 0.5});
        case disort::Law::henyey_greenstein:
            return henyey_greenstein(0.75, 80);
        case disort::Law::haze_l:
            return listed(disort::haze_l);
        case disort::Law::cloud_c1:
            return listed(disort::cloud_c1);
    }
    return {};
}

rt::Problem disort_slab(const disort::TestCase& test) {
    return {1.0, {{test.optical_thickness, test.single_scattering_albedo, law_of(test.law), 1.0}}, rt::BlackBase{}};
}

// The reference of tests 1 and 2 has 8 streams a hemisphere, and so have we. In tests 3 to 5 it truncates the forward
// peak (delta-M) and corrects single scattering: up to 1 % is left near the surface, more along the beam, nothing deep
// inside.
bool has_forward_peak(disort::Law law) {
    return law != disort::Law::isotropic && law != disort::Law::rayleigh;
}

double allowed_share(const disort::TestCase& test, const disort::Radiance& row) {
    if (!has_forward_peak(test.law)) return 5e-6;
    if (row.optical_depth >= 32.0 && row.optical_depth < test.optical_thickness) return 1e-5;
    return row.mu_o == test.mu_i ? 0.1 : 0.01;
}

void run_disort(const rt::Solver* solver, const disort::TestCase& test, Comparison& comparison) {
    std::vector<RadianceValue> values;
    for (const disort::Radiance& row : test.radiances)
        if (row.value > 1e-12)  // below, the reference holds rounding
            values.push_back({row.optical_depth, row.upward, row.mu_o, row.phi_deg, 0, row.value,
                              allowed_share(test, row) * row.value});
    const int streams = test.law == disort::Law::cloud_c1 ? 152 : has_forward_peak(test.law) ? 48 : 8;
    // A random walk takes steps in proportion to the thickness, and scores at each in every direction.
    const auto samples =
        static_cast<std::int64_t>(2e6 / (static_cast<double>(values.size()) * std::max(1.0, test.optical_thickness)));
    compare_field(*solver, disort_slab(test), test.mu_i, test.flux,
                  {.streams = streams, .scalar = true, .samples = samples}, values, comparison);
}

const char* published_in(disort::Law law) {
    switch (law) {
        case disort::Law::isotropic:
            return "isotropic scattering: van de Hulst (1980), Multiple Light Scattering, table 12";
        case disort::Law::rayleigh:
            return "Rayleigh's phase function: Sweigart (1970), Astrophys. J. Suppl. 22, 1";
        case disort::Law::henyey_greenstein:
            return "Henyey-Greenstein, g = 0.75: van de Hulst (1980), table 37";
        case disort::Law::haze_l:
            return "haze L: Garcia & Siewert (1985), Transp. Theory Stat. Phys. 14, 437, tables 12-16";
        case disort::Law::cloud_c1:
            return "cloud C.1: Garcia & Siewert (1985), tables 19-20";
    }
    return "";
}

}  // namespace

std::vector<Benchmark> scalar_benchmarks() {
    std::vector<Benchmark> result;
    result.push_back({"van de Hulst, isotropic slab",
                      "van de Hulst (1980), Multiple Light Scattering, table 12",
                      "scalar reflection and transmission functions, albedo 0.8, optical thickness 2",
                      "1e-5: one unit of the last digit",
                      {hulst_slab()},
                      run_hulst});
    for (const disort::TestCase& test : disort::test_cases()) {
        Benchmark benchmark{fmt::format("DISORT {}", test.name),
                            published_in(test.law),
                            fmt::format("scalar radiances, optical thickness {:g}, albedo {:g}", test.optical_thickness,
                                        test.single_scattering_albedo),
                            has_forward_peak(test.law)
                                ? "1 % (10 % along the beam) near the surface, where the reference's truncated forward "
                                  "peak shows; 1e-5 deep inside"
                                : "5e-6 of each value: six printed digits, of the same 8 streams",
                            {disort_slab(test)},
                            {}};
        benchmark.run = [&test](const rt::Solver* solver, Comparison& comparison) {
            run_disort(solver, test, comparison);
        };
        // A score is the law towards the view: of this peak a few huge ones, whose scatter no error bar tells.
        if (test.law == disort::Law::cloud_c1)
            benchmark.too_long_for_random_walks = "64 depths of a sharp forward peak: too few walks for an error bar";
        result.push_back(std::move(benchmark));
    }
    return result;
}

}  // namespace patina::jobs::validation
