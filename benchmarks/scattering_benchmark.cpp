// Cost of single scattering: one sphere, and the size average of a pigment at one wavelength.

#include <benchmark/benchmark.h>

#include "patina/optics/scattering/mie.h"
#include "patina/optics/scattering/particle_ensemble.h"

namespace {

using namespace patina::optics;

void mie_sphere(benchmark::State& state) {
    const double x = static_cast<double>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(MieSphere(x, {1.84, 0.0}).extinction_efficiency());
}
BENCHMARK(mie_sphere)->Arg(1)->Arg(3)->Arg(10)->Arg(100)->Arg(10000);

void mie_absorbing_sphere(benchmark::State& state) {
    const double x = static_cast<double>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(MieSphere(x, {2.13, 0.32}).extinction_efficiency());
}
BENCHMARK(mie_absorbing_sphere)->Arg(1)->Arg(3)->Arg(10)->Arg(100)->Arg(10000);

// Median radius in nm, tolerance as a power of ten.
void log_normal_titania(benchmark::State& state) {
    const SizeDistribution size{LogNormal{1e-3 * static_cast<double>(state.range(0)), 1.3}};
    const ScatteringOptions options{.tolerance = std::pow(10.0, -static_cast<double>(state.range(1)))};
    ScatteringProperties p;
    for (auto _ : state) p = scatter(2.75, 1.495, 550, size, options);
    state.counters["radii"] = p.radii;
    state.counters["order"] = p.expansion.order();
}
BENCHMARK(log_normal_titania)->ArgsProduct({{50, 125, 200}, {3, 4, 5}})->Unit(benchmark::kMicrosecond);

void log_normal_hematite(benchmark::State& state) {
    const SizeDistribution size{LogNormal{0.125, 1.3}};
    for (auto _ : state)
        benchmark::DoNotOptimize(scatter({3.19, 0.48}, 1.495, 550, size, {.tolerance = 1e-4}).extinction_um2);
}
BENCHMARK(log_normal_hematite)->Unit(benchmark::kMicrosecond);

}  // namespace
