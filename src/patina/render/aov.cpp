#include "patina/render/aov.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/render/random.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

struct KindInfo {
    const char* name;
    const char* channels;  // a letter each
};
// In the order of Aov::Kind.
constexpr KindInfo kinds[] = {{"albedo", "RGB"},     {"depth", "T"},       {"position", "XYZ"}, {"uv", "UV"},
                              {"geo_normal", "XYZ"}, {"sh_normal", "XYZ"}, {"prim_index", "I"}, {"shape_index", "I"}};

const KindInfo& info_of(const Aov& aov) {
    return kinds[static_cast<int>(aov.kind)];
}

std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const KindInfo& kind : kinds) names.emplace_back(kind.name);
    return names;
}

std::vector<std::string> split(const std::string& text, std::string_view separators) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = text.find_first_not_of(separators, at);
        if (begin == std::string::npos) break;
        at = std::min(text.find_first_of(separators, begin), text.size());
        words.push_back(text.substr(begin, at - begin));
    }
    return words;
}

// Enough for edges; what is seen first has no other noise.
constexpr int most_samples = 64;

std::vector<Aov> aovs_of_scene(const Scene& scene) {
    std::vector<Aov> aovs;
    for (const Properties* node = scene.integrator_node.get(); node && is_wrapper(*node);
         node = node->only_child("integrator").get())
        if (node->type == "aov")
            for (Aov& aov : aovs_of(*node)) aovs.push_back(std::move(aov));
    return aovs;
}

// Quantities of one camera ray.
class FirstHit {
  public:
    FirstHit(const Scene& scene, const Sensor::CameraRay& camera, const Wavelengths& w) : scene_(scene), w_(w) {
        ray_ = camera.ray;
        seen_ = scene.geometry.intersect(ray_, hit_);
        if (seen_) point_ = scene.geometry.surface(ray_, hit_);
    }

    Vec3 value(Aov::Kind kind) const {
        using Kind = Aov::Kind;
        if (!seen_) return Vec3::Zero();
        switch (kind) {
            case Kind::albedo:
                return albedo();
            case Kind::depth:
                return Vec3::Constant(hit_.t);
            case Kind::position:
                return point_.position;
            case Kind::uv:
                return {point_.uv.x(), point_.uv.y(), 0};
            case Kind::geo_normal:
                return point_.geometric_normal;
            case Kind::sh_normal:
                return point_.frame.n;
            case Kind::prim_index:
                return Vec3::Constant(static_cast<float>(hit_.primitive));
            case Kind::shape_index:
                return Vec3::Constant(static_cast<float>(hit_.shape));
        }
        return Vec3::Zero();
    }

  private:
    Vec3 albedo() const {
        const int model = scene_.geometry.shapes[point_.shape].bsdf;
        if (model < 0) return Vec3::Zero();
        const ShadingPoint at{&w_, point_.uv, scene_.bsdfs.data(), true};
        BsdfValue value;
        if (!bsdf_evaluate(scene_.bsdfs[model], at, point_.frame.to_local(-ray_.direction), Vec3::UnitZ(), value))
            return Vec3::Zero();
        const Float4 reflectance = value.f.m[0] * pi_f;
        Float4 xyz = splat(0);
        for (int lane = 0; lane < wavelengths_per_path; ++lane)
            xyz += scene_.matching->xyz(w_.node[lane]) * (0.25f * reflectance[lane]);
        // White under the uniform spectrum is to be white.
        static const Vec3 white(1.2048f, 0.9483f, 0.9087f);
        return xyz_to_srgb(Vec3(xyz[0], xyz[1], xyz[2])).cwiseQuotient(white);
    }

    const Scene& scene_;
    const Wavelengths& w_;
    Ray ray_;
    Hit hit_;
    SurfacePoint point_;
    bool seen_ = false;
};

}  // namespace

std::string kinds_of_aovs() {
    return fmt::format("{}", fmt::join(kind_names(), ", "));
}

std::vector<Aov> aovs_of(const Properties& node) {
    std::vector<Aov> aovs;
    const SourceLocation where = node.location_of("aovs");
    const std::vector<std::string> names = kind_names();
    for (const std::string& item : split(node.string("aovs"), ", \t\n")) {
        const std::vector<std::string> pair = split(item, ":");
        if (pair.size() != 2)
            throw input_error(where, fmt::format("\"{}\" is no name:kind", item), "", "write \"depth:depth\"");
        const auto kind = std::find(names.begin(), names.end(), pair[1]);
        if (kind == names.end())
            throw input_error(where, fmt::format("unknown kind \"{}\" of aov", pair[1]), "",
                              did_you_mean(pair[1], names));
        for (const char* taken : {"S0", "S1", "S2", "S3", "variance"})
            if (pair[0] == taken)
                throw input_error(where, fmt::format("the picture has a layer \"{}\" already", taken), "",
                                  "choose another name");
        for (const Aov& other : aovs)
            if (other.name == pair[0]) throw input_error(where, fmt::format("two aovs are named \"{}\"", pair[0]));
        aovs.push_back({pair[0], static_cast<Aov::Kind>(kind - names.begin())});
    }
    return aovs;
}

std::vector<ImageLayer> aov_layers(const Scene& scene, const FilmSettings& film, const Sensor& sensor, int samples,
                                   std::uint64_t seed) {
    const std::vector<Aov> aovs = aovs_of_scene(scene);
    if (aovs.empty() || sensor.is_meter()) return {};
    samples = std::min(samples, most_samples);
    const auto pixels = static_cast<std::size_t>(film.crop_width) * film.crop_height;
    std::vector<ImageLayer> layers;
    for (const Aov& aov : aovs)
        for (const char* channel = info_of(aov).channels; *channel; ++channel)
            layers.push_back({fmt::format("{}.{}", aov.name, *channel), std::vector<float>(pixels)});

    parallel_for(0, static_cast<std::ptrdiff_t>(pixels), [&](std::ptrdiff_t pixel) {
        const int x = film.crop_x + static_cast<int>(pixel % film.crop_width);
        const int y = film.crop_y + static_cast<int>(pixel / film.crop_width);
        std::vector<double> sums(layers.size());
        double weights = 0;
        for (int s = 0; s < samples; ++s) {
            Sampler sampler(
                static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(film.width) + static_cast<std::uint32_t>(x),
                static_cast<std::uint32_t>(s), seed);
            const auto [offset, weight] = film.filter.sample(sampler.next2());
            const Vec2 lens = sampler.next2();
            const Wavelengths w = Wavelengths::sample(sampler.next());
            Sensor::CameraRay camera =
                sensor.ray({(x + 0.5f + offset.x()) / film.width, (y + 0.5f + offset.y()) / film.height}, lens);
            if (scene.geometry.moves()) camera.ray.time = sampler.next();
            const FirstHit first(scene, camera, w);
            std::size_t layer = 0;
            for (const Aov& aov : aovs) {
                const Vec3 value = first.value(aov.kind);
                for (int c = 0; info_of(aov).channels[c]; ++c) sums[layer++] += weight * value[c];
            }
            weights += weight;
        }
        // See Film::divisor().
        const double divisor = std::max<double>(weights, 0.5 * film.filter.mean_weight() * samples);
        for (std::size_t layer = 0; layer < layers.size(); ++layer)
            layers[layer].values[pixel] = static_cast<float>(sums[layer] / divisor);
    });
    return layers;
}

}  // namespace patina::render
