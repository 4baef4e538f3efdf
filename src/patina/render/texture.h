#pragma once
// Spectra that vary over a surface: constant, bitmap, checkerboard, attribute of a mesh. As reflectances or as light
// that is sent out.

#include <memory>

#include "patina/render/mesh_attribute.h"
#include "patina/render/scene_resources.h"
#include "patina/render/spectrum.h"
#include "patina/render/texel_grid.h"
#include "patina/render/vec.h"

namespace patina::render {

struct VaryingTexture;

class Texture {
  public:
    Texture() = default;
    Texture(Spectrum spectrum) : spectrum_(std::move(spectrum)) {}

    Float4 at(const Wavelengths& w, const SurfaceUv& uv) const { return varying_ ? varying(w, uv) : spectrum_.at(w); }
    bool varies() const { return varying_ != nullptr; }
    bool is_black() const { return !varies() && spectrum_.is_black(); }
    float average() const;
    // Of a picture, width over height; 1 of anything else.
    float aspect() const;

    // The child <texture name="..."> or the spectrum `name` of a plugin, `fallback` when neither is given: a
    // reflectance, or a radiance.
    static Texture reflectance(const Properties& plugin, const std::string& name, float fallback,
                               const SceneResources& resources);
    static Texture emission(const Properties& plugin, const std::string& name, float fallback,
                            const SceneResources& resources);

  private:
    static Texture read(const Properties& plugin, const std::string& name, float fallback,
                        const SceneResources& resources, bool light);
    static Texture build(const Properties& texture, const SceneResources& resources, bool light);
    Float4 varying(const Wavelengths& w, const SurfaceUv& uv) const;

    Spectrum spectrum_;
    std::shared_ptr<const VaryingTexture> varying_;  // null: the spectrum everywhere
};

// A number that varies over a surface, such as a roughness: constant, a bitmap or an attribute of one channel (of
// colours the luminance), or a checkerboard of two numbers.
class ScalarTexture {
  public:
    ScalarTexture() = default;
    explicit ScalarTexture(float value) : values_{value} {}

    float at(const SurfaceUv& uv) const;
    bool varies() const { return values_.size() > 1; }
    const std::vector<float>& values() const { return values_; }  // all that it takes, but for what lies between

    static ScalarTexture read(const Properties& plugin, const std::string& name, double fallback,
                              const SceneResources& resources);

  private:
    TexelGrid grid_;
    MeshGrid mesh_;  // instead of the grid, when it has a mesh
    std::vector<float> values_{0.0f};
};

}  // namespace patina::render
