#include "patina/render/render.h"

#include <atomic>
#include <chrono>
#include <mutex>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

constexpr int tile_size = 16;
constexpr int largest_pass = 16;  // samples per pixel between two looks at the clock and the stop sign

// A share of samples that are not finite above which the picture is not to be trusted.
constexpr double tolerated_non_finite = 1e-4;

FilmSettings film_of(const Scene& scene, const RenderOptions& options) {
    FilmSettings film = scene.film;
    if (options.size) {
        const auto [width, height] = *options.size;
        if (width < 1 || height < 1 || width > 65536 || height > 65536)
            throw Error(ErrorKind::usage, fmt::format("size {} x {} is out of range", width, height));
        film.width = film.crop_width = width;
        film.height = film.crop_height = height;
        film.crop_x = film.crop_y = 0;
    }
    if (options.crop) {
        const auto [x0, y0, x1, y1] = *options.crop;
        if (x0 < 0 || y0 < 0 || x1 <= x0 || y1 <= y0 || x1 > film.width || y1 > film.height)
            throw Error(ErrorKind::usage, fmt::format("crop {},{},{},{} does not fit the film of {} x {}", x0, y0, x1,
                                                      y1, film.width, film.height));
        film.crop_x = x0, film.crop_y = y0, film.crop_width = x1 - x0, film.crop_height = y1 - y0;
    }
    if (!options.bin_edges_nm.empty()) film.bin_edges_nm = options.bin_edges_nm;
    const auto& edges = film.bin_edges_nm;
    if (edges.size() < 2 || edges.front() < wavelength_min_nm || edges.back() > wavelength_max_nm)
        throw Error(ErrorKind::usage, "spectral bins must lie within 380 .. 780 nm");
    for (std::size_t b = 1; b < edges.size(); ++b)
        if (!(edges[b] - edges[b - 1] >= 1)) throw Error(ErrorKind::usage, "spectral bins must be 1 nm wide or more");
    return film;
}

std::unique_ptr<Integrator> integrator_of(const Scene& scene, const RenderOptions& options) {
    const auto& node = scene.integrator_node;
    if (!options.integrator && node) return build_integrator(*node);
    Properties chosen;
    chosen.category = "integrator";
    chosen.type = options.integrator.value_or("path");
    if (node) chosen.entries = (node->type == "stokes" ? *node->only_child("integrator") : *node).entries;
    return build_integrator(chosen);
}

// Samples that came out as NaN or infinity: how many, and where the first ones were.
class NonFiniteSamples {
  public:
    void note(int x, int y, int sample) {
        count_.fetch_add(1, std::memory_order_relaxed);
        const std::lock_guard lock(mutex_);
        if (places_.size() < 8) places_.push_back(fmt::format("({}, {}) sample {}", x, y, sample));
    }
    std::int64_t count() const { return count_.load(); }
    std::string places() const { return fmt::format("{}", fmt::join(places_, "; ")); }

  private:
    std::atomic<std::int64_t> count_{0};
    std::mutex mutex_;
    std::vector<std::string> places_;
};

bool all_finite(const StokesPacket& s) {
    // Zero times a finite number is zero, times any other it is NaN.
    const StokesPacket probe = s * 0.0f;
    float total = 0;
    for (int i = 0; i < 16; ++i) total += probe[i];
    return total == 0;
}

class Renderer {
  public:
    Renderer(const Scene& scene, const RenderOptions& options)
        : scene_(scene),
          settings_(film_of(scene, options)),
          sensor_(build_sensor(*scene.sensor_node, settings_.width, settings_.height)),
          integrator_(integrator_of(scene, options)),
          film_(settings_, *scene.matching),
          seed_(options.seed.value_or(scene.seed)) {}

    // Adds the samples [first, last) to every pixel.
    void add_pass(int first, int last) {
        const int across = (settings_.crop_width + tile_size - 1) / tile_size;
        const int down = (settings_.crop_height + tile_size - 1) / tile_size;
        parallel_for(0, static_cast<std::ptrdiff_t>(across) * down, [&](std::ptrdiff_t tile) {
            const int x0 = static_cast<int>(tile % across) * tile_size,
                      y0 = static_cast<int>(tile / across) * tile_size;
            for (int y = y0; y < std::min(y0 + tile_size, settings_.crop_height); ++y)
                for (int x = x0; x < std::min(x0 + tile_size, settings_.crop_width); ++x)
                    for (int sample = first; sample < last; ++sample) add_sample(x, y, sample);
        });
    }
    double relative_noise() const { return film_.relative_noise(); }
    std::uint64_t seed() const { return seed_; }
    const NonFiniteSamples& non_finite() const { return non_finite_; }
    std::size_t pixel_count() const { return film_.pixel_count(); }
    StokesImage develop() const { return film_.develop(); }

