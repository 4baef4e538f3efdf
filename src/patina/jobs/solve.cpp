#include "patina/jobs/solve.h"

#include <atomic>
#include <set>

#include <fmt/format.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

using coating::OpticalProblem;

constexpr int fewest_streams = 12;
constexpr int most_streams = 128;

void check_wavelengths(const std::vector<double>& wavelengths_nm) {
    for (size_t i = 0; i < wavelengths_nm.size(); ++i) {
        const double wavelength = wavelengths_nm[i];
        if (!(wavelength >= 100.0 && wavelength <= 1e6))
            throw Error(ErrorKind::usage, fmt::format("a wavelength of {:g} nm (100 nm to 1 mm make sense)", wavelength));
        if (i > 0 && wavelength <= wavelengths_nm[i - 1])
            throw Error(ErrorKind::usage, fmt::format("wavelengths must ascend ({:g} nm follows {:g} nm)", wavelength, wavelengths_nm[i - 1]));
    }
}

std::vector<double> chosen_wavelengths(const coating::Recipe& recipe, const SolveRequest& request) {
    check_wavelengths(request.wavelengths_nm);
    if (!request.wavelengths_nm.empty()) return request.wavelengths_nm;
    if (recipe.is_wavelength_independent()) return {550.0};
    std::vector<double> visible;
    for (int wavelength = 380; wavelength <= 780; wavelength += 5) visible.push_back(wavelength);
    return visible;
}

// Relative accuracy asked of single scattering: a tenth of the table's, so that it never dominates.
double scattering_tolerance(const SolveRequest& request) { return std::clamp(0.1 * request.tolerance, 1e-7, 1e-3); }

std::vector<OpticalProblem> set_up(const coating::Recipe& recipe, const std::vector<double>& wavelengths_nm,
                                   const SolveRequest& request, const JobControl& control) {
    std::vector<OpticalProblem> problems(wavelengths_nm.size());
    std::atomic<int> done = 0;
    parallel_for(0, std::ssize(problems), [&](std::ptrdiff_t w) {
        if (control.stop_requested()) return;
        problems[w] = coating::optical_problem(recipe, wavelengths_nm[w], scattering_tolerance(request));
        control.report({"scattering", ++done, std::ssize(problems), fmt::format("{:g} nm", wavelengths_nm[w])});
    });
    if (control.stop_requested()) throw Error(ErrorKind::interrupted, "stopped before anything was solved");
    return problems;
}

int largest_order(const std::vector<OpticalProblem>& problems) {
    int order = 0;
    for (const OpticalProblem& optical : problems)
        for (const rt::Layer& layer : optical.problem.layers) order = std::max(order, layer.expansion.order());
    return order;
}

// Gauss nodes that integrate a phase function of order L exactly (degree 2N - 1 >= L) and two digits more a node.
int chosen_streams(const SolveRequest& request, int expansion_order) {
    if (request.streams != 0) {
        if (request.streams < 2 || request.streams > 512)
            throw Error(ErrorKind::usage, fmt::format("--streams {}: 2 to 512 make sense", request.streams));
        return request.streams;
    }
    const int for_phase_function = expansion_order / 2 + 2;
    const int for_tolerance = static_cast<int>(std::ceil(-4.0 * std::log10(request.tolerance)));
    return std::clamp(std::max(for_phase_function, for_tolerance), fewest_streams, most_streams);
}

SolvePlan make_plan(const std::vector<double>& wavelengths_nm, const std::vector<OpticalProblem>& problems, const SolveRequest& request) {
    SolvePlan plan{wavelengths_nm, 0, largest_order(problems), {}};
    plan.streams = chosen_streams(request, plan.largest_expansion_order);
    std::set<std::string> notes;
    for (const OpticalProblem& optical : problems) notes.insert(optical.notes.begin(), optical.notes.end());
    if (plan.streams == most_streams && request.streams == 0)
        notes.insert(fmt::format("the phase function has {} orders; streams are capped at {}", plan.largest_expansion_order, most_streams));
    plan.notes.assign(notes.begin(), notes.end());
    return plan;
}

