#pragma once
// Spectra that vary over a surface: constant, bitmap, checkerboard. As reflectances or as light that is sent out.

#include <memory>

#include "patina/render/scene_resources.h"
#include "patina/render/spectrum.h"
#include "patina/render/texel_grid.h"
#include "patina/render/vec.h"

namespace patina::render {

// A bitmap whose pixels were upsampled once to the coefficients of smooth spectra.
struct SpectralBitmap {
    TexelGrid grid;
    std::vector<SigmoidCoefficients> coefficients;  // of the grid's texels
    std::vector<float> scale;                       // of light: factor on each texel; empty for reflectances
    Spectrum illuminant;                            // of light: what white sends

    Float4 at(const Wavelengths& w, const Vec2& uv) const;
    float average() const;
};

class Texture {
  public:
    Texture() = default;
    Texture(Spectrum spectrum) : spectrum_(std::move(spectrum)) {}

    Float4 at(const Wavelengths& w, const Vec2& uv) const {
        if (!bitmap_ && !other_) return spectrum_.at(w);
        return varying(w, uv);
    }
    bool varies() const { return bitmap_ || other_; }
    bool is_black() const { return !varies() && spectrum_.is_black(); }
    float average() const;

    // The child <texture name="..."> or the spectrum `name` of a plugin, `fallback` when neither is given: a
    // reflectance, or a radiance.
    static Texture reflectance(const Properties& plugin, const std::string& name, float fallback,
                               const SceneResources& resources);
    static Texture emission(const Properties& plugin, const std::string& name, float fallback,
                            const SceneResources& resources);

  private:
    using Table = Spectrum (*)(const SpectrumSpec&, const SourceLocation&);
    static Texture read(const Properties& plugin, const std::string& name, float fallback,
                        const SceneResources& resources, bool light);
    static Texture build(const Properties& texture, const SceneResources& resources, bool light);
    Float4 varying(const Wavelengths& w, const Vec2& uv) const;

    Spectrum spectrum_;
    std::shared_ptr<const SpectralBitmap> bitmap_;
    std::shared_ptr<const Texture> other_;  // checkerboard: the second colour
    Eigen::Matrix3f to_uv_ = Eigen::Matrix3f::Identity();
};

// A number that varies over a surface, such as a roughness: constant, a bitmap of one channel (of colours the
// luminance), or a checkerboard of two numbers.
class ScalarTexture {
  public:
    ScalarTexture() = default;
    explicit ScalarTexture(float value) : values_{value} {}

    float at(const Vec2& uv) const;
    bool varies() const { return values_.size() > 1; }
    const std::vector<float>& values() const { return values_; }  // all that it takes, but for what lies between

    static ScalarTexture read(const Properties& plugin, const std::string& name, double fallback,
                              const SceneResources& resources);

  private:
    TexelGrid grid_;
    std::vector<float> values_{0.0f};
};

}  // namespace patina::render
