#pragma once
// From scene-linear colour to what a screen shows.
//
// 1. White balance: a von Kries adaptation (Bradford) that makes the chosen white neutral.
// 2. Exposure: a factor 2^ev, after the automatic one that brings the 98th percentile of the luminance to 0.8.
// 3. Tone curve on the luminance: the identity up to 0.6, above it 1 - 0.4 exp(-(Y - 0.6)/0.4), which goes on with the
//    same slope and reaches white at infinity, so that shadows and midtones are untouched and highlights roll off.
// 4. Colours that leave the screen's gamut are drawn to the grey of their luminance until they fit; hue is kept.

#include "patina/core/bitmap.h"
#include "patina/core/stokes_image.h"

namespace patina::io {

enum class WhiteBalance {
    automatic,     // as the scene was lit (metadata "white"): none for D65, equal_energy for E; without the metadata
                   // equal_energy for pictures with bins, none for others
    none,          // as the file has it: a uniform spectrum is (1.205, 0.948, 0.909)
    equal_energy,  // a uniform spectrum is neutral
    grey_world     // the mean of the picture is neutral
};

struct ToneOptions {
    double exposure_ev = 0.0;
    bool automatic_exposure = true;
    WhiteBalance white_balance = WhiteBalance::automatic;
    bool tone_curve = true;  // else what is above 1 is clipped by the writer
};

// The exposure, as a power of two, that the automatic one chooses; 0 for a black picture. Pictures to be seen side by
// side (with and without a polarizer) are shown with the exposure of one of them.
double automatic_exposure_ev(const StokesImage& image, WhiteBalance white_balance);

// S0 of the picture as linear RGB in [0, 1] (above 1 without tone curve). Pixels that are not numbers are magenta.
Bitmap tone_map(const StokesImage& image, const ToneOptions& options = {});

// Step 3 by itself.
double roll_off(double luminance);

}  // namespace patina::io
