#pragma once
// Spectra that vary over a surface: constant, bitmap, checkerboard.

#include <memory>

#include "patina/render/scene_resources.h"
#include "patina/render/spectrum.h"
#include "patina/render/vec.h"

namespace patina::render {

// A bitmap whose pixels were upsampled once to reflectance coefficients, bilinear between pixel centres, repeated.
struct SpectralBitmap {
    int width = 0, height = 0;
    std::vector<SigmoidCoefficients> coefficients;  // [y][x], row 0 at v = 1

    Float4 at(const Wavelengths& w, Vec2 uv) const;
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

    // The child <texture name="..."> or the spectrum `name` of a plugin, `fallback` when neither is given.
    static Texture reflectance(const Properties& plugin, const std::string& name, float fallback,
                               const SceneResources& resources);

  private:
    static Texture build(const Properties& texture, const SceneResources& resources);
    Float4 varying(const Wavelengths& w, const Vec2& uv) const;

    Spectrum spectrum_;
    std::shared_ptr<const SpectralBitmap> bitmap_;
    std::shared_ptr<const Texture> other_;  // checkerboard: the second colour
    Eigen::Matrix3f to_uv_ = Eigen::Matrix3f::Identity();
};

}  // namespace patina::render