// The specular parts on a fixed grid of angles, half a degree apart.
void fill_specular(brdf::MuellerTable& table, const rt::Problem& problem, size_t w) {
    for (const double theta_deg : table.specular_theta_deg) {
        const double mu = std::max(0.0, std::cos(radians(theta_deg)));
        table.specular_surface[w].push_back(rt::specular_surface(problem, mu));
        table.specular_coherent[w].push_back(rt::specular_coherent(problem, mu));
    }
}

void keep_only(brdf::MuellerTable& table, const std::vector<char>& keep) {
    const auto filter = [&](auto& values) {
        size_t kept = 0;
        for (size_t w = 0; w < keep.size(); ++w) {
            if (!keep[w]) continue;
            if (kept != w) values[kept] = std::move(values[w]);
            ++kept;
        }
        values.resize(kept);
    };
    filter(table.wavelengths_nm);
    filter(table.body);
    filter(table.specular_surface);
    filter(table.specular_coherent);
}

brdf::Provenance provenance(const coating::Recipe& recipe, const SolveRequest& request, const SolvePlan& plan) {
    brdf::Provenance p{request.command, recipe.text, recipe.path, std::string("patina ") + PATINA_VERSION, request.solver, {}};
    for (size_t i = 0; i < plan.notes.size(); ++i) p.notes[fmt::format("note_{:02}", i)] = plan.notes[i];
    p.notes["streams"] = std::to_string(plan.streams);
    p.notes["tolerance"] = fmt::format("{:g}", request.tolerance);
    return p;
}

}  // namespace

SolvePlan plan_solve(const coating::Recipe& recipe, const SolveRequest& request) {
    const std::vector<double> wavelengths = chosen_wavelengths(recipe, request);
    return make_plan(wavelengths, set_up(recipe, wavelengths, request, {}), request);
}

SolveResult solve(const coating::Recipe& recipe, const SolveRequest& request, const JobControl& control) {
    // Set up every wavelength's problem and choose one set of directions for all.
    const rt::Solver& solver = rt::solver_named(request.solver);
    const std::vector<double> wavelengths = chosen_wavelengths(recipe, request);
    const std::vector<OpticalProblem> problems = set_up(recipe, wavelengths, request, control);
    SolveResult result;
    result.plan = make_plan(wavelengths, problems, request);
    for (const OpticalProblem& optical : problems) {
        rt::validate(optical.problem);
        if (const std::string reason = solver.unsupported(optical.problem); !reason.empty())
            throw Error(ErrorKind::input, fmt::format("solver \"{}\" cannot do this recipe ({})", solver.name(), reason));
    }

    // Solve wavelength by wavelength.
    rt::SolveOptions options;
    options.streams = result.plan.streams;
    options.fourier_tolerance = std::min(1e-6, 1e-3 * request.tolerance);
    brdf::MuellerTable& table = result.table;
    const std::ptrdiff_t count = std::ssize(problems);
    table.wavelengths_nm = wavelengths;
    table.body.resize(count);
    table.specular_surface.resize(count);
    table.specular_coherent.resize(count);
    for (int i = 0; i <= 180; ++i) table.specular_theta_deg.push_back(0.5 * i);

    std::vector<rt::Reflection> reflections(count);
    std::vector<char> done(count, 0);
    std::atomic<int> finished = 0;
    parallel_for(0, count, [&](std::ptrdiff_t w) {
        if (control.stop_requested()) return;
        reflections[w] = solver.reflection(problems[w].problem, options);
        fill_specular(table, problems[w].problem, w);
        done[w] = 1;
        control.report({"solving", ++finished, count, fmt::format("{:g} nm", wavelengths[w])});
    });

    // Gather what is done into the table.
    const auto first = std::find(done.begin(), done.end(), 1);
    if (first == done.end()) throw Error(ErrorKind::interrupted, "stopped before anything was solved");
    table.mu = reflections[first - done.begin()].mu;
    table.mu_weights = reflections[first - done.begin()].weights;
    for (std::ptrdiff_t w = 0; w < count; ++w) {
        result.converged = result.converged && (!done[w] || reflections[w].diagnostics.converged);
        table.body[w].modes = std::move(reflections[w].modes);
    }
    result.interrupted = std::find(done.begin(), done.end(), 0) != done.end();
    keep_only(table, done);
    table.provenance = provenance(recipe, request, result.plan);
    table.validate();
    return result;
}

}  // namespace patina::jobs
