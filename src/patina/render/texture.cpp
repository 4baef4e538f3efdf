#include "patina/render/texture.h"

#include <variant>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

// Colours of texels or of a mesh's vertices, upsampled once to the coefficients of smooth spectra.
struct UpsampledColours {
    std::vector<SigmoidCoefficients> coefficients;
    std::vector<float> scale;  // of light: factor on each; empty for reflectances
    Spectrum illuminant;       // of light: what white sends

    void add_reflectance(const Eigen::Vector3d& rgb) { coefficients.push_back(sigmoid_coefficients(rgb)); }
    // The sigmoid holds for components up to 1: the brightest of each becomes one half.
    void add_light(const Eigen::Vector3d& rgb) {
        const double brightest = std::max(2 * rgb.maxCoeff(), 1e-30);
        coefficients.push_back(sigmoid_coefficients(rgb / brightest));
        scale.push_back(static_cast<float>(brightest));
    }

    // `blend(value)` mixes value(i) of the texels about a place.
    template <class Blend>
    Float4 at(const Wavelengths& w, const Blend& blend) const {
        if (scale.empty()) return blend([&](std::size_t i) { return sigmoid_reflectance(coefficients[i], w); });
        return illuminant.at(w) *
               blend([&](std::size_t i) { return sigmoid_reflectance(coefficients[i], w) * scale[i]; });
    }
    float average() const;
};

float UpsampledColours::average() const {
    // A few hundred texels at mid wavelength are enough for the sampling weight of a reflectance; a light may be dark
    // but for one of them.
    const Wavelengths w = Wavelengths::sample(0.1f);
    const std::size_t count = coefficients.size(),
                      step = scale.empty() ? std::max<std::size_t>(1, count / 256) : std::size_t{1};
    double total = 0;
    int used = 0;
    for (std::size_t i = 0; i < count; i += step, ++used)
        total += mean(sigmoid_reflectance(coefficients[i], w)) * (scale.empty() ? 1.0f : scale[i]);
    return static_cast<float>(total / used) * (scale.empty() ? 1.0f : illuminant.average());
}

struct SpectralBitmap {
    TexelGrid grid;
    UpsampledColours colours;

    Float4 at(const Wavelengths& w, const SurfaceUv& uv) const {
        const TexelPatch patch = grid.at(uv);
        return colours.at(w, [&](const auto& value) { return patch.blend(value); });
    }
    float average() const { return colours.average(); }
};

struct MeshColours {
    MeshGrid grid;
    UpsampledColours colours;

    Float4 at(const Wavelengths& w, const SurfaceUv& uv) const {
        return colours.at(w, [&](const auto& value) { return grid.blend(uv, value); });
    }
    float average() const { return colours.average(); }
};

struct Checkerboard {
    Texture first, second;
    Eigen::Matrix3f to_uv;

    Float4 at(const Wavelengths& w, const SurfaceUv& uv) const {
        const Vec3 mapped = to_uv * Vec3(uv.x(), uv.y(), 1);
        const bool odd_x = mapped.x() - std::floor(mapped.x()) > 0.5f,
                   odd_y = mapped.y() - std::floor(mapped.y()) > 0.5f;
        return (odd_x == odd_y ? first : second).at(w, uv);
    }
    float average() const { return 0.5f * (first.average() + second.average()); }
};

// One texel as a colour: grey for pictures of one channel.
Eigen::Vector3d colour_of(const Bitmap& image, std::size_t texel) {
    const float* p = image.data.data() + texel * image.channels.size();
    return image.channel_count() >= 3 ? Eigen::Vector3d(p[0], p[1], p[2]) : Eigen::Vector3d::Constant(p[0]);
}

void expect_colour(const Eigen::Vector3d& rgb, const Bitmap& image, std::size_t texel, const SourceLocation& where) {
    if (rgb.allFinite() && rgb.minCoeff() >= 0 && rgb.maxCoeff() < 1e15) return;
    throw input_error(
        where, fmt::format("pixel ({}, {}) is negative or not finite", texel % image.width, texel / image.width));
}

// What a light of colour 1 sends. Raw numbers are a uniform spectrum, colours D65 times a smooth one.
Spectrum white_light(bool numbers, const SourceLocation& where) {
    return numbers ? Spectrum(1.0f) : emission_table({SpectrumSpec::Kind::rgb, {}, {1.0, 1.0, 1.0}}, where);
}

SpectralBitmap bitmap_of(const TexturePicture& picture, bool light, const SourceLocation& where) {
    SpectralBitmap result{picture.grid, {}};
    if (light) result.colours.illuminant = white_light(picture.raw && picture.image->channel_count() < 3, where);
    result.colours.coefficients.reserve(picture.grid.size());
    for (std::size_t i = 0; i < picture.grid.size(); ++i) {
        const Eigen::Vector3d rgb = colour_of(*picture.image, i);
        if (!light) {
            result.colours.add_reflectance(rgb);
            continue;
        }
        expect_colour(rgb, *picture.image, i, where);
        result.colours.add_light(rgb);
    }
    return result;
}

