#pragma once
// The state of polarization in which an emitter sends its light.
//
// A scene gives it on any emitter, in words or as a Stokes vector:
//
// | property | type | what |
// |---|---|---|
// | polarization | string | unpolarized, linear, circular, elliptical or rayleigh |
// | polarization_degree | float | p, 1 unless given |
// | polarization_angle | float | psi of the ellipse's long axis, degrees |
// | polarization_ellipticity | float | chi, degrees: tan chi = short over long axis, > 0 right-handed |
// | polarization_axis | vector | the reference direction, in the emitter's own space |
// | stokes | string | "1, 0.5, 0, 0" instead of all but the axis; only ratios to the first count |
//
// S = I (1, p cos 2chi cos 2psi, p cos 2chi sin 2psi, p sin 2chi) (Born & Wolf 1999, section 1.4.2), in the frame whose
// x axis is the reference direction made perpendicular to the direction of travel, and in the renderer's signs
// (stokes_frames.h): angles count counter-clockwise for who looks into the light. The reference is the emitter's own x
// axis, for surroundings their y axis (up). Along the reference itself no frame is distinguished: any is taken there.
//
// `rayleigh`, for surroundings: the single-scattered light of a clear sky, its degree p sin^2 g / (1 + cos^2 g) at the
// angle g from the sun, polarized across the plane through the sun (Coulson 1988, Polarization and Intensity of Light
// in the Atmosphere, section 4.1). `sun_direction`, in the emitter's own space, points towards the sun.
//
// The state is the same at every wavelength.

#include "patina/core/properties.h"
#include "patina/render/light_beam.h"

namespace patina::render {

class EmitterPolarization {
  public:
    EmitterPolarization() = default;  // unpolarized
    // Stokes components over the intensity; `axis` is a unit vector of the world.
    EmitterPolarization(const Vec3& quv, const Vec3& axis) : kind_(Kind::uniform), quv_(quv), axis_(axis) {}
    static EmitterPolarization rayleigh(float degree, const Vec3& towards_sun);

    bool polarized() const { return kind_ != Kind::unpolarized; }
    // Light of this intensity (or radiance, irradiance, flux) that travels along the unit vector `travel`.
    LightBeam light(Float4 intensity, const Vec3& travel) const;

  private:
    enum class Kind { unpolarized, uniform, rayleigh };
    Kind kind_ = Kind::unpolarized;
    Vec3 quv_ = Vec3::Zero();  // rayleigh: (p, -, -)
    Vec3 axis_ = Vec3::UnitX();
};

// What an emitter's node says; `to_world` takes its own space to the world. Throws Error(input) for values out of
// range, states that no light can have and properties that do not go together.
EmitterPolarization build_polarization(const Properties& emitter, const Eigen::Matrix4d& to_world);

}  // namespace patina::render
