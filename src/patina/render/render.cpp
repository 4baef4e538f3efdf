#include "patina/render/render.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/render/aov.h"
#include "patina/render/delta_light_at_sensor.h"
#include "patina/render/non_finite_samples.h"
#include "patina/render/picture_parts.h"
#include "patina/render/plugins.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

constexpr int tile_size = 16;
constexpr int block_size = 64;    // samples that an integrator may trace side by side
constexpr int largest_pass = 16;  // samples per pixel between two looks at the clock and the stop sign

constexpr int unlimited_samples = 1 << 30;
constexpr double longest_silence_s = 2;  // without a look at the stop sign, if a sample per pixel takes no longer

// Fewer samples than this tell too little of the spread to stop by it.
constexpr int fewest_for_noise = 16;

// A share of samples that are not finite above which the picture is not to be trusted.
constexpr double tolerated_non_finite = 1e-4;

// Refuses a film that the machine's memory cannot hold: the sums of its samples and the developed picture.
void expect_room(const FilmSettings& film, const Scene& scene, const RenderOptions& options) {
    const double pixels = static_cast<double>(film.crop_width) * film.crop_height;
    const double needed = pixels * 2 * static_cast<double>(film.bin_edges_nm.size() + 4) * sizeof(Float4);
    const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    if (needed < 0.9 * memory) return;
    const std::string problem = fmt::format("a film of {} x {} pixels is too large", film.crop_width, film.crop_height);
    const std::string why = fmt::format("it takes {:.1f} GB, the machine has {:.1f}", needed * 1e-9, memory * 1e-9);
    if (options.size) throw Error(ErrorKind::usage, fmt::format("{} ({}); take a smaller --size", problem, why));
    const auto node = scene.sensor_node->only_child("film");
    throw input_error(node ? node->where : scene.sensor_node->where, problem, why, "render windows of it with --crop");
}

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
    expect_room(film, scene, options);
    return film;
}

std::unique_ptr<Integrator> integrator_of(const Scene& scene, const RenderOptions& options) {
    const auto& node = scene.integrator_node;
    if (!options.integrator && node) return build_integrator(*node);
    Properties chosen;
    chosen.category = "integrator";
    chosen.type = options.integrator.value_or(scene.media.empty() ? "path" : "volumetric");
    if (node) {
        // Keep what the scene says about its own integrator where the other knows it too.
        const PluginDescriptor& plugin = expect_plugin(chosen);
        for (const auto& entry : wrapped_integrator(*node).entries)
            if (std::any_of(plugin.parameters.begin(), plugin.parameters.end(),
                            [&](const ParameterDescriptor& p) { return p.name == entry.name; }))
                chosen.entries.push_back(entry);
    }
    return build_integrator(chosen);
}

// Do all numbers vanish?
bool all_zero(const StokesPacket& s) {
    for (int i = 0; i < 16; ++i)
        if (s[i] != 0) return false;
    return true;
}

std::string neumann_name(int term, int terms) {
    return term < terms ? fmt::format("neumann_{:02}", term) : "neumann_rest";
}

// What is asked for, and the terms of the Neumann series: paths by their number of scattering events.
std::vector<LightPathExpression> expressions_of(const RenderOptions& options) {
    constexpr int most_terms = 100;
    std::vector<LightPathExpression> all;
    for (const LightPathOutput& output : options.light_paths) all.push_back({output.name, output.expression});
    if (options.neumann_terms < 0 || options.neumann_terms > most_terms)
        throw Error(ErrorKind::usage, fmt::format("{} terms of the Neumann series are out of range 0 .. {}",
                                                  options.neumann_terms, most_terms));
    for (int term = 0; options.neumann_terms > 0 && term <= options.neumann_terms; ++term)
        all.push_back({neumann_name(term, options.neumann_terms),
                       "E" + std::string(term, '.') + (term < options.neumann_terms ? "L" : ".*L")});
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (all[i].name == all[j].name)
                throw Error(ErrorKind::usage, fmt::format("two pictures are named \"{}\"", all[i].name));
    return all;
}

