#pragma once
// A picture with polarization: what the renderer returns and the EXR writer stores.
//
// Stokes convention of the picture (Mitsuba 3's `stokes` integrator, IEEE/SPIE view of the receiver): looking from the
// camera towards the source, x points right in the image and y up; S1 > 0 is horizontal (along x), S2 > 0 is along +45
// degrees (between right and up), S3 > 0 is right circular (the field turns clockwise for the camera).

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace patina {

// Numbers beside the light, such as depths: one channel of one value a pixel.
struct ImageLayer {
    std::string name;
    std::vector<float> values;
};

struct StokesImage {
    int width = 0, height = 0;            // of the stored (cropped) window
    int crop_x = 0, crop_y = 0;           // upper left corner of the window in the full film
    int full_width = 0, full_height = 0;  // of the whole film
    std::vector<double> bin_edges_nm;     // B + 1, ascending; bin b covers [edge b, edge b+1)

    std::vector<float>
        spectral;              // [pixel][bin][stokes]: mean spectral radiance in the bin, W/(m^2 sr nm) or scene units
    std::vector<float> rgb;    // [pixel][stokes][3]: linear sRGB of each Stokes component (CIE 1931, Y = 1 for the
                               // uniform unit spectrum, no white balance)
    std::vector<float> alpha;  // [pixel]: share of camera rays that hit a surface
    std::vector<float>
        variance;  // [pixel][stokes]: variance of the MEAN of the luminance Y of each component; may be empty
    std::vector<std::uint32_t> sample_count;      // [pixel]
    std::vector<ImageLayer> layers;               // written, not read
    std::map<std::string, std::string> metadata;  // provenance: scene, seed, samples per pixel, software, ...

    int bin_count() const { return bin_edges_nm.empty() ? 0 : static_cast<int>(bin_edges_nm.size()) - 1; }
    double bin_centre_nm(int bin) const { return 0.5 * (bin_edges_nm[bin] + bin_edges_nm[bin + 1]); }
    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * height; }
    std::size_t pixel_index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }  // y = 0 on top
    // The four Stokes components of a bin, and the 4 x 3 values [stokes][rgb] of a pixel.
    float* stokes(std::size_t pixel, int bin) { return &spectral[(pixel * bin_count() + bin) * 4]; }
    const float* stokes(std::size_t pixel, int bin) const { return &spectral[(pixel * bin_count() + bin) * 4]; }
    float* stokes_rgb(std::size_t pixel) { return &rgb[pixel * 12]; }
    const float* stokes_rgb(std::size_t pixel) const { return &rgb[pixel * 12]; }
};

}  // namespace patina
