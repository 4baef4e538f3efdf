#pragma once
// Spectra as the kernels read them: dense tables of one nanometre, looked up at the four wavelengths of a path.

#include <array>
#include <functional>
#include <vector>

#include "patina/core/properties.h"
#include "patina/render/packet.h"

namespace patina::render {

inline constexpr float wavelength_min_nm = 380.0f;
inline constexpr float wavelength_max_nm = 780.0f;
inline constexpr float wavelength_range_nm = wavelength_max_nm - wavelength_min_nm;
inline constexpr int spectrum_nodes = 402;  // every nanometre of 380 .. 781, the last for interpolation only

// The wavelengths of one path, equidistant under rotation of the visible range (Wilkie et al. 2014, Hero wavelength
// spectral sampling): each is uniform in the range, lane 0 is the hero.
struct Wavelengths {
    Float4 nm;
    std::array<int, 4> node;  // table index below
    Float4 fraction;          // and where between it and the next

    // position in [0, 1).
    static Wavelengths sample(float position) {
        const Float4 p = position + Float4{0, 0.25f, 0.5f, 0.75f};
        return at(wavelength_min_nm + wavelength_range_nm * (p >= 1.0f ? p - 1.0f : p));
    }
    static Wavelengths all_at(float nm) { return at(splat(nm)); }

  private:
    static Wavelengths at(Float4 nm) {
        const Float4 x = nm - wavelength_min_nm;
        const Mask4 node = __builtin_convertvector(x, Mask4);
        return {nm, {node[0], node[1], node[2], node[3]}, x - __builtin_convertvector(node, Float4)};
    }
};

class Spectrum {
  public:
    Spectrum() = default;  // zero
    explicit Spectrum(float uniform) : uniform_(uniform) {}
    explicit Spectrum(const std::function<double(double wavelength_nm)>& function);

    Float4 at(const Wavelengths& w) const {
        if (values_.empty()) return splat(uniform_);
        const float* v = values_.data();
        const Float4 low{v[w.node[0]], v[w.node[1]], v[w.node[2]], v[w.node[3]]};
        const Float4 high{v[w.node[0] + 1], v[w.node[1] + 1], v[w.node[2] + 1], v[w.node[3] + 1]};
        return low + (high - low) * w.fraction;
    }
    bool is_uniform() const { return values_.empty(); }
    bool is_black() const;
    float smallest() const;
    float largest() const;
    float average() const;  // over 380 .. 780 nm

  private:
    float uniform_ = 0;
    std::vector<float> values_;  // [spectrum_nodes], or empty for a uniform spectrum
};

// The meanings of spectral/scene_spectrum.h as tables. Throws Error(input) at `where` for values out of range.
Spectrum reflectance_table(const SpectrumSpec& spec, const SourceLocation& where);
Spectrum emission_table(const SpectrumSpec& spec, const SourceLocation& where);
Spectrum property_table(const SpectrumSpec& spec, const SourceLocation& where);

// Smooth reflectance of a colour (spectral/rgb_upsampling.h), for textures: three coefficients a texel.
using SigmoidCoefficients = std::array<float, 3>;
SigmoidCoefficients sigmoid_coefficients(const Eigen::Vector3d& rgb);
inline Float4 sigmoid_reflectance(const SigmoidCoefficients& c, const Wavelengths& w) {
    const Float4 t = (w.nm - 595.0f) * (1 / 235.0f);
    const Float4 x = (t * c[0] + c[1]) * t + c[2];
    return 0.5f + 0.5f * x / sqrt(1.0f + x * x);
}

// CIE 1931 colour matching functions, scaled so that radiance averaged over wavelength samples with uniform density on
// the visible range gives XYZ with Y = 1 for the uniform unit spectrum. One row a nanometre, that of its middle: what a
// sample gains by interpolation within a nanometre is not seen after averaging.
class ColourMatching {
  public:
    ColourMatching();
    Float4 xyz(int node) const { return rows_[node]; }  // (x, y, z, 0)

  private:
    std::vector<Float4> rows_;
};

// CIE XYZ to linear sRGB (IEC 61966-2-1, D65 white, no adaptation).
Eigen::Vector3f xyz_to_srgb(const Eigen::Vector3f& xyz);

}  // namespace patina::render