class Renderer {
  public:
    Renderer(const Scene& scene, const RenderOptions& options, const JobControl& control)
        : scene_(scene),
          settings_(film_of(scene, options)),
          sensor_(
              build_sensor(*scene.sensor_node, settings_.width, settings_.height, scene.geometry, scene.sensor_shape)),
          integrator_(integrator_of(scene, options)),
          expressions_(expressions_of(options)),
          classes_(expressions_),
          film_(settings_, *scene.matching, true, sums_weights()),
          seed_(options.seed.value_or(scene.seed)) {
        if (!expressions_.empty() && !integrator_->knows_paths())
            throw Error(ErrorKind::usage,
                        "this integrator does not follow single paths: no light-path expressions and "
                        "no Neumann series with it; use path or bidirectional");
        if (!scene.media.empty() && !integrator_->follows_media())
            throw Error(ErrorKind::usage, "the scene has media, which this integrator does not follow; use volumetric");
        if (!expressions_.empty())
            for (int c = 0; c < classes_.class_count(); ++c)
                class_films_.emplace_back(settings_, *scene.matching, false, sums_weights());
        integrator_->prepare(problem(), control);
    }

    // Adds the samples [first, last) to every pixel. The sums do not depend on how the samples are shared among passes.
    void add_pass(int first, int last) {
        if (!integrator_->splats()) return add_samples(first, last);
        for (int sample = first; sample < last; ++sample) {
            add_samples(sample, sample + 1);
            if (!Film::batch_ends(sample + 1)) continue;
            for (std::size_t pixel = 0; pixel < film_.pixel_count(); ++pixel) film_.end_batch(pixel, sample + 1);
        }
    }
    double relative_noise() const { return film_.relative_noise(); }
    // A view of what the samples so far have left.
    RenderState state(int samples) {
        RenderState state{samples, non_finite_.count(), non_finite_.places(), {}};
        const auto add = [&](Film& film) {
            for (const std::span<std::byte> memory : film.memory())
                if (!memory.empty()) state.films.push_back(memory);
        };
        add(film_);
        for (Film& film : class_films_) add(film);
        return state;
    }
    void put_back(const RenderState& state) { non_finite_.set(state.non_finite, state.non_finite_places); }
    std::map<std::string, std::string> integrator_notes() const { return integrator_->notes(); }
    std::uint64_t seed() const { return seed_; }
    const NonFiniteSamples& non_finite() const { return non_finite_; }
    std::size_t pixel_count() const { return film_.pixel_count(); }
    std::vector<ImageLayer> layers(int samples) const { return aov_layers(scene_, settings_, sensor_, samples, seed_); }
    Pictures develop() const {
        Pictures pictures{film_.develop(), {}, {}};
        if (expressions_.empty()) return pictures;

        // The whole, and each part, is the exact sum of its classes of paths.
        std::vector<StokesImage> classes;
        for (const Film& film : class_films_) classes.push_back(film.develop());
        align_parts(classes);
        StokesImage empty = classes.front();
        std::fill(empty.spectral.begin(), empty.spectral.end(), 0.0f);
        std::fill(empty.rgb.begin(), empty.rgb.end(), 0.0f);
        empty.variance.clear();
        pictures.whole.spectral = empty.spectral;
        pictures.whole.rgb = empty.rgb;
        for (const StokesImage& image : classes) add_part(pictures.whole, image);
        for (int e = 0; e < static_cast<int>(expressions_.size()); ++e) {
            StokesImage part = empty;
            for (int c = 0; c < classes_.class_count(); ++c)
                if (classes_.belongs(c, e)) add_part(part, classes[c]);
            part.metadata["light_paths"] = expressions_[e].text;
            pictures.parts.emplace_back(expressions_[e].name, std::move(part));
        }
        return pictures;
    }

