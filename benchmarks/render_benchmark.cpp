// Samples per core-second of the renderer. Reference: the scene of a dielectric and a rough gold sphere on a diffuse
// floor under an area light and a constant sky, 256 x 256, depth 8, full Stokes, four wavelengths a path; Mitsuba 3.8
// traces 0.47 million samples of it per core-second in its scalar spectral polarized variant and 2.0 in its vectorized
// one.

#include <benchmark/benchmark.h>

#include "patina/brdf/tabulate.h"
#include "patina/core/parallel.h"
#include "patina/render/test_support.h"

namespace patina::render {
namespace {

using Eigen::Vector3d;
using test::node;

test::Node polar_balls() {
    const auto sphere = [](double x, test::Node bsdf) {
        return node("shape", "sphere", {{"center", Vector3d(x, 1, 0)}, {"radius", 1.0}}, {std::move(bsdf)});
    };
    return test::scene(
        {node("integrator", "stokes", {}, {test::path(8)}),
         test::perspective(test::look_at({0, 2.2, 6}, {0, 0.8, 0}, {0, 1, 0}), 40, 256, 256, 64),
         sphere(-1.1, node("bsdf", "dielectric", {{"int_ior", 1.5}, {"ext_ior", 1.0}})),
         sphere(1.1, node("bsdf", "roughconductor",
                          {{"material", std::string("Au")}, {"distribution", std::string("ggx")}, {"alpha", 0.1}})),
         node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(test::scale(8, 8, 8) * test::rotate_x(-90))}},
              {node("bsdf", "diffuse", {test::uniform("reflectance", 0.5)})}),
         node("shape", "rectangle",
              {{"to_world",
                Eigen::Matrix4d(test::translate({0, 5, 1}) * test::scale(1.5, 1.5, 1.5) * test::rotate_x(90))}},
              {node("bsdf", "diffuse"), node("emitter", "area", {test::uniform("radiance", 10)})}),
         node("emitter", "constant", {test::uniform("radiance", 0.2)})});
}

// Counts samples of a 256 x 256 picture on one core.
void measure(const Scene& scene, benchmark::State& state, RenderOptions options = {}) {
    options.samples_per_pixel = options.samples_per_pixel.value_or(16);
    double mean = 0;
    for (auto _ : state) {
        const StokesImage image = render(scene, options);
        for (std::size_t p = 0; p < image.pixel_count(); ++p) mean += image.stokes_rgb(p)[1] / image.pixel_count();
        benchmark::DoNotOptimize(mean);
    }
    set_thread_count(0);
    const double samples = 256.0 * 256.0 * *options.samples_per_pixel * state.iterations();
    state.counters["samples_per_core_second"] = benchmark::Counter(samples, benchmark::Counter::kIsRate);
    state.counters["times_mitsuba_llvm"] = benchmark::Counter(samples / 2.0e6, benchmark::Counter::kIsRate);
    state.counters["mean_green"] = mean / state.iterations();
}

void polar_balls_samples_per_core_second(benchmark::State& state) {
    set_thread_count(1);
    measure(*build_scene(*polar_balls(), {}), state);
}
BENCHMARK(polar_balls_samples_per_core_second)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

// The same scene by every integrator that can. A sample of bidirectional is two paths and all ways to join them, one of
// distribution a tree of rays.
void polar_balls_by(benchmark::State& state, const char* integrator) {
    set_thread_count(1);
    RenderOptions options;
    options.integrator = integrator;
    options.samples_per_pixel = 4;
    measure(*build_scene(*polar_balls(), {}), state, options);
}
BENCHMARK_CAPTURE(polar_balls_by, appel, "appel")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(polar_balls_by, whitted, "whitted")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(polar_balls_by, distribution, "distribution")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(polar_balls_by, light, "light")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(polar_balls_by, bidirectional, "bidirectional")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(polar_balls_by, volumetric, "volumetric")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

// Three painted spheres on a painted floor under an area light: nearly every vertex reads the paint table.
test::Node painted_spheres() {
    const auto paint = [] { return node("bsdf", "paint", {{"table", std::string("rayleigh")}}); };
    std::vector<test::Node> children = {
        node("integrator", "stokes", {}, {test::path(8)}),
        test::perspective(test::look_at({0, 2.2, 6}, {0, 0.8, 0}, {0, 1, 0}), 40, 256, 256, 64),
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(test::scale(8, 8, 8) * test::rotate_x(-90))}},
             {paint()}),
        node("shape", "rectangle",
             {{"to_world",
               Eigen::Matrix4d(test::translate({0, 5, 1}) * test::scale(1.5, 1.5, 1.5) * test::rotate_x(90))}},
             {node("bsdf", "diffuse"), node("emitter", "area", {test::uniform("radiance", 10)})}),
        node("emitter", "constant", {test::uniform("radiance", 0.2)})};
    for (double x : {-2.0, 0.0, 2.0})
        children.push_back(node("shape", "sphere", {{"center", Vector3d(x, 1, 0)}, {"radius", 1.0}}, {paint()}));
    return test::scene(std::move(children));
}

void painted_spheres_samples_per_core_second(benchmark::State& state) {
    set_thread_count(1);
    SceneResources resources;
    resources.load_brdf_table = [](const std::string&) {
        return std::make_shared<const brdf::MuellerTable>(brdf::tabulate(
            brdf::single_rayleigh_body(1.0), {.wavelengths_nm = {380, 480, 580, 680, 780}, .nodes = 32, .orders = 3}));
    };
    measure(*build_scene(*painted_spheres(), resources), state);
}
BENCHMARK(painted_spheres_samples_per_core_second)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace patina::render
