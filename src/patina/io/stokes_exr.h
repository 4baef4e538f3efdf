#pragma once
// Stokes images as OpenEXR files: ours and Mitsuba's.
//
// Written layout (Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for Spectral Images", JCGT 10(3)):
//   S0.550,000000nm ... S3.550,000000nm   spectral radiance of each Stokes component at the bin's centre
//   R, G, B, A                            preview: linear sRGB of S0 (CIE 1931, no white balance), and alpha
//   S0.R, S0.G, S0.B ... S3.B             on request: the names of Mitsuba 3's `stokes` integrator
//   variance.S0 ... variance.S3, samples  on request: variance of the mean luminance, samples a pixel
// All channels are 32-bit float with ZIP compression, samples are 32-bit integers. Attributes: spectralLayoutVersion
// "1.0", emissiveUnits, polarisationHandedness "right" (S3 > 0 is right circular seen from the camera; the whole
// convention is in core/stokes_image.h), patina.binEdges_nm, and the image's metadata as patina.<key>.

#include <filesystem>

#include "patina/core/stokes_image.h"

namespace patina::io {

struct StokesExrOptions {
    bool spectral = true;     // the spectral channels, when the image has bins
    bool stokes_rgb = false;  // Mitsuba's channel names
    bool variance = true;     // variance and sample counts, when the image has them
};

// Writes under a temporary name and renames. Throws Error(runtime) when the disk refuses.
void write_stokes_exr(const std::filesystem::path& path, const StokesImage& image,
                      const StokesExrOptions& options = {});

// Reads what write_stokes_exr writes, other spectral Stokes images of the same layout, Mitsuba's Stokes images and
// plain RGB(A) images (unpolarized); half, float and integer channels. `rgb` is always filled: from channels when they
// are there, from the spectral bins else. An image without spectral channels has no bins; string attributes become
// metadata. Throws Error(input) for a truncated or corrupt file and for one without a usable channel, naming those it
// has.
StokesImage read_stokes_exr(const std::filesystem::path& path);

// Fills `rgb` from the spectral bins: CIE 1931 colour matching functions, Y = 1 for the uniform unit spectrum.
// `rgb` must have its size; components below `first_component` are left as they are.
void fill_rgb_from_bins(StokesImage& image, int first_component = 0);

}  // namespace patina::io
