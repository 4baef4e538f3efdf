#include "patina/jobs/solve.h"

#include <atomic>
#include <functional>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/jobs/checkpoint.h"
#include "patina/jobs/solve_checkpoint.h"
#include "patina/jobs/stream_choice.h"
#include "patina/jobs/unit_progress.h"
#include "patina/jobs/wavelength_choice.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

using coating::OpticalProblem;

void check_wavelengths(const std::vector<double>& wavelengths_nm) {
    for (size_t i = 0; i < wavelengths_nm.size(); ++i) {
        const double wavelength = wavelengths_nm[i];
        if (!(wavelength >= 100.0 && wavelength <= 1e6))
            throw Error(ErrorKind::usage,
                        fmt::format("a wavelength of {:g} nm (100 nm to 1 mm make sense)", wavelength));
        if (i > 0 && wavelength <= wavelengths_nm[i - 1])
            throw Error(ErrorKind::usage, fmt::format("wavelengths must ascend ({:g} nm follows {:g} nm)", wavelength,
                                                      wavelengths_nm[i - 1]));
    }
}

WavelengthChoice chosen_wavelengths(const coating::Recipe& recipe, const SolveRequest& request,
                                    const JobControl& control) {
    check_wavelengths(request.wavelengths_nm);
    if (!request.wavelengths_nm.empty()) return {request.wavelengths_nm};
    if (recipe.is_wavelength_independent()) return {{550.0}};
    if (request.automatic_range_nm) {
        const auto [from, to] = *request.automatic_range_nm;
        check_wavelengths({from, to});
        return choose_wavelengths(recipe, from, to, request.tolerance, control);
    }
    std::vector<double> visible;
    for (int wavelength = 380; wavelength <= 780; wavelength += 5) visible.push_back(wavelength);
    return {visible};
}

// Relative accuracy asked of cross sections and expansion coefficients, and the largest share of f00 that it was seen
// to leave in the BRDF (1.6, narrow resonances of a coarse pigment), doubled.
double scattering_tolerance(const SolveRequest& request) {
    return std::clamp(0.01 * request.tolerance, 1e-7, 1e-4);
}
constexpr double scattering_amplification = 3.2;

// Share of the tolerance left to the streams.
constexpr double stream_share = 0.96;

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

// A solver whose values scatter has no streams to choose, and its error is no difference of two solutions.
bool is_statistical(const rt::Solver& solver) {
    return solver.name() == "montecarlo";
}

// Share of the largest element at which Fourier series stop.
double fourier_tolerance(const SolveRequest& request) {
    return std::clamp(1e-2 * request.tolerance, 1e-10, 1e-5);
}

// The wavelengths to choose streams at: both ends, the middle, and the one whose phase function has most orders.
std::vector<size_t> pilot_wavelengths(const std::vector<OpticalProblem>& problems) {
    size_t widest = 0;
    for (size_t w = 0; w < problems.size(); ++w)
        if (problems[w].problem.order() > problems[widest].problem.order()) widest = w;
    const std::set<size_t> pilots{0, problems.size() / 2, problems.size() - 1, widest};
    return {pilots.begin(), pilots.end()};
}

void check_streams(int streams) {
    if (streams != 0 && (streams < 2 || streams > 512))
        throw Error(ErrorKind::usage, fmt::format("--streams {}: 2 to 512 make sense", streams));
}

SolvePlan make_plan(const std::vector<double>& wavelengths_nm, const std::vector<OpticalProblem>& problems) {
    SolvePlan plan{wavelengths_nm, {}, 0, 0, {}, {}};
    std::set<std::string> notes, citations;
    for (const OpticalProblem& optical : problems) {
        plan.largest_expansion_order = std::max(plan.largest_expansion_order, optical.problem.order());
        notes.insert(optical.notes.begin(), optical.notes.end());
        citations.insert(optical.citations.begin(), optical.citations.end());
    }
    plan.citations.assign(citations.begin(), citations.end());
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
    if (!table.error_estimate.empty()) filter(table.error_estimate);
    filter(table.once_scattered);
    if (std::ranges::all_of(table.once_scattered, [](const auto& layers) { return layers.empty(); }))
        table.once_scattered.clear();
}

