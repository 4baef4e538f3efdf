#pragma once
// A scene ready to be rendered. Immutable after building and shared between threads.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "patina/render/bsdf_set.h"
#include "patina/render/emitters.h"
#include "patina/render/film.h"
#include "patina/render/geometry.h"
#include "patina/render/integrators/integrator.h"
#include "patina/render/medium.h"
#include "patina/render/sensor.h"

namespace patina::render {

class Scene {
  public:
    Geometry geometry;
    std::vector<Bsdf> bsdfs;
    Lights lights;
    std::vector<Medium> media;                          // shapes and the camera name them by index
    int camera_medium = vacuum;                         // around the camera
    std::shared_ptr<const Properties> sensor_node;      // built anew when the film's size is overridden
    int sensor_shape = -1;                              // that the sensor stands in
    std::shared_ptr<const Properties> integrator_node;  // likewise for the integrator; null: path tracing
    FilmSettings film;
    int samples_per_pixel = 16;
    std::uint64_t seed = 0;
    std::unique_ptr<const ColourMatching> matching;
    std::map<std::string, std::string> notes;  // provenance for the picture's metadata
};

}  // namespace patina::render