    // From mean radiance to what a meter measures; the picture then says what it holds.
    void calibrate(Pictures& pictures) const {
        if (!sensor_.is_meter()) return;
        const auto scale = [&](StokesImage& image) {
            const auto factor = static_cast<float>(sensor_.scale);
            for (float& value : image.spectral) value *= factor;
            for (float& value : image.rgb) value *= factor;
            for (float& value : image.variance) value *= factor * factor;
            image.metadata["quantity"] = names_of(sensor_.quantity).name;
            image.metadata["unit"] = names_of(sensor_.quantity).spectral_unit;
        };
        scale(pictures.whole);
        for (auto& [name, part] : pictures.parts) scale(part);
        pictures.measurement = measure(pictures.whole, sensor_.quantity, sensor_.kind == Sensor::Kind::far_field);
        pictures.measurement->exposure_s = sensor_.exposure_s;
    }

  private:
    // Splats share their pixels with samples of other places: then the mean of the filter's weights is divided by.
    bool sums_weights() const { return settings_.filter.has_lobes() && !integrator_->splats(); }
    TransportProblem problem() const { return {scene_, sensor_, classes_}; }

    void add_samples(int first, int last) {
        const int across = (settings_.crop_width + tile_size - 1) / tile_size;
        const int down = (settings_.crop_height + tile_size - 1) / tile_size;
        const std::ptrdiff_t tiles = static_cast<std::ptrdiff_t>(across) * down;
        // Splats are kept until a batch of tiles is done, and then added in the tiles' order.
        const std::ptrdiff_t batch = integrator_->splats() ? 64 : tiles;
        for (std::ptrdiff_t begin = 0; begin < tiles; begin += batch) {
            const std::ptrdiff_t end = std::min(begin + batch, tiles);
            std::vector<std::vector<Splat>> splats(integrator_->splats() ? end - begin : 0);
            parallel_for(begin, end, [&](std::ptrdiff_t tile) {
                SampleBlock block(classes_.class_count());
                std::vector<Splat>* kept = integrator_->splats() ? &splats[tile - begin] : nullptr;
                const int x0 = static_cast<int>(tile % across) * tile_size,
                          y0 = static_cast<int>(tile / across) * tile_size;
                for (int y = y0; y < std::min(y0 + tile_size, settings_.crop_height); ++y)
                    for (int x = x0; x < std::min(x0 + tile_size, settings_.crop_width); ++x)
                        for (int sample = first; sample < last; ++sample) {
                            block.places[block.count++] = {x, y, sample};
                            if (block.count == block_size) trace(block, kept);
                        }
                trace(block, kept);
            });
            for (const auto& of_tile : splats)
                for (const Splat& splat : of_tile) add_splat(splat);
        }
    }

    // Samples that are traced side by side: the pixel of the window and the number of each.
    struct SampleBlock {
        struct Place {
            int x, y, sample;
        };
        explicit SampleBlock(int classes) : records(block_size, PathRecord(classes)), samples(block_size) {}
        int count = 0;
        std::array<Place, block_size> places;
        std::array<float, block_size> weights;  // by the filter
        std::vector<PathRecord> records;
        std::vector<CameraSample> samples;
    };

    std::size_t window_pixel(const SampleBlock::Place& place) const {
        return static_cast<std::size_t>(place.y) * settings_.crop_width + place.x;
    }

    // Traces and empties a block.
    void trace(SampleBlock& block, std::vector<Splat>* splats) {
        for (int first = 0; first < block.count; first += wide_lanes)
            begin_samples(block, first, std::min(first + wide_lanes, block.count));
        integrator_->trace_block(problem(), std::span(block.samples).first(block.count));
        for (int i = 0; i < block.count; ++i) {
            const CameraSample& sample = block.samples[i];
            PathRecord& record = *sample.record;
            if (sensor_.is_meter())
                record.add(delta_light_at_sensor(scene_, sensor_, sample.camera, sample.wavelengths),
                           classes_.path_class(LightPathClassifier::eye));
            const bool added = add_sample(block.places[i], record, sample.wavelengths, block.weights[i]);
            const int done = block.places[i].sample + 1;
            if (!splats && Film::batch_ends(done)) film_.end_batch(window_pixel(block.places[i]), done);
            if (splats && added) splats->insert(splats->end(), record.splats.begin(), record.splats.end());
        }
        block.count = 0;
    }

