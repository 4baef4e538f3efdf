#include "patina/jobs/validate.h"

#include <algorithm>
#include <chrono>
#include <deque>

#include "patina/core/error.h"
#include "patina/jobs/validation/benchmark.h"
#include "patina/jobs/validation/siewert.h"
#include "patina/rt/solver.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

using validation::Benchmark;

// A solver that a stop interrupts, whoever asks it.
class Interruptible final : public rt::Solver {
  public:
    Interruptible(const rt::Solver& solver, const CancelToken* cancel) : solver_(solver), cancel_(cancel) {}

    std::string_view name() const override { return solver_.name(); }
    std::string_view summary() const override { return solver_.summary(); }
    bool is_statistical() const override { return solver_.is_statistical(); }
    std::string unsupported(const rt::Problem& problem) const override { return solver_.unsupported(problem); }
    rt::Reflection reflection(const rt::Problem& problem, const rt::SolveOptions& options) const override {
        return solver_.reflection(problem, with_cancel(options));
    }
    rt::Field field(const rt::Problem& problem, const rt::FieldRequest& request,
                    const rt::SolveOptions& options) const override {
        return solver_.field(problem, request, with_cancel(options));
    }

  private:
    rt::SolveOptions with_cancel(rt::SolveOptions options) const {
        options.cancel = cancel_;
        return options;
    }

    const rt::Solver& solver_;
    const CancelToken* cancel_;
};

// Reason for leaving a benchmark out for a solver; empty when it runs.
std::string reason_to_skip(const Benchmark& benchmark, const rt::Solver& solver) {
    for (const rt::Problem& problem : benchmark.problems)
        if (std::string reason = solver.unsupported(problem); !reason.empty()) return reason;
    if (solver.is_statistical()) return benchmark.too_long_for_random_walks;
    return {};
}

ValidatedCase run(const Benchmark& benchmark, const rt::Solver* solver) {
    ValidatedCase result{benchmark.name,      benchmark.source, benchmark.quantity, benchmark.tolerance, "",
                         benchmark.components};
    validation::Comparison comparison;
    if (solver) {
        result.solver = solver->name();
        result.skipped = reason_to_skip(benchmark, *solver);
    }
    const auto start = std::chrono::steady_clock::now();
    if (result.skipped.empty()) benchmark.run(solver, comparison);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.largest = comparison.largest();
    result.count = comparison.count();
    result.worst = comparison.worst();
    return result;
}

}  // namespace

bool ValidationReport::passed() const {
    return failures() == 0;
}

int ValidationReport::failures() const {
    return static_cast<int>(
        std::count_if(cases.begin(), cases.end(), [](const ValidatedCase& one) { return !one.passed(); }));
}

ValidationReport validate(const ValidateRequest& request, const JobControl& control) {
    std::deque<Interruptible> solvers;
    if (!request.solver.empty())
        solvers.emplace_back(rt::solver_named(request.solver), control.cancel);
    else
        for (const auto& solver : rt::solvers()) solvers.emplace_back(*solver, control.cancel);

    // Run each benchmark with each solver; those without a solver once.
    ValidationReport report{std::string("patina ") + PATINA_VERSION, {}, {}};
    const std::vector<Benchmark> benchmarks = validation::benchmarks();
    const std::int64_t total = std::ssize(benchmarks) * std::ssize(solvers);
    std::int64_t done = 0;
    for (const Benchmark& benchmark : benchmarks) {
        for (const Interruptible& solver : solvers) {
            stop_if_requested(control.cancel);
            if (!benchmark.problems.empty() || &solver == &solvers.front())
                report.cases.push_back(run(benchmark, benchmark.problems.empty() ? nullptr : &solver));
            control.report({"validating", ++done, total, benchmark.name});
        }
    }
    for (const validation::PolarizationRow& row : validation::cost_of_ignoring_polarization())
        report.cost_of_ignoring_polarization.push_back(
            {row.zenith_deg, row.phi_deg, row.published, row.vector, row.scalar});
    return report;
}

}  // namespace patina::jobs
