#pragma once
// The film: what it is (size, window, filter, spectral bins) and the sums that samples leave on it.

#include <array>
#include <bit>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "patina/core/properties.h"
#include "patina/core/stokes_image.h"
#include "patina/render/packet.h"
#include "patina/render/spectrum.h"
#include "patina/render/vec.h"

namespace patina::render {

// A reconstruction filter sampled in proportion to its modulus, so that each sample belongs to one pixel (Ernst,
// Stamminger & Greiner 2006, Filter importance sampling) with weight 1, or in a negative lobe -1.
class PixelFilter {
  public:
    PixelFilter() = default;  // box of one pixel
    // `box`, `tent`, `gaussian`, `mitchell`, `catmullrom`, `lanczos`; throws Error(input) for others.
    explicit PixelFilter(const Properties& node);

    struct Place {
        Vec2 offset;  // from the pixel's centre, in pixels
        float weight = 1;
    };
    Place sample(const Vec2& u) const {
        return negative_.empty() ? Place{{drawn(positive_, u.x()), drawn(positive_, u.y())}} : sample_lobes(u);
    }
    // The filter, whose integral is 1 pixel, and the largest offset along x or y that it reaches.
    float value(const Vec2& offset) const { return value(offset.x()) * value(offset.y()); }
    float reach() const { return reach_; }
    bool has_lobes() const { return !negative_.empty(); }
    float mean_weight() const { return mean_weight_; }
    const std::string& name() const { return name_; }

  private:
    // Offsets at equidistant u; empty for the box.
    using InverseCdf = std::vector<float>;
    static float drawn(const InverseCdf& table, float u);
    void tabulate(double radius, std::function<double(double)> filter);
    Place sample_lobes(const Vec2& u) const;
    float value(float offset) const;

    std::string name_ = "box";
    InverseCdf positive_, negative_;  // of the filter's positive part and of its negative lobes
    float reach_ = 0.5f;
    float share_ = 0;  // of the lobes in the integral of the modulus along one axis
    float mean_weight_ = 1;
    std::function<double(double)> lobed_;  // the filter along one axis, if it has lobes
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
    // `weighted`: add_weighted() will be called, and add() not.
    Film(const FilmSettings& settings, const ColourMatching& matching, bool with_variance, bool weighted = false);

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
    // Adds one path under a filter with lobes. Pixels are sums of weighted light over sums of weights, so that a
    // constant picture stays constant.
    void add_weighted(std::size_t pixel, const StokesPacket& stokes, const Wavelengths& w, bool hit, float weight) {
        add(pixel, stokes * weight, w, hit);
        weights_[pixel * weight_stride] += weight;
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
    static bool batch_ends(int samples) { return (samples & (batch_size(samples) - 1)) == 0; }  // a power of two
    // Ends a batch, when so many samples are done: the spread of the batches' mean luminances tells the variance,
    // whatever light came from other pixels' samples, and sees most of what stratified samples gain.
    void end_batch(std::size_t pixel, int samples);

    // Root mean square over the pixels of the standard error of the luminance, over the picture's mean luminance.
    double relative_noise() const;
    StokesImage develop() const;
    // All that the film knows, to be kept and put back. Bytes of the machine's own order.
    std::array<std::span<std::byte>, 3> memory() {
        return {std::as_writable_bytes(std::span(sums_)), std::as_writable_bytes(std::span(batches_)),
                std::as_writable_bytes(std::span(weights_))};
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
    // What a pixel's sums are divided by, and what had been added to it at the end of a batch.
    float divisor(std::size_t pixel) const;
    double weight_at_end(std::size_t pixel, int batch, double batch_samples) const;
    // Variances of the mean luminances of the Stokes components; infinite before the second batch.
    std::array<double, 4> variances_of_means(std::size_t pixel) const;

    // [pixel][slot]: Stokes vector of each bin; (X, Y, Z, -) of each Stokes component; (samples, hits, batches, samples
    // in them).
    std::vector<Float4> sums_;
    // [pixel][batch]: Y of the Stokes components at the end of the batch, summed from the first sample on. Empty: the
    // variance is not asked for.
    std::vector<Float4> batches_;
    // [pixel][weight of all samples, weight at the end of each batch]. Empty: the weights are 1, or only their mean
    // counts.
    static constexpr int weight_stride = most_batches + 1;
    std::vector<float> weights_;
    std::vector<float> bin_weight_;  // (visible range / number of wavelengths) / width of the bin
    std::vector<Nanometre> nanometres_;
};

}  // namespace patina::render