brdf::Provenance provenance(const coating::Recipe& recipe, const SolveRequest& request, const SolvePlan& plan) {
    brdf::Provenance p{request.command, recipe.text, recipe.path, std::string("patina ") + PATINA_VERSION,
                       request.solver,  {}};
    for (size_t i = 0; i < plan.notes.size(); ++i) p.notes[fmt::format("note_{:02}", i)] = plan.notes[i];
    for (size_t i = 0; i < plan.citations.size(); ++i) p.notes[fmt::format("material_{:02}", i)] = plan.citations[i];
    p.notes["streams"] = std::to_string(plan.streams);
    p.notes["tolerance"] = fmt::format("{:g}", request.tolerance);
    p.notes["error_estimate"] =
        fmt::format("upper bound of the error of any element of the body BRDF for zenith angles up to {:g} deg, 1/sr",
                    largest_judged_zenith_deg);
    return p;
}

// What the checkpoint's results depend on, in the order in which a difference is told.
Checkpoint::Identity identity(const coating::Recipe& recipe, const SolveRequest& request,
                              const std::vector<double>& wavelengths_nm, const std::vector<OpticalProblem>& problems) {
    std::vector<rt::Problem> of_transfer;
    for (const OpticalProblem& optical : problems) of_transfer.push_back(optical.problem);
    return {{"recipe", recipe.text},
            {"solver", request.solver},
            {"tolerance", fmt::format("{:g}", request.tolerance)},
            {"number of streams", request.streams == 0 ? "chosen" : std::to_string(request.streams)},
            {"list of wavelengths", fmt::format("{}", fmt::join(wavelengths_nm, ", "))},
            {"version of patina", PATINA_VERSION},
            {"set of optical constants", fingerprint_of(of_transfer)}};
}

std::unique_ptr<Checkpoint> open_checkpoint(const SolveRequest& request, const Checkpoint::Identity& identity) {
    if (request.checkpoint.empty()) return std::make_unique<Checkpoint>();
    return std::make_unique<Checkpoint>(request.checkpoint, identity, request.resume);
}

// One run of the table's wavelengths with a number of streams.
struct Run {
    int streams = 0;
    std::vector<rt::Reflection> reflections;
    std::vector<char> done;
    // Between the nodes, where the error is estimated: largest f00, and the difference from half the streams.
    std::vector<double> scale, difference_from_half;
    std::vector<brdf::MuellerGrid> pilots;  // of the pilot wavelengths
};

class Solving {
  public:
    Solving(const coating::Recipe& recipe, const SolveRequest& request, const JobControl& control)
        : request_(request),
          control_(control),
          solver_(rt::solver_named(request.solver)),
          wavelength_choice_(chosen_wavelengths(recipe, request, control)),
          wavelengths_nm_(wavelength_choice_.wavelengths_nm),
          problems_(set_up(recipe, wavelengths_nm_, request, control)),
          checkpoint_(open_checkpoint(request, identity(recipe, request, wavelengths_nm_, problems_))),
          references_(solver_, recipe, wavelengths_nm_, request.tolerance, scattering_tolerance(request),
                      fourier_tolerance(request), *checkpoint_),
          pilots_(pilot_wavelengths(problems_)) {
        check_streams(request.streams);
        for (const OpticalProblem& optical : problems_) {
            rt::validate(optical.problem);
            if (const std::string reason = solver_.unsupported(optical.problem); !reason.empty())
                throw Error(ErrorKind::input,
                            fmt::format("solver \"{}\" cannot do this recipe ({})", solver_.name(), reason));
        }
    }

    SolvePlan plan() {
        SolvePlan plan = make_plan(wavelengths_nm_, problems_);
        tell_wavelength_error(plan);
        plan.streams = request_.streams;
        if (plan.streams == 0)
            plan.streams = is_statistical(solver_)
                               ? 16
                               : choose_streams(references_, pilots_, stream_share * request_.tolerance, control_);
        return plan;
    }

    SolveResult run(const coating::Recipe& recipe);

  private:
    void tell_wavelength_error(SolvePlan& plan) const;
    Run solve_all(int streams);
    void solve_into(Run& run, size_t w, UnitProgress& progress);
    SolvedWavelength solve_one(size_t w, int streams, const std::function<void(double)>& progress);
    std::vector<brdf::OnceScattered> once_scattered(size_t w, int streams) const {
        return once_scattered_of(solver_, problems_[w].problem, streams, request_.tolerance);
    }
    // Upper bounds of the error at each wavelength, 1/sr.
    std::vector<double> estimate(const Run& run);
    double stream_error(const Run& run, size_t w);
    void prepare_references(const std::vector<size_t>& wavelengths, int streams) {
        references_.prepare(wavelengths, streams, control_, fmt::format("error, {} streams", streams));
    }
    bool within_tolerance(const Run& run, size_t w, double error) const {
        return error <= request_.tolerance * run.scale[w];
    }
    void fill(brdf::MuellerTable& table, Run& run) const;
    // Refractive index of the medium that the table's directions are in: one number, or one a wavelength.
    std::string medium_index(const std::vector<char>& done) const;

