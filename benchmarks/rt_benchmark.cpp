// CPU time of the solvers on Siewert (2000), problem IIA: all incidences, four incident Stokes vectors, all Fourier
// orders. VLIDORT 2.8.3 needs 0.034 s (16 streams) and 0.25 s (32 streams) for one incidence and one column.

#include <cmath>

#include <benchmark/benchmark.h>

#include "patina/core/memory.h"
#include "patina/core/parallel.h"
#include "patina/jobs/validation/siewert2000_data.h"
#include "patina/rt/solver.h"

namespace {

using namespace patina;

rt::Problem problem(double index, rt::Base base) {
    rt::Layer layer{1.0, siewert2000::single_scattering_albedo, {}, index};
    for (const auto& row : siewert2000::coefficients) {
        layer.expansion.alpha2.push_back(row[0]);
        layer.expansion.alpha1.push_back(row[1]);
        layer.expansion.beta1.push_back(-row[2]);
        layer.expansion.alpha4.push_back(row[3]);
        layer.expansion.beta2.push_back(row[4]);
        layer.expansion.alpha3.push_back(row[5]);
    }
    return {1.0, {layer}, base};
}

void run(benchmark::State& state, const rt::Problem& what, const char* solver) {
    keep_freed_memory();  // as the program does
    set_thread_count(1);
    const rt::SolveOptions options{.streams = static_cast<int>(state.range(0))};
    for (auto _ : state) benchmark::DoNotOptimize(rt::solver_named(solver).reflection(what, options));
}

// One layer cut into `layers`, of `thickness` in all, over metal under an interface: the costs that docs/performance.md
// plots, one argument at a time (tools/solver_cost.py).
rt::Problem stack(double thickness, int layers) {
    rt::Problem what = problem(1.5, rt::MetalBase{{0.96, 6.69}});
    what.layers.front().optical_thickness = thickness / layers;
    what.layers.assign(layers, what.layers.front());
    return what;
}

void cost_streams(benchmark::State& state) {
    run(state, problem(1.0, rt::BlackBase{}), "doubling");
}
void cost_streams_eigenmodes(benchmark::State& state) {
    run(state, problem(1.0, rt::BlackBase{}), "eigenmodes");
}
void cost_streams_interface(benchmark::State& state) {
    run(state, stack(1.0, 1), "doubling");
}
// Streams, layers.
void cost_layers(benchmark::State& state) {
    run(state, stack(1.0, static_cast<int>(state.range(1))), "doubling");
}
// Streams, optical thickness as a power of ten.
void cost_thickness(benchmark::State& state) {
    run(state, stack(std::pow(10.0, static_cast<double>(state.range(1))), 1), "doubling");
}

void problem_iia_doubling(benchmark::State& state) {
    run(state, problem(1.0, rt::BlackBase{}), "doubling");
}
void problem_iia_eigenmodes(benchmark::State& state) {
    run(state, problem(1.0, rt::BlackBase{}), "eigenmodes");
}
void interface_and_metal_doubling(benchmark::State& state) {
    run(state, problem(1.5, rt::MetalBase{{0.96, 6.69}}), "doubling");
}

BENCHMARK(cost_streams)->DenseRange(8, 48, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(cost_streams_eigenmodes)->DenseRange(8, 24, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(cost_streams_interface)->DenseRange(8, 32, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(cost_layers)->ArgsProduct({{8}, {1, 2, 4, 8, 16}})->Unit(benchmark::kMillisecond);
BENCHMARK(cost_thickness)->ArgsProduct({{8}, {-6, -4, -2, -1, 0, 1, 2, 3, 4}})->Unit(benchmark::kMillisecond);

BENCHMARK(problem_iia_doubling)->Arg(8)->Arg(16)->Arg(24)->Arg(32)->Unit(benchmark::kMillisecond);
BENCHMARK(interface_and_metal_doubling)->Arg(8)->Arg(16)->Arg(24)->Unit(benchmark::kMillisecond);
BENCHMARK(problem_iia_eigenmodes)->Arg(8)->Arg(16)->Unit(benchmark::kMillisecond);

}  // namespace
