#include "patina/jobs/validate.h"

#include <algorithm>
#include <chrono>

#include "patina/core/error.h"
#include "patina/jobs/validation/benchmark.h"
#include "patina/jobs/validation/siewert.h"
#include "patina/rt/solver.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

using validation::Benchmark;

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
    std::vector<const rt::Solver*> solvers;
    if (!request.solver.empty())
        solvers.push_back(&rt::solver_named(request.solver));
    else
        for (const auto& solver : rt::solvers()) solvers.push_back(solver.get());

    // Run each benchmark with each solver; those without a solver once.
    ValidationReport report{std::string("patina ") + PATINA_VERSION, {}, {}};
    const std::vector<Benchmark> benchmarks = validation::benchmarks();
    const std::int64_t total = std::ssize(benchmarks) * std::ssize(solvers);
    std::int64_t done = 0;
    for (const Benchmark& benchmark : benchmarks) {
        for (const rt::Solver* solver : solvers) {
            if (control.stop_requested()) throw Error(ErrorKind::interrupted, "stopped before all benchmarks were run");
            if (!benchmark.problems.empty() || solver == solvers.front())
                report.cases.push_back(run(benchmark, benchmark.problems.empty() ? nullptr : solver));
            control.report({"validating", ++done, total, benchmark.name});
        }
    }
    for (const validation::PolarizationRow& row : validation::cost_of_ignoring_polarization(*rt::solvers().front()))
        report.cost_of_ignoring_polarization.push_back(
            {row.zenith_deg, row.phi_deg, row.published, row.vector, row.scalar});
    return report;
}

}  // namespace patina::jobs
