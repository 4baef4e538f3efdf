#pragma once
// What the tests of the renderer share: rendering a tree, and looking at the middle of the picture.

#include "patina/render/test_support.h"

namespace patina::render::test {

inline StokesImage render_tree(const Node& tree, RenderOptions options = {}, const SceneResources& given = {}) {
    return render(*build_scene(*tree, given), options);
}

// Mean over all pixels of a bin's Stokes vector.
inline Eigen::Vector4d mean_stokes(const StokesImage& image, int bin) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t p = 0; p < image.pixel_count(); ++p)
        sum += Eigen::Map<const Eigen::Vector4f>(image.stokes(p, bin)).cast<double>();
    return sum / static_cast<double>(image.pixel_count());
}

// Mean over all pixels and bins, for scenes that are the same at every wavelength.
inline Eigen::Vector4d mean_stokes(const StokesImage& image) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int b = 0; b < image.bin_count(); ++b) sum += mean_stokes(image, b);
    return sum / image.bin_count();
}

// A camera that looks through a needle's eye: every pixel sees the same direction to 1e-4.
inline Node needle(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& up, int samples,
                   int pixels = 4) {
    return perspective(look_at(from, to, up), 0.01, pixels, pixels, samples);
}

inline Node constant_light(double radiance = 1) {
    return node("emitter", "constant", {uniform("radiance", radiance)});
}

}  // namespace patina::render::test