    // Draws place on the film, place on the lens and wavelengths for as many samples as there are lanes.
    void begin_samples(SampleBlock& block, int first, int last) const {
        enum CameraDraw : std::uint32_t { on_film, on_lens, hue, camera_draws };
        SamplerBlock draws;
        for (int i = first; i < last; ++i) {
            const auto& [x, y, sample] = block.places[i];
            if (i == 0 || x != block.places[i - 1].x) film_.prefetch(window_pixel(block.places[i]));
            const auto pixel =
                static_cast<std::uint32_t>(settings_.crop_y + y) * static_cast<std::uint32_t>(settings_.width) +
                static_cast<std::uint32_t>(settings_.crop_x + x);
            block.samples[i].sampler = Sampler(pixel, static_cast<std::uint32_t>(sample), seed_);
            draws.set(i - first, block.samples[i].sampler);
        }
        FloatLanes film_x, film_y, lens_x, lens_y, hue_x, hue_y;
        draws.next2(on_film, film_x, film_y);
        if (sensor_.uses_lens()) draws.next2(on_lens, lens_x, lens_y);
        draws.next2(hue, hue_x, hue_y);
        for (int i = first; i < last; ++i) {
            const int k = i - first;
            CameraSample& s = block.samples[i];
            const auto [offset, weight] = settings_.filter.sample({film_x[k], film_y[k]});
            block.weights[i] = weight;
            film_x[k] = (settings_.crop_x + block.places[i].x + 0.5f + offset.x()) / settings_.width;
            film_y[k] = (settings_.crop_y + block.places[i].y + 0.5f + offset.y()) / settings_.height;
            // The hero's quarter of the range and the place in it are drawn apart: all four wavelengths share the
            // latter.
            s.wavelengths = Wavelengths::sample(0.25f * (std::floor(4 * hue_y[k]) + hue_x[k]));
            s.sampler.seek(camera_draws);
            s.record = &block.records[i];
            s.record->begin();
        }
        Sensor::CameraRay* rays[wide_lanes];
        for (int i = first; i < last; ++i) rays[i - first] = &block.samples[i].camera;
        sensor_.rays(film_x, film_y, lens_x, lens_y, last - first, rays);
        if (scene_.geometry.moves())
            for (int i = first; i < last; ++i) block.samples[i].camera.ray.time = block.samples[i].sampler.next();
    }

    // False: the sample is left out, for it is not finite.
    bool add_sample(const SampleBlock::Place& place, const PathRecord& record, const Wavelengths& w, float weight) {
        const StokesPacket total = record.total();
        StokesPacket probe = total;
        for (const Splat& splat : record.splats) probe += splat.stokes * 0.0f;
        if (!all_finite(probe)) {
            non_finite_.note(settings_.crop_x + place.x, settings_.crop_y + place.y, place.sample);
            return false;
        }
        const std::size_t pixel = window_pixel(place);
        add_to(film_, pixel, total, w, record.hit, weight);
        for (std::size_t c = 0; c < class_films_.size(); ++c)
            add_to(class_films_[c], pixel, record.of_class(static_cast<int>(c)), w, record.hit, weight);
        return true;
    }

    void add_to(Film& film, std::size_t pixel, const StokesPacket& light, const Wavelengths& w, bool hit,
                float weight) {
        if (sums_weights()) return film.add_weighted(pixel, light, w, hit, weight);
        if (settings_.filter.has_lobes()) weight /= settings_.filter.mean_weight();
        if (&film == &film_ || !all_zero(light)) film.add_light(pixel, weight == 1 ? light : light * weight, w);
        film.add_count(pixel, hit);
    }

