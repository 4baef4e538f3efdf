#pragma once
// How many streams a table needs, found by solving a few wavelengths with growing numbers of them.

#include <map>
#include <string>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/core/progress.h"
#include "patina/jobs/checkpoint.h"
#include "patina/jobs/table_accuracy.h"
#include "patina/rt/solver.h"

namespace patina::jobs {

// Upper bound of the error of a table of N streams whose BRDF differs from that of half and of 1.5 times the streams by
// at most these amounts. Where the error falls like N^-p the second difference is 1 - 1.5^-p of it, a third for p = 1,
// the slowest seen (thin index-matched layers), and the ratio q of the differences shows p: 0.33, 0.19, 0.05 for p = 1,
// 2, 4. The bound 2 (1 + 4 q) times the second difference exceeds the error for every p, by half as much again for what
// lies between the judged directions.
double error_bound(double difference_from_half, double difference_from_finer);

inline constexpr int fewest_streams = 6, most_streams = 72;

// Reference solutions at a few wavelengths, each computed once.
class References {
  public:
    // `wavelengths_nm` are all of the table's; single scattering and Fourier series are ten times finer than the
    // table's. What is computed goes into `checkpoint`, and is taken from there when it was done before.
    References(const rt::Solver& solver, const coating::Recipe& recipe, const std::vector<double>& wavelengths_nm,
               double tolerance, double scattering_tolerance, double fourier_tolerance, Checkpoint& checkpoint);

    // The BRDF between nodes at wavelength w (a position) with exactly that many streams.
    const brdf::MuellerGrid& at(std::size_t w, int streams) const;
    // Computes those of several wavelengths in parallel; progress is told under the name of the stage, if any. Throws
    // Error(interrupted) when stopped; what was finished is in the checkpoint.
    void prepare(const std::vector<std::size_t>& wavelengths, int streams, const JobControl& control,
                 const std::string& stage = {});

  private:
    brdf::MuellerGrid solve(std::size_t w, rt::SolveOptions options) const;

    const rt::Solver& solver_;
    const coating::Recipe& recipe_;
    const std::vector<double>& wavelengths_nm_;
    double tolerance_, scattering_tolerance_, fourier_tolerance_;
    Checkpoint& checkpoint_;
    std::map<std::pair<std::size_t, int>, brdf::MuellerGrid> grids_;
};

// The streams a table of `streams` is judged against.
int finer_streams(int streams);
int half_streams(int streams);

// The fewest streams, up to most_streams, whose table is within `tolerance` times the largest f00 of the converged BRDF
// at the wavelengths given, by error_bound().
int choose_streams(References& references, const std::vector<std::size_t>& wavelengths, double tolerance,
                   const JobControl& control);

}  // namespace patina::jobs
