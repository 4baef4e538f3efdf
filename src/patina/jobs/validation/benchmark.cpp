#include "patina/jobs/validation/benchmark.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"

namespace patina::jobs::validation {

void Comparison::add(int component, double computed, double published, double allowed) {
    const double difference = std::abs(computed - published);
    ++count_;
    largest_[component] = std::max(largest_[component], difference);
    // Written so that a NaN fails.
    worst_ = difference <= worst_ * allowed ? worst_ : (allowed > 0.0 ? difference / allowed : HUGE_VAL);
}

std::vector<Benchmark> benchmarks() {
    std::vector<Benchmark> all;
    for (auto part : {siewert_benchmarks, rayleigh_benchmarks, paint_slab_benchmarks, scalar_benchmarks,
                      interface_benchmarks, single_scattering_benchmarks})
        for (Benchmark& benchmark : part()) all.push_back(std::move(benchmark));
    return all;
}

namespace {

std::vector<double> sorted_unique(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

std::size_t place(const std::vector<double>& axis, double value) {
    return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), value) - axis.begin());
}

}  // namespace

void compare_field(const rt::Solver& solver, const rt::Problem& problem, double mu_i, double factor,
                   const rt::SolveOptions& options, const std::vector<RadianceValue>& all_values,
                   Comparison& comparison) {
    // A horizontal view sees no finite part of a layer, where a random walk could be scored.
    std::vector<RadianceValue> values = all_values;
    if (solver.is_statistical()) std::erase_if(values, [](const RadianceValue& value) { return value.mu_o == 0.0; });

    // Ask for the product of all depths and directions that occur.
    std::vector<double> depths, mu_o, phi_deg;
    for (const RadianceValue& value : values) {
        depths.push_back(value.optical_depth);
        mu_o.push_back(value.mu_o);
        phi_deg.push_back(value.phi_deg);
    }
    depths = sorted_unique(depths);
    mu_o = sorted_unique(mu_o);
    phi_deg = sorted_unique(phi_deg);
    rt::FieldRequest request{.mu_i = mu_i, .optical_depths = depths, .mu_o = mu_o};
    for (const double angle_deg : phi_deg) request.phi.push_back(radians(angle_deg));
    const rt::Field field = solver.field(problem, request, options);

    for (const RadianceValue& value : values) {
        const std::size_t d = place(depths, value.optical_depth), o = place(mu_o, value.mu_o),
                          p = place(phi_deg, value.phi_deg);
        const double computed = (value.upward ? field.upward : field.downward)[d][o][p][value.component];
        const auto& errors = value.upward ? field.upward_error : field.downward_error;
        const double statistical = errors.empty() ? 0.0 : 5.0 * factor * errors[d][o][p][value.component];
        comparison.add(value.component, factor * computed, value.published, value.allowed + statistical);
    }
}

optics::ExpansionCoefficients scalar_expansion(const std::vector<double>& alpha1_from_1) {
    optics::ExpansionCoefficients x;
    x.alpha1 = {1.0};
    x.alpha1.insert(x.alpha1.end(), alpha1_from_1.begin(), alpha1_from_1.end());
    x.alpha2 = x.alpha3 = x.alpha4 = x.beta1 = x.beta2 = std::vector<double>(x.alpha1.size(), 0.0);
    return x;
}

optics::ExpansionCoefficients henyey_greenstein(double asymmetry, int order) {
    std::vector<double> alpha1;
    for (int l = 1; l <= order; ++l) alpha1.push_back((2 * l + 1) * std::pow(asymmetry, l));
    return scalar_expansion(alpha1);
}

}  // namespace patina::jobs::validation
