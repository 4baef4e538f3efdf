#include "patina/render/realizability.h"

#include "patina/brdf/physical_checks.h"

namespace patina::render {

namespace {

// The renderer's signs are the solver's with U reversed on both sides, which leaves the eigenvalues as they are.
template <class Matrices>
bool all_realizable(const Matrices& matrices, double tolerance) {
    for (int w = 0; w < wavelengths_per_path; ++w) {
        const optics::Mueller m = matrices.matrix(w);
        if (!m.allFinite() || brdf::coherency_eigenvalues(m)[0] < -tolerance * std::abs(m(0, 0))) return false;
    }
    return true;
}

}  // namespace

bool is_realizable(const ScatteringMatrix& event, double tolerance) {
    return all_realizable(event, tolerance);
}

bool is_realizable(const Throughput& path, double tolerance) {
    return all_realizable(path, tolerance);
}

bool extinguishes(const ScatteringMatrix& event, const Throughput& before, const Throughput& after) {
    constexpr double left = 1e-3;  // of what unpolarized light would keep: single precision's 1e-6 is 1e-3 of it
    for (int w = 0; w < wavelengths_per_path; ++w)
        if (after.matrix(w)(0, 0) < left * before.matrix(w)(0, 0) * event.matrix(w)(0, 0)) return true;
    return false;
}

}  // namespace patina::render
