#pragma once
// A polarization camera: the mosaic of analysers on its sensor, the sensor's noise, and Stokes pictures from its
// frames.
//
// Every 2 x 2 block of pixels sits behind polarizers at 90 45 / 135 0 degrees (the layout of Sony's polarization
// sensors; rows from the top). Frames are pictures of one channel, Y: the light behind the analyser, half of S0 where
// the light is unpolarized.

#include <cstdint>

#include "patina/core/bitmap.h"
#include "patina/core/stokes_image.h"
#include "patina/io/image_stokes.h"

namespace patina::io {

// The frame of an ideal camera.
Bitmap polarization_mosaic(const StokesPlane& plane);

// A sensor by the linear model of EMVA standard 1288 (release 4.0): electrons are Poisson distributed about their mean,
// held at the full well; reading them out adds normal noise and a black level; what comes out are whole numbers of
// 0 .. 2^bits - 1, the largest for a full well.
struct SensorNoise {
    double full_well_e = 10500;  // electrons
    double read_noise_e = 2.4;   // standard deviation, electrons
    int bits = 12;               // 1 .. 16
    double black_level_dn = 0;   // digital numbers; with 0 the noise of dark pixels is cut off below
    double white = 0;            // light behind the analyser that fills the well; 0: automatic_white()
    std::uint64_t seed = 0;
};

// The light that fills the well when the 99.5th percentile of the frame's pixels fills 80 % of it.
double automatic_white(const Bitmap& frame);

// The frame as the sensor has it, in the unit of the light again: digital numbers less the black level, over the gain.
// Pixels are independent; the same seed gives the same frame. Throws Error(usage) for values out of range.
Bitmap add_sensor_noise(const Bitmap& frame, const SensorNoise& sensor);

// S0, S1, S2 of every pixel from a frame: each of the four grids of analysers is interpolated linearly between its
// pixels; S0 = (I0 + I45 + I90 + I135)/2, S1 = I0 - I90, S2 = I45 - I135, the least-squares solution; S3 is not seen
// and is 0. `rgb` has the colour of a uniform spectrum, so that the luminance of each component is its value; there are
// no bins. Throws Error(input) for frames lower or narrower than 2 pixels, or of more than one channel.
StokesImage demosaic(const Bitmap& frame);

}  // namespace patina::io