    const SolveRequest& request_;
    const JobControl& control_;
    const rt::Solver& solver_;
    WavelengthChoice wavelength_choice_;
    std::vector<double> wavelengths_nm_;
    std::vector<OpticalProblem> problems_;
    std::unique_ptr<Checkpoint> checkpoint_;
    References references_;
    std::vector<size_t> pilots_;
};

void Solving::tell_wavelength_error(SolvePlan& plan) const {
    if (!request_.automatic_range_nm || wavelengths_nm_.size() < 2) return;
    plan.wavelength_error = wavelength_choice_.interpolation_error;
    plan.notes.push_back(fmt::format(
        "{} wavelengths chosen: linear interpolation between them errs by at most {:.1e}{}", wavelengths_nm_.size(),
        wavelength_choice_.interpolation_error, wavelength_choice_.converged ? "" : ", more than the tolerance"));
}

Run Solving::solve_all(int streams) {
    const std::ptrdiff_t count = std::ssize(problems_);
    Run run{streams,
            std::vector<rt::Reflection>(count),
            std::vector<char>(count, 0),
            std::vector<double>(count),
            std::vector<double>(count),
            {}};
    run.pilots.resize(count);
    UnitProgress progress(control_, "solving", problems_.size());
    parallel_for(0, count, [&](std::ptrdiff_t w) {
        // A stop leaves the wavelength undone.
        try {
            if (!control_.stop_requested()) solve_into(run, w, progress);
        } catch (const Error& stop) {
            if (stop.kind() != ErrorKind::interrupted) throw;
        }
    });
    return run;
}

void Solving::solve_into(Run& run, size_t w, UnitProgress& progress) {
    const std::string at = fmt::format("{:g} nm", wavelengths_nm_[w]);
    SolvedWavelength solved = solve_one(w, run.streams, [&](double share) { progress.tell(w, 0.999 * share, at); });
    if (!is_statistical(solver_) && std::binary_search(pilots_.begin(), pilots_.end(), w))
        run.pilots[w] = between_nodes({solved.reflection, once_scattered(w, run.streams)});
    run.reflections[w] = std::move(solved.reflection);
    run.scale[w] = solved.scale;
    run.difference_from_half[w] = solved.difference_from_half;
    run.done[w] = 1;
    progress.tell(w, 1.0, at);
}

SolvedWavelength Solving::solve_one(size_t w, int streams, const std::function<void(double)>& progress) {
    const std::string key = fmt::format("table of {} streams at {} nm", streams, wavelengths_nm_[w]);
    if (const auto kept = checkpoint_->find(key))
        if (auto solved = to_solved_wavelength(*kept)) return std::move(*solved);
    const rt::Problem& problem = problems_[w].problem;
    rt::SolveOptions options{.streams = streams,
                             .fourier_tolerance = fourier_tolerance(request_),
                             .cancel = control_.cancel,
                             .progress = progress};
    BodySolution body = solve_body(solver_, problem, options, request_.tolerance);
    SolvedWavelength solved;
    if (!is_statistical(solver_)) {
        const brdf::MuellerGrid grid = between_nodes(body);
        options.streams = half_streams(streams);
        options.progress = {};
        solved.scale = intensity_scale(grid);
        solved.difference_from_half =
            largest_difference(grid, between_nodes(solve_body(solver_, problem, options, request_.tolerance)));
    }
    solved.reflection = std::move(body.reflection);
    checkpoint_->add(key, to_values(solved));
    return solved;
}

// The part of the error that more streams would take away, from solutions of finer single scattering.
double Solving::stream_error(const Run& run, size_t w) {
    const int finer = finer_streams(run.streams);
    prepare_references({w}, run.streams);
    prepare_references({w}, finer);
    return error_bound(run.difference_from_half[w],
                       largest_difference(references_.at(w, run.streams), references_.at(w, finer)));
}

