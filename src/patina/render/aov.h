#pragma once
// What the camera sees first, as numbers beside the picture: Mitsuba's `aov` integrator.

#include <string>
#include <vector>

#include "patina/core/properties.h"
#include "patina/core/stokes_image.h"
#include "patina/render/film.h"
#include "patina/render/sensor.h"

namespace patina::render {

class Scene;

struct Aov {
    enum class Kind { albedo, depth, position, uv, geo_normal, sh_normal, prim_index, shape_index };
    std::string name;  // of the layer
    Kind kind = Kind::depth;
};

// "name:kind, name:kind" of the plugin's `aovs`. Throws Error(input) for unknown kinds and for names that are given
// twice or taken by the picture.
std::vector<Aov> aovs_of(const Properties& node);
std::string kinds_of_aovs();

// What the scene's `aov` integrators ask for, as means over a pixel's samples with the film's filter; where nothing is
// seen, 0. Channels are named as Mitsuba names them. The albedo is pi times the BSDF between the view and the normal:
// of a Lambertian surface its reflectance. Meters have none.
std::vector<ImageLayer> aov_layers(const Scene& scene, const FilmSettings& film, const Sensor& sensor, int samples,
                                   std::uint64_t seed);

}  // namespace patina::render
