#pragma once
// Light of points and from single directions that falls straight on a meter. No ray of a meter's finds such a lamp by
// chance, and no integrator joins lamps with sensors.

#include "patina/render/scene.h"

namespace patina::render {

// Stokes vector, as mean radiance over the meter's rays, of all lamps that are delta functions and reach the meter
// unscattered where `camera` begins (irradiance), or go into the direction it looks against (intensity). Zero for other
// sensors. An irradiance meter's film shows it evenly spread.
StokesPacket delta_light_at_sensor(const Scene& scene, const Sensor& sensor, const Sensor::CameraRay& camera,
                                   const Wavelengths& w);

}  // namespace patina::render