    // Gives each pixel of the window its share by the reconstruction filter. There is one path from the lamps for every
    // sample of the window, and each estimates the light on the whole film.
    void add_splat(const Splat& splat) {
        const float share = static_cast<float>(static_cast<double>(settings_.width) * settings_.height /
                                               static_cast<double>(film_.pixel_count()));
        const float x = splat.film.x() * settings_.width - 0.5f - settings_.crop_x,
                    y = splat.film.y() * settings_.height - 0.5f - settings_.crop_y;
        const float reach = settings_.filter.reach();
        const int x0 = std::max(0, static_cast<int>(std::ceil(x - reach))),
                  x1 = std::min(settings_.crop_width - 1, static_cast<int>(std::floor(x + reach)));
        const int y0 = std::max(0, static_cast<int>(std::ceil(y - reach))),
                  y1 = std::min(settings_.crop_height - 1, static_cast<int>(std::floor(y + reach)));
        for (int row = y0; row <= y1; ++row)
            for (int column = x0; column <= x1; ++column) {
                const StokesPacket light = splat.stokes * (share * settings_.filter.value(Vec2(x - column, y - row)));
                const std::size_t place = static_cast<std::size_t>(row) * settings_.crop_width + column;
                film_.add_light(place, light, splat.wavelengths);
                if (!class_films_.empty()) class_films_[splat.path_class].add_light(place, light, splat.wavelengths);
            }
    }

    const Scene& scene_;
    FilmSettings settings_;
    Sensor sensor_;
    std::unique_ptr<Integrator> integrator_;
    std::vector<LightPathExpression> expressions_;
    LightPathClassifier classes_;
    Film film_;
    std::vector<Film> class_films_;  // one for each class of paths; empty when no parts are asked for
    std::uint64_t seed_;
    NonFiniteSamples non_finite_;
};

// Ratios of the energies of successive terms of the Neumann series, by sums of intensity over the picture.
void note_transport_norm(const Pictures& pictures, int terms, std::map<std::string, std::string>& metadata) {
    double before = 0, norm = 0;
    for (int term = 0; term < terms; ++term) {
        const auto part = std::find_if(pictures.parts.begin(), pictures.parts.end(),
                                       [&](const auto& p) { return p.first == neumann_name(term, terms); });
        const StokesImage& image = part->second;
        double energy = 0;
        for (std::size_t i = 0; i < image.spectral.size(); i += 4) energy += image.spectral[i];
        if (term > 0 && before > 0) {
            metadata[fmt::format("neumann_ratio_{:02}", term - 1)] = fmt::format("{:.6g}", energy / before);
            // How much of the lamps the camera happens to see is no property of the transport.
            if (term > 1) norm = std::max(norm, energy / before);
        }
        before = energy;
    }
    if (terms > 2) metadata["neumann_norm"] = fmt::format("{:.6g}", norm);
}

// Passes grow from one sample so that a first picture, and a stop, come soon; they end at the same counts of samples
// wherever a render began.
int end_of_pass(int done, int total) {
    const int doubled = static_cast<int>(std::bit_ceil(static_cast<unsigned>(done) + 1));
    const int end = done < largest_pass ? doubled : (done / largest_pass + 1) * largest_pass;
    return std::min(end, total);
}

// Puts back what a checkpoint has kept; returns its samples.
int take_up(Renderer& renderer, const RenderCheckpoint& checkpoint, int total) {
    RenderState state = renderer.state(0);
    if (!checkpoint.load || !checkpoint.load(state)) return 0;
    if (state.samples > total)
        throw Error(ErrorKind::usage,
                    fmt::format("the render to go on with has {} samples per pixel already, more than "
                                "the {} asked for",
                                state.samples, total));
    renderer.put_back(state);
    return state.samples;
}

struct Outcome {
    int samples = 0;
    bool stopped = false;  // before what was asked for was reached
};