// Compare the pilots with references of more streams. Elsewhere the difference from half the streams tells how the
// error varies with wavelength: its ratio to the error is taken from the neighbouring pilots, the less favourable of
// the two. What single scattering leaves is added in proportion to f00.
std::vector<double> Solving::estimate(const Run& run) {
    for (const int streams : {run.streams, finer_streams(run.streams)}) prepare_references(pilots_, streams);
    std::vector<double> error(problems_.size(), 0.0), ratio;
    double scattering_share = scattering_amplification * scattering_tolerance(request_);
    for (const size_t w : pilots_) {
        error[w] = stream_error(run, w);
        ratio.push_back(run.difference_from_half[w] > 0.0 ? error[w] / run.difference_from_half[w] : 0.0);
        if (run.scale[w] > 0.0)
            scattering_share =
                std::max(scattering_share,
                         2.0 * largest_difference(run.pilots[w], references_.at(w, run.streams)) / run.scale[w]);
    }
    for (size_t w = 0; w < problems_.size(); ++w) {
        const size_t above = std::lower_bound(pilots_.begin(), pilots_.end(), w) - pilots_.begin();
        const double scattering = scattering_share * run.scale[w];
        if (pilots_[above] != w) {
            error[w] = run.difference_from_half[w] * std::max(ratio[above - 1], ratio[above]);
            if (!within_tolerance(run, w, error[w] + scattering)) error[w] = stream_error(run, w);
        }
        error[w] += scattering;
    }
    return error;
}

void Solving::fill(brdf::MuellerTable& table, Run& run) const {
    table.wavelengths_nm = wavelengths_nm_;
    table.body.resize(problems_.size());
    table.specular_surface.resize(problems_.size());
    table.specular_coherent.resize(problems_.size());
    table.specular_theta_deg = specular_angles_deg();
    table.once_scattered.resize(problems_.size());
    const auto first = std::find(run.done.begin(), run.done.end(), 1) - run.done.begin();
    table.mu = run.reflections[first].mu;
    table.mu_weights = run.reflections[first].weights;
    for (size_t w = 0; w < problems_.size(); ++w) {
        table.body[w].modes = std::move(run.reflections[w].modes);
        if (run.done[w]) table.once_scattered[w] = once_scattered(w, run.streams);
        fill_specular(table, problems_[w].problem, w);
    }
    keep_only(table, run.done);
}

std::string Solving::medium_index(const std::vector<char>& done) const {
    std::vector<double> values;
    for (size_t w = 0; w < problems_.size(); ++w)
        if (done[w]) values.push_back(problems_[w].problem.refractive_index_above);
    if (std::count(values.begin(), values.end(), values.front()) == std::ssize(values)) values.resize(1);
    return fmt::format("{}", fmt::join(values, " "));
}

SolveResult Solving::run(const coating::Recipe& recipe) {
    SolveResult result;
    result.resumed = checkpoint_->found_at_start();
    result.plan = plan();
    int& streams = result.plan.streams;

    // Solve, and again with more streams while a wavelength's error is too large.
    Run run;
    std::vector<double> error;
    constexpr int most_attempts = 4;
    for (int attempt = 1;; ++attempt) {
        run = solve_all(streams);
        result.interrupted = std::find(run.done.begin(), run.done.end(), 0) != run.done.end();
        if (result.interrupted || is_statistical(solver_)) break;
        try {
            error = estimate(run);
        } catch (const Error& stop) {
            if (stop.kind() != ErrorKind::interrupted) throw;
            result.interrupted = true;
            break;
        }
        result.converged = true;
        for (size_t w = 0; w < error.size(); ++w) {
            result.converged = result.converged && within_tolerance(run, w, error[w]);
            if (run.scale[w] > 0.0) result.relative_error = std::max(result.relative_error, error[w] / run.scale[w]);
        }
        if (result.converged || request_.streams != 0 || streams >= most_streams || attempt == most_attempts) break;
        streams = std::min(most_streams, streams + std::max(2, streams / 4));
        result.relative_error = 0.0;
    }
    if (std::find(run.done.begin(), run.done.end(), 1) == run.done.end())
        throw Error(ErrorKind::interrupted, "stopped before anything was solved");

    if (!result.converged)
        result.plan.notes.push_back(
            fmt::format("the error is up to {:.1e} of the largest f00 with {} streams, above the tolerance of {:g}",
                        result.relative_error, streams, request_.tolerance));
    // Whoever sets the streams gets what was asked for, with its error.
    if (request_.streams != 0) result.converged = true;
    result.table.error_estimate = error;
    fill(result.table, run);
    result.table.provenance = provenance(recipe, request_, result.plan);
    result.table.provenance.notes[coating::medium_index_note] = medium_index(run.done);
    result.table.validate();
    return result;
}

}  // namespace

SolvePlan plan_solve(const coating::Recipe& recipe, const SolveRequest& request) {
    return Solving(recipe, request, {}).plan();
}

SolveResult solve(const coating::Recipe& recipe, const SolveRequest& request, const JobControl& control) {
    return Solving(recipe, request, control).run(recipe);
}

}  // namespace patina::jobs
