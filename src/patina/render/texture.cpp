#include "patina/render/texture.h"

#include <numeric>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

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

std::shared_ptr<SpectralBitmap> reflectances(const TexturePicture& picture) {
    auto result = std::make_shared<SpectralBitmap>();
    result->grid = picture.grid;
    result->coefficients.reserve(picture.grid.size());
    for (std::size_t i = 0; i < picture.grid.size(); ++i)
        result->coefficients.push_back(sigmoid_coefficients(colour_of(*picture.image, i)));
    return result;
}

// The sigmoid holds for components up to 1: the brightest of each texel becomes one half. Raw numbers are a uniform
// spectrum, colours D65 times a smooth one.
std::shared_ptr<SpectralBitmap> lights(const TexturePicture& picture, const SourceLocation& where) {
    auto result = std::make_shared<SpectralBitmap>();
    result->grid = picture.grid;
    const bool numbers = picture.raw && picture.image->channel_count() < 3;
    result->illuminant =
        numbers ? Spectrum(1.0f) : emission_table({SpectrumSpec::Kind::rgb, {}, {1.0, 1.0, 1.0}}, where);
    for (std::size_t i = 0; i < picture.grid.size(); ++i) {
        const Eigen::Vector3d rgb = colour_of(*picture.image, i);
        expect_colour(rgb, *picture.image, i, where);
        const double scale = std::max(2 * rgb.maxCoeff(), 1e-30);
        result->coefficients.push_back(sigmoid_coefficients(rgb / scale));
        result->scale.push_back(static_cast<float>(scale));
    }
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

Float4 SpectralBitmap::at(const Wavelengths& w, const Vec2& uv) const {
    const TexelPatch patch = grid.at(uv);
    if (scale.empty())
        return patch.blend([&](std::size_t texel) { return sigmoid_reflectance(coefficients[texel], w); });
    return illuminant.at(w) *
           patch.blend([&](std::size_t texel) { return sigmoid_reflectance(coefficients[texel], w) * scale[texel]; });
}

float SpectralBitmap::average() const {
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

Float4 Texture::varying(const Wavelengths& w, const Vec2& uv) const {
    if (bitmap_) return bitmap_->at(w, uv);
    const Vec3 mapped = to_uv_ * Vec3(uv.x(), uv.y(), 1);
    const bool odd_x = mapped.x() - std::floor(mapped.x()) > 0.5f, odd_y = mapped.y() - std::floor(mapped.y()) > 0.5f;
    return odd_x == odd_y ? spectrum_.at(w) : other_->at(w, uv);
}

float Texture::average() const {
    if (other_) return 0.5f * (spectrum_.average() + other_->average());
    return bitmap_ ? bitmap_->average() : spectrum_.average();
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
    Texture result;
    if (texture.type == "bitmap") {
        const TexturePicture picture = read_picture(texture, resources, false);
        result.bitmap_ = light ? lights(picture, texture.location_of("filename")) : reflectances(picture);
        return result;
    }
    result.to_uv_ = plane_transform(texture);
    const auto colour = [&](const char* name, float fallback) {
        const auto spec = texture.spectrum(name);
        return spec ? (light ? emission_table : reflectance_table)(*spec, texture.location_of(name))
                    : Spectrum(fallback);
    };
    result.spectrum_ = colour("color0", 0.4f);
    result.other_ = std::make_shared<const Texture>(Texture(colour("color1", 0.2f)));
    expect_known_properties(texture);
    return result;
}

float ScalarTexture::at(const Vec2& uv) const {
    if (!varies()) return values_.front();
    return grid_.at(uv).blend([&](std::size_t texel) { return values_[texel]; });
}

ScalarTexture ScalarTexture::read(const Properties& plugin, const std::string& name, double fallback,
                                  const SceneResources& resources) {
    const auto child = texture_child(plugin, name, "number");
    if (!child) return ScalarTexture(static_cast<float>(plugin.number(name, fallback)));
    ScalarTexture result;
    if (child->type == "checkerboard") {
        // Two numbers are a picture of 2 x 2 texels.
        const auto first = static_cast<float>(child->number("color0", 0.4)),
                   second = static_cast<float>(child->number("color1", 0.2));
        result.values_ = {first, second, second, first};
        result.grid_.width = result.grid_.height = 2;
        result.grid_.nearest = true;
        result.grid_.to_uv = plane_transform(*child);
        expect_known_properties(*child);
        return result;
    }
    const TexturePicture picture = read_picture(*child, resources, false);
    result.grid_ = picture.grid;
    result.values_.clear();
    for (std::size_t i = 0; i < picture.grid.size(); ++i) {
        const Eigen::Vector3d rgb = colour_of(*picture.image, i);
        expect_colour(rgb, *picture.image, i, child->location_of("filename"));
        // Luminance of linear sRGB (IEC 61966-2-1).
        result.values_.push_back(static_cast<float>(rgb.dot(Eigen::Vector3d(0.2126, 0.7152, 0.0722))));
    }
    // A picture of one texel is a number, whatever the place.
    return result;
}

}  // namespace patina::render
