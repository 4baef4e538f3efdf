#pragma once
// The renderer's front door: a tree of plugins becomes a scene, a scene becomes a picture with polarization.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "patina/core/progress.h"
#include "patina/core/properties.h"
#include "patina/core/stokes_image.h"
#include "patina/render/measurement.h"
#include "patina/render/scene_resources.h"

namespace patina::render {

class Scene;  // render/scene.h: immutable, shared between threads

// Builds everything a scene file describes. `root` is the node of category "scene" with children integrator, sensor,
// shape, emitter, bsdf (those with an id, referenced elsewhere). File names are strings ("filename") already resolved.
// Throws Error(input) at the place in the file for unknown plugins and properties, values out of range and degenerate
// geometry, with the nearest legal name. `sensor` chooses one of several by its id or its place, counted from 0 in the
// order of the file with those inside shapes last; "" is the first.
std::shared_ptr<const Scene> build_scene(const Properties& root, const SceneResources& resources,
                                         const std::string& sensor = "");

// One picture beside the whole: the light of the paths that an expression accepts
// (integrators/light_path_expression.h).
struct LightPathOutput {
    std::string name, expression;
};

// What the command line may override; empty = as the scene says.
struct RenderOptions {
    std::optional<int> samples_per_pixel;      // sampler's sample_count; the default without either is 16
    std::optional<double> time_limit_seconds;  // stop after the pass during which it elapsed
    std::optional<double> noise_target;        // stop when the luminance's standard error (root mean square over the
                                               // pixels) falls below this share of the mean luminance
    std::optional<std::pair<int, int>> size;   // width, height of the film
    std::optional<std::array<int, 4>> crop;    // x0, y0, x1, y1 in pixels of the film, x1 and y1 exclusive
    std::optional<std::string> integrator;     // plugin name in place of the scene's
    std::optional<std::uint64_t> seed;
    std::vector<double> bin_edges_nm;  // spectral bins; empty = 16 bins over 380 .. 780 nm
    std::vector<LightPathOutput> light_paths;
    int neumann_terms = 0;  // pictures of this many powers of the transport operator, and of the rest
};

// A picture and its parts, named as asked for; the terms of the Neumann series, L_e, T L_e, T^2 L_e, ..., are
// "neumann_00", "neumann_01", ... and "neumann_rest". Parts that share no path and leave none out add up to the whole
// bit by bit, in any order of float additions.
struct Pictures {
    StokesImage whole;
    std::vector<std::pair<std::string, StokesImage>> parts;
    std::optional<Measurement> measurement;  // of a sensor that is a meter
};

// A render part of the way. The films are views of the renderer's own memory (bytes of the machine's order): to be
// copied out of by who keeps the state, into by who puts it back. Films of other sizes cannot be put back.
struct RenderState {
    int samples = 0;  // done in every pixel
    std::int64_t non_finite = 0;
    std::vector<std::string> non_finite_places;  // of the first ones
    std::vector<std::span<std::byte>> films;
};

// Where a render keeps its state, so that it can go on after a stop.
struct RenderCheckpoint {
    double interval_seconds = 60;
    std::function<bool(RenderState&)> load;        // before the first sample; false: nothing was kept. Empty: none
    std::function<void(const RenderState&)> save;  // every interval, and when JobControl asks to stop. Empty: none
    bool save_finished = false;                    // also the last sample's, for more to be added later
};

// Renders; the same scene, options and seed give the same bits for every number of threads (time and noise limits
// decide only after which pass to stop), and for every number of stops on the way that a checkpoint has bridged. When
// JobControl asks to stop, the passes done so far are returned with the metadata "stopped" = "yes". Samples that are
// not finite are left out, counted and located in the metadata "non_finite_samples"; more than one in 10^4 is an
// Error(runtime). With Neumann terms the metadata "neumann_ratio_NN" are the energies in the picture of term NN + 1
// over term NN, and "neumann_norm" the largest of them: what one more application of the transport operator leaves of
// the light, as seen by this camera.
Pictures render_parts(const Scene& scene, const RenderOptions& options, const JobControl& control = {},
                      const RenderCheckpoint& checkpoint = {});

// The whole alone.
StokesImage render(const Scene& scene, const RenderOptions& options, const JobControl& control = {});

// The registry, for help, documentation and property tests.
struct ParameterDescriptor {
    std::string name, type, unit, default_value, range, doc;
};
struct PluginDescriptor {
    std::string category, name, doc;
    std::vector<ParameterDescriptor> parameters;
};
const std::vector<PluginDescriptor>& plugins();

}  // namespace patina::render