// Adds passes until the samples, the time or the noise asked for are reached, or someone asks to stop.
Outcome add_passes(Renderer& renderer, const RenderOptions& options, int total, const JobControl& control,
                   const RenderCheckpoint& checkpoint) {
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const int begun = take_up(renderer, checkpoint, total);
    Outcome outcome{begun, false};
    int& done = outcome.samples;
    bool finished = done == total;
    double saved = 0;
    while (!finished && !outcome.stopped) {
        // Take a part of the pass when it is long, so that a stop is heard.
        const double affordable = longest_silence_s * std::max(1, done - begun) / std::max(elapsed(), 1e-6);
        const int pass = end_of_pass(done, total);
        const int last = static_cast<int>(std::min<double>(pass, done + std::floor(std::max(affordable, 1.0))));
        renderer.add_pass(done, last);
        done = last;
        control.report({"rendering", done, total == unlimited_samples ? 0 : total, fmt::format("{} spp", done)});

        // Look at the clock, at the noise and at the stop sign.
        finished = done == total || (options.time_limit_seconds && elapsed() >= *options.time_limit_seconds);
        if (options.noise_target && done == pass && done >= fewest_for_noise)
            finished |= renderer.relative_noise() <= *options.noise_target;
        outcome.stopped = !finished && control.stop_requested();
        const bool due = elapsed() >= saved + checkpoint.interval_seconds;
        if (checkpoint.save && (finished ? checkpoint.save_finished : outcome.stopped || due)) {
            checkpoint.save(renderer.state(done));
            saved = elapsed();
        }
    }
    return outcome;
}

void expect_finite(const Renderer& renderer, int samples_per_pixel) {
    const auto count = renderer.non_finite().count();
    const double samples = static_cast<double>(renderer.pixel_count()) * samples_per_pixel;
    if (count > tolerated_non_finite * samples)
        throw Error(ErrorKind::runtime, fmt::format("{} of {:.0f} samples are not finite, first at {}", count, samples,
                                                    renderer.non_finite().text()));
}

}  // namespace

Pictures render_parts(const Scene& scene, const RenderOptions& options, const JobControl& control,
                      const RenderCheckpoint& checkpoint) {
    const int wanted = options.samples_per_pixel.value_or(scene.samples_per_pixel);
    const bool open_ended = !options.samples_per_pixel && (options.time_limit_seconds || options.noise_target);
    if (wanted < 1) throw Error(ErrorKind::usage, fmt::format("samples per pixel must be 1 or more, not {}", wanted));
    Renderer renderer(scene, options, control);
    const Outcome outcome = add_passes(renderer, options, open_ended ? unlimited_samples : wanted, control, checkpoint);
    expect_finite(renderer, outcome.samples);

    Pictures pictures = renderer.develop();
    pictures.whole.layers = renderer.layers(outcome.samples);
    std::map<std::string, std::string>& metadata = pictures.whole.metadata;
    metadata = scene.notes;
    metadata.merge(renderer.integrator_notes());
    metadata["samples_per_pixel"] = fmt::format("{}", outcome.samples);
    metadata["seed"] = fmt::format("{}", renderer.seed());
    if (outcome.samples > 1) metadata["relative_noise"] = fmt::format("{:.3g}", renderer.relative_noise());
    const auto non_finite = renderer.non_finite().count();
    metadata["non_finite_samples"] =
        non_finite ? fmt::format("{} at {}", non_finite, renderer.non_finite().text()) : "0";
    if (outcome.stopped) metadata["stopped"] = "yes";
    for (auto& [name, part] : pictures.parts) part.metadata.insert(metadata.begin(), metadata.end());
    renderer.calibrate(pictures);
    note_transport_norm(pictures, options.neumann_terms, metadata);
    return pictures;
}

StokesImage render(const Scene& scene, const RenderOptions& options, const JobControl& control) {
    return render_parts(scene, options, control).whole;
}

}  // namespace patina::render