MeshColours colours_of(const AttributePicture& picture, bool light, const SourceLocation& where) {
    MeshColours result{picture.grid, {}};
    if (light) result.colours.illuminant = white_light(picture.channels == 1, where);
    for (std::size_t i = 0; i < picture.size(); ++i)
        light ? result.colours.add_light(picture.colour(i)) : result.colours.add_reflectance(picture.colour(i));
    return result;
}

// The child called `name`, which must be a texture; null when there is none.
std::shared_ptr<const Properties> texture_child(const Properties& plugin, const std::string& name, const char* what) {
    const auto child = plugin.named_child(name);
    if (child && child->category != "texture")
        throw input_error(child->where, fmt::format("\"{}\" must be a {} or a texture", name, what),
                          fmt::format("it is a {}", child->category));
    return child;
}

}  // namespace

struct VaryingTexture {
    std::variant<SpectralBitmap, MeshColours, Checkerboard> kind;
};

Float4 Texture::varying(const Wavelengths& w, const SurfaceUv& uv) const {
    return std::visit([&](const auto& kind) { return kind.at(w, uv); }, varying_->kind);
}

float Texture::average() const {
    return varying_ ? std::visit([](const auto& kind) { return kind.average(); }, varying_->kind) : spectrum_.average();
}

float Texture::aspect() const {
    const auto* bitmap = varying_ ? std::get_if<SpectralBitmap>(&varying_->kind) : nullptr;
    return bitmap ? static_cast<float>(bitmap->grid.width) / static_cast<float>(bitmap->grid.height) : 1.0f;
}

Texture Texture::reflectance(const Properties& plugin, const std::string& name, float fallback,
                             const SceneResources& resources) {
    return read(plugin, name, fallback, resources, false);
}
Texture Texture::emission(const Properties& plugin, const std::string& name, float fallback,
                          const SceneResources& resources) {
    return read(plugin, name, fallback, resources, true);
}

Texture Texture::read(const Properties& plugin, const std::string& name, float fallback,
                      const SceneResources& resources, bool light) {
    if (const auto child = texture_child(plugin, name, "spectrum")) return build(*child, resources, light);
    const auto spec = plugin.spectrum(name);
    if (!spec) return Spectrum(fallback);
    return (light ? emission_table : reflectance_table)(*spec, plugin.location_of(name));
}

Texture Texture::build(const Properties& texture, const SceneResources& resources, bool light) {
    expect_plugin(texture);
    VaryingTexture varying;
    if (texture.type == "bitmap") {
        const SourceLocation where = texture.location_of("filename");
        varying.kind = bitmap_of(read_picture(texture, resources, false), light, where);
    } else if (texture.type == "mesh_attribute") {
        varying.kind = colours_of(read_attribute(texture, resources), light, texture.where);
    } else {
        varying.kind = Checkerboard{read(texture, "color0", 0.4f, resources, light),
                                    read(texture, "color1", 0.2f, resources, light), plane_transform(texture)};
        expect_known_properties(texture);
    }
    Texture result;
    result.varying_ = std::make_shared<const VaryingTexture>(std::move(varying));
    return result;
}

float ScalarTexture::at(const SurfaceUv& uv) const {
    if (!varies()) return values_.front();
    const auto value = [&](std::size_t i) { return values_[i]; };
    return mesh_.mesh ? mesh_.blend(uv, value) : grid_.at(uv).blend(value);
}

ScalarTexture ScalarTexture::read(const Properties& plugin, const std::string& name, double fallback,
                                  const SceneResources& resources) {
    // Luminance of linear sRGB (IEC 61966-2-1).
    const auto luminance = [](const Eigen::Vector3d& rgb) {
        return static_cast<float>(rgb.dot(Eigen::Vector3d(0.2126, 0.7152, 0.0722)));
    };
    const auto child = texture_child(plugin, name, "number");
    if (!child) return ScalarTexture(static_cast<float>(plugin.number(name, fallback)));
    ScalarTexture result;
    result.values_.clear();
    if (child->type == "checkerboard") {
        // Two numbers are a picture of 2 x 2 texels.
        const auto first = static_cast<float>(child->number("color0", 0.4)),
                   second = static_cast<float>(child->number("color1", 0.2));
        result.values_ = {first, second, second, first};
        result.grid_.width = result.grid_.height = 2;
        result.grid_.nearest = true;
        result.grid_.to_uv = plane_transform(*child);
        expect_known_properties(*child);
    } else if (child->type == "mesh_attribute") {
        const AttributePicture picture = read_attribute(*child, resources);
        result.mesh_ = picture.grid;
        for (std::size_t i = 0; i < picture.size(); ++i)
            result.values_.push_back(picture.channels == 1 ? picture.values[i] : luminance(picture.colour(i)));
    } else {
        const TexturePicture picture = read_picture(*child, resources, false);
        result.grid_ = picture.grid;
        for (std::size_t i = 0; i < picture.grid.size(); ++i) {
            const Eigen::Vector3d rgb = colour_of(*picture.image, i);
            expect_colour(rgb, *picture.image, i, child->location_of("filename"));
            result.values_.push_back(luminance(rgb));
        }
    }
    // A picture of one texel is a number, whatever the place.
    return result;
}

}  // namespace patina::render
