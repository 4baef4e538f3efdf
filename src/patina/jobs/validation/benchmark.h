#pragma once
// A published (or closed-form) case: what is computed, against which numbers, and how far it may be off.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "patina/rt/solver.h"

namespace patina::jobs::validation {

// Computed against published values, collected by component.
class Comparison {
  public:
    void add(int component, double computed, double published, double allowed);

    int count() const { return count_; }
    // Largest absolute difference of each component; negative where nothing was compared.
    const std::array<double, 4>& largest() const { return largest_; }
    // Largest difference in units of what is allowed for that value; above 1 fails.
    double worst() const { return worst_; }

  private:
    int count_ = 0;
    std::array<double, 4> largest_{-1, -1, -1, -1};
    double worst_ = 0.0;
};

struct Benchmark {
    std::string name, source;
    std::string quantity;               // what is compared
    std::string tolerance;              // how far it may be off, and why
    std::vector<rt::Problem> problems;  // a solver must support all; empty: no solver takes part
    // Compares; the solver is null when none takes part.
    std::function<void(const rt::Solver*, Comparison&)> run;
    std::array<std::string, 4> components{"I", "Q", "U", "V"};
    std::string too_long_for_random_walks;  // why statistical solvers leave it out; empty: they take part
};

// Every benchmark, in the order of the report. One function a file of this folder.
std::vector<Benchmark> benchmarks();
std::vector<Benchmark> siewert_benchmarks();
std::vector<Benchmark> rayleigh_benchmarks();
std::vector<Benchmark> scalar_benchmarks();
std::vector<Benchmark> interface_benchmarks();
std::vector<Benchmark> paint_slab_benchmarks();
std::vector<Benchmark> single_scattering_benchmarks();

// A Stokes component of the radiance as published, and the difference allowed.
struct RadianceValue {
    double optical_depth;
    bool upward;
    double mu_o, phi_deg;
    int component;
    double published, allowed;
};

// Adds the comparison of `factor` times the solver's field for unpolarized light at cosine mu_i. A statistical solver
// is allowed 5 of its standard errors more (one of 10^6 values is that far off).
void compare_field(const rt::Solver& solver, const rt::Problem& problem, double mu_i, double factor,
                   const rt::SolveOptions& options, const std::vector<RadianceValue>& values, Comparison& comparison);

// Coefficients of scattering that knows no polarization: alpha1 = 1, then the given ones.
optics::ExpansionCoefficients scalar_expansion(const std::vector<double>& alpha1_from_1);
optics::ExpansionCoefficients henyey_greenstein(double asymmetry, int order);

}  // namespace patina::jobs::validation
