#pragma once
// The meaning of a spectrum written in a scene file, which depends on what it describes.

#include "patina/core/error.h"
#include "patina/core/properties.h"
#include "patina/spectral/spectrum.h"

namespace patina::spectral {

// A reflectance or transmittance in [0, 1]; samples are held outside their range; rgb is upsampled.
// Throws Error(input) at `where` for values outside [0, 1] and for a black body.
SpectralFunction reflectance_spectrum(const SpectrumSpec& spec, const SourceLocation& where = {});

// Radiance, irradiance or intensity, not negative; samples are dark outside their range; rgb multiplies D65 with Y = 1,
// as in Mitsuba 3, and a uniform spectrum is uniform; a black body has physical units, W m^-2 sr^-1 nm^-1, times its
// scale.
SpectralFunction emission_spectrum(const SpectrumSpec& spec, const SourceLocation& where = {});

// A property of matter without an upper bound (refractive index, extinction coefficient), not negative; samples are
// held outside their range. rgb becomes the smooth spectrum that a reflectance of this colour would have, scaled where
// it is brighter than one, as Mitsuba 3 does with the metals of older scenes; no measured index comes out of it.
SpectralFunction property_spectrum(const SpectrumSpec& spec, const SourceLocation& where = {});

}  // namespace patina::spectral
