#include "patina/core/error.h"
#include "patina/rt/solver.h"
#include "patina/rt/solvers/doubling.h"
#include "patina/rt/solvers/eigenmodes.h"
#include "patina/rt/solvers/monte_carlo.h"

namespace patina::rt {

const std::vector<std::unique_ptr<Solver>>& solvers() {
    static const auto list = [] {
        std::vector<std::unique_ptr<Solver>> all;
        all.push_back(std::make_unique<Doubling>());
        all.push_back(std::make_unique<Eigenmodes>());
        all.push_back(make_monte_carlo_solver());
        return all;
    }();
    return list;
}

const Solver& solver_named(std::string_view name) {
    std::vector<std::string> names;
    for (const auto& solver : solvers()) {
        if (solver->name() == name) return *solver;
        names.emplace_back(solver->name());
    }
    throw Error(ErrorKind::usage, "unknown solver \"" + std::string(name) + "\"; " + did_you_mean(name, names));
}

}  // namespace patina::rt
