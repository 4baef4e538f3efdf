#pragma once
// The film: what it is (size, window, filter, spectral bins) and the sums that samples leave on it.

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include "patina/core/properties.h"
#include "patina/core/stokes_image.h"
#include "patina/render/packet.h"
#include "patina/render/spectrum.h"
#include "patina/render/vec.h"

namespace patina::render {

// A reconstruction filter sampled in proportion to its value, so that each sample belongs to one pixel with weight 1
// (Ernst, Stamminger & Greiner 2006, Filter importance sampling). Filters with negative lobes cannot be.
class PixelFilter {
  public:
    PixelFilter() = default;  // box of one pixel
    // `box`, `tent`, `gaussian`; throws Error(input) for others.
    explicit PixelFilter(const Properties& node);

    // Offset from the pixel's centre, in pixels.
    Vec2 sample(const Vec2& u) const { return {sample(u.x()), sample(u.y())}; }
    // Density of sample() per square pixel, and the largest offset along x or y that it draws.
    float density(const Vec2& offset) const { return density(offset.x()) * density(offset.y()); }
    float reach() const { return inverse_cdf_.empty() ? 0.5f : inverse_cdf_.back(); }
    const std::string& name() const { return name_; }

  private:
    float sample(float u) const;
    float density(float offset) const;

    std::string name_ = "box";
    std::vector<float> inverse_cdf_;  // offsets at equidistant u; empty for the box
};

struct FilmSettings {
    int width = 768, height = 576;
    int crop_x = 0, crop_y = 0, crop_width = 768, crop_height = 576;
    PixelFilter filter;
    std::vector<double> bin_edges_nm;

    static std::vector<double> default_bins();  // 16 over 380 .. 780 nm
};

// Reads `hdrfilm` (or `specfilm`); formats of files are the writer's business and are accepted unread.
FilmSettings build_film(const Properties& node);

// Sums over the samples of every pixel of the window. Pixels are independent: each may be written by one thread at a
// time.
class Film {
  public:
    Film(const FilmSettings& settings, const ColourMatching& matching, bool with_variance);

    // Adds one path: its Stokes vector at its four wavelengths.
    void add(std::size_t pixel, const StokesPacket& stokes, const Wavelengths& w, bool hit) {
        add_light(pixel, stokes, w);
        add_count(pixel, hit);
    }
    // Announces that a pixel's sums will be wanted soon: a film is too large for the processor's caches.
    void prefetch(std::size_t pixel) const {
        const Float4* sums = &sums_[pixel * stride_];
        for (std::size_t slot = 0; slot < stride_; slot += 4) __builtin_prefetch(sums + slot, 1);
    }
    // Counts a path that brought nothing (more).
    void add_count(std::size_t pixel, bool hit) {
        sums_[pixel * stride_ + bins_ + 4] += Float4{1.0f, hit ? 1.0f : 0.0f, 0.0f, 0.0f};
    }
    // Adds light without counting a path.
    void add_light(std::size_t pixel, const StokesPacket& stokes, const Wavelengths& w) {
        Float4* sums = &sums_[pixel * stride_];
        StokesPacket colour{};
        const StokesPacket spectral = by_wavelength(stokes);
        add_wavelength<0>(sums, spectral, w, colour);
        add_wavelength<1>(sums, spectral, w, colour);
        add_wavelength<2>(sums, spectral, w, colour);
        add_wavelength<3>(sums, spectral, w, colour);
        sums[bins_] += quarter(colour, 0);
        sums[bins_ + 1] += quarter(colour, 1);
        sums[bins_ + 2] += quarter(colour, 2);
        sums[bins_ + 3] += quarter(colour, 3);
    }

    // Is `samples` a count of samples of a pixel after which a batch ends? There are up to `most_batches` of equal
    // size, then they are joined two by two.
    static bool batch_ends(int samples) { return samples % batch_size(samples) == 0; }
    // Ends a batch, when so many samples are done: the spread of the batches' mean luminances tells the variance,
    // whatever light came from other pixels' samples, and sees most of what stratified samples gain.
    void end_batch(std::size_t pixel, int samples);

    // Root mean square over the pixels of the standard error of the luminance, over the picture's mean luminance.
    double relative_noise() const;
    StokesImage develop() const;
    // All that the film knows, to be kept and put back. Bytes of the machine's own order.
    std::array<std::span<std::byte>, 2> memory() {
        return {std::as_writable_bytes(std::span(sums_)), std::as_writable_bytes(std::span(batches_))};
    }
    std::size_t pixel_count() const { return static_cast<std::size_t>(settings_.crop_width) * settings_.crop_height; }

  private:
    // What a sample within a nanometre contributes to.
    struct Nanometre {
        Float4 xyz;        // of a quarter of its light, for it is one of four: (X, Y, Z, 0)
        int bin;           // at the nanometre's start, -1 before the first
        float upper_edge;  // where the next bin begins within this nanometre, or infinity
    };
    // The mean of four wavelengths estimates the integral over the visible range; each bin takes its share.
    template <int lane>
    void add_wavelength(Float4* sums, const StokesPacket& spectral, const Wavelengths& w, StokesPacket& colour) const {
        const Nanometre& at = nanometres_[w.node[lane]];
        const int bin = at.bin + (w.nm[lane] >= at.upper_edge ? 1 : 0);
        if (bin >= 0 && bin < bins_) sums[bin] += quarter(spectral, lane) * bin_weight_[bin];
        colour += spread(at.xyz) * repeated<4 * lane>(spectral);
    }

    FilmSettings settings_;
    int bins_;
    std::size_t stride_;
    static constexpr int most_batches = 8;
    static int batch_size(int samples) {
        return samples <= most_batches ? 1
                                       : static_cast<int>(std::bit_ceil(static_cast<unsigned>(samples)) / most_batches);
    }
    // Variances of the mean luminances of the Stokes components; infinite before the second batch.
    std::array<double, 4> variances_of_means(std::size_t pixel) const;

    // [pixel][slot]: Stokes vector of each bin; (X, Y, Z, -) of each Stokes component; (samples, hits, batches, samples
    // in them).
    std::vector<Float4> sums_;
    // [pixel][batch]: Y of the Stokes components at the end of the batch, summed from the first sample on. Empty: the
    // variance is not asked for.
    std::vector<Float4> batches_;
    std::vector<float> bin_weight_;  // (visible range / number of wavelengths) / width of the bin
    std::vector<Nanometre> nanometres_;
};

}  // namespace patina::render