  private:
    void add_sample(int x, int y, int sample) {
        const int film_x = settings_.crop_x + x, film_y = settings_.crop_y + y;
        const auto pixel = static_cast<std::uint32_t>(film_y) * static_cast<std::uint32_t>(settings_.width) +
                           static_cast<std::uint32_t>(film_x);
        Sampler sampler(pixel, static_cast<std::uint32_t>(sample), seed_);

        // Place on the film, place on the lens, wavelengths.
        const Vec2 offset = settings_.filter.sample(sampler.next2());
        const Vec2 film((film_x + 0.5f + offset.x()) / settings_.width,
                        (film_y + 0.5f + offset.y()) / settings_.height);
        const Vec2 lens = sensor_.aperture_radius > 0 ? sampler.next2() : Vec2::Zero();
        // The hero's quarter of the range and the place in it are drawn apart: all four wavelengths share the latter.
        const Vec2 hue = sampler.next2();
        const Wavelengths wavelengths = Wavelengths::sample(0.25f * (std::floor(4 * hue.y()) + hue.x()));

        const PathResult path = integrator_->trace(scene_, sensor_.ray(film, lens), wavelengths, sampler);
        if (!all_finite(path.stokes)) {
            non_finite_.note(film_x, film_y, sample);
            return;
        }
        film_.add(static_cast<std::size_t>(y) * settings_.crop_width + x, path.stokes, wavelengths, path.hit);
    }

    const Scene& scene_;
    FilmSettings settings_;
    Sensor sensor_;
    std::unique_ptr<Integrator> integrator_;
    Film film_;
    std::uint64_t seed_;
    NonFiniteSamples non_finite_;
};

// Passes grow from one sample so that a first picture, and a stop, come soon.
int next_pass(int done, int total) {
    return std::min({total, done + largest_pass, std::max(1, 2 * done)});
}

}  // namespace

StokesImage render(const Scene& scene, const RenderOptions& options, const JobControl& control) {
    const int wanted = options.samples_per_pixel.value_or(scene.samples_per_pixel);
    const bool open_ended = !options.samples_per_pixel && (options.time_limit_seconds || options.noise_target);
    if (wanted < 1) throw Error(ErrorKind::usage, fmt::format("samples per pixel must be 1 or more, not {}", wanted));
    const int total = open_ended ? (1 << 30) : wanted;
    Renderer renderer(scene, options);

    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    int done = 0;
    bool stopped = false;
    while (done < total && !stopped) {
        const int last = next_pass(done, total);
        renderer.add_pass(done, last);
        done = last;
        control.report({"rendering", done, open_ended ? 0 : total, fmt::format("{} spp", done)});
        if (options.time_limit_seconds && elapsed() >= *options.time_limit_seconds) break;
        if (options.noise_target && done >= 4 && renderer.relative_noise() <= *options.noise_target) break;
        stopped = control.stop_requested();
    }

    const auto non_finite = renderer.non_finite().count();
    const double samples = static_cast<double>(renderer.pixel_count()) * done;
    if (non_finite > tolerated_non_finite * samples)
        throw Error(ErrorKind::runtime, fmt::format("{} of {:.0f} samples are not finite, first at {}", non_finite,
                                                    samples, renderer.non_finite().places()));
    StokesImage image = renderer.develop();
    image.metadata = scene.notes;
    image.metadata["samples_per_pixel"] = fmt::format("{}", done);
    image.metadata["seed"] = fmt::format("{}", renderer.seed());
    image.metadata["relative_noise"] = fmt::format("{:.3g}", renderer.relative_noise());
    image.metadata["non_finite_samples"] =
        non_finite ? fmt::format("{} at {}", non_finite, renderer.non_finite().places()) : "0";
    if (stopped) image.metadata["stopped"] = "yes";
    return image;
}

}  // namespace patina::render
