#include "patina/io/stokes_exr.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/io/exr_file.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/observer.h"

namespace patina::io {

namespace {

constexpr const char* bin_edges_attribute = "patina.binEdges_nm";
constexpr std::string_view metadata_prefix = "patina.";
constexpr std::array<const char*, 3> rgb_names{"R", "G", "B"};

// "S0.550,000000nm", the decimal comma because a point would end the layer's name.
std::string spectral_channel(int component, double wavelength_nm) {
    std::string number = fmt::format("{:.6f}", wavelength_nm);
    std::replace(number.begin(), number.end(), '.', ',');
    return fmt::format("S{}.{}nm", component, number);
}

std::string stokes_rgb_channel(int component, int colour) {
    return fmt::format("S{}.{}", component, rgb_names[colour]);
}

struct SpectralChannel {
    std::string name;
    int component = 0;
    double wavelength_nm = 0;
};

// The component and wavelength in a channel's name, nothing for other names.
std::optional<SpectralChannel> parse_spectral_channel(const std::string& name) {
    if (name.size() < 6 || name[0] != 'S' || name[1] < '0' || name[1] > '3' || name[2] != '.') return std::nullopt;
    if (name.substr(name.size() - 2) != "nm") return std::nullopt;
    std::string number = name.substr(3, name.size() - 5);
    std::replace(number.begin(), number.end(), ',', '.');
    double wavelength_nm = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), wavelength_nm);
    if (error != std::errc{} || end != number.data() + number.size()) return std::nullopt;
    if (!std::isfinite(wavelength_nm) || wavelength_nm <= 0) return std::nullopt;
    return SpectralChannel{name, name[1] - '0', wavelength_nm};
}

bool has_channel(const ExrInfo& info, const std::string& name) {
    return std::find(info.channels.begin(), info.channels.end(), name) != info.channels.end();
}

// The edges halfway between centres, mirrored at both ends.
std::vector<double> edges_around(const std::vector<double>& centres) {
    if (centres.size() == 1) return {centres[0] - 0.5, centres[0] + 0.5};
    std::vector<double> edges{centres[0] - 0.5 * (centres[1] - centres[0])};
    for (std::size_t i = 1; i < centres.size(); ++i) edges.push_back(0.5 * (centres[i - 1] + centres[i]));
    edges.push_back(2 * centres.back() - edges.back());
    return edges;
}

// The stored edges when they fit the channels, else edges around the channels' wavelengths.
std::vector<double> bin_edges(const ExrInfo& info, const std::vector<double>& centres) {
    const auto stored = info.float_lists.find(bin_edges_attribute);
    if (stored == info.float_lists.end() || stored->second.size() != centres.size() + 1) return edges_around(centres);
    const std::vector<double> edges(stored->second.begin(), stored->second.end());
    for (std::size_t i = 0; i < centres.size(); ++i)
        if (!(edges[i] < centres[i] && centres[i] < edges[i + 1])) return edges_around(centres);
    return edges;
}

ExrInfo info_of(const StokesImage& image, bool spectral) {
    ExrInfo info{image.width, image.height, image.crop_x, image.crop_y, image.full_width, image.full_height, {}, {},
                 {}};
    if (info.full_width == 0) info.full_width = image.width;
    if (info.full_height == 0) info.full_height = image.height;
    for (const auto& [key, value] : image.metadata) info.strings[std::string(metadata_prefix) + key] = value;
    info.strings["polarisationHandedness"] = "right";
    if (spectral) {
        info.strings["spectralLayoutVersion"] = "1.0";
        info.strings["emissiveUnits"] = "W.m^-2.sr^-1.nm^-1";
        info.float_lists[bin_edges_attribute].assign(image.bin_edges_nm.begin(), image.bin_edges_nm.end());
    }
    return info;
}

}  // namespace

void write_stokes_exr(const std::filesystem::path& path, const StokesImage& image, const StokesExrOptions& options) {
    const std::size_t pixels = image.pixel_count();
    const std::size_t bins = static_cast<std::size_t>(image.bin_count());
    PATINA_EXPECT(image.rgb.size() == pixels * 12 && image.spectral.size() == pixels * bins * 4);
    const bool spectral = options.spectral && bins > 0;

    // List the planes; they lie interleaved in the image and are written from where they are.
    std::vector<ExrPlane> planes;
    for (int colour = 0; colour < 3; ++colour) planes.push_back({rgb_names[colour], &image.rgb[colour], nullptr, 12});
    if (image.alpha.size() == pixels) planes.push_back({"A", image.alpha.data(), nullptr, 1});
    for (int component = 0; component < 4; ++component) {
        if (spectral)
            for (std::size_t bin = 0; bin < bins; ++bin)
                planes.push_back({spectral_channel(component, image.bin_centre_nm(static_cast<int>(bin))),
                                  &image.spectral[bin * 4 + component], nullptr, bins * 4});
        if (options.stokes_rgb)
            for (int colour = 0; colour < 3; ++colour)
                planes.push_back(
                    {stokes_rgb_channel(component, colour), &image.rgb[component * 3 + colour], nullptr, 12});
        if (options.variance && image.variance.size() == pixels * 4)
            planes.push_back({fmt::format("variance.S{}", component), &image.variance[component], nullptr, 4});
    }
    if (options.variance && image.sample_count.size() == pixels)
        planes.push_back({"samples", nullptr, image.sample_count.data(), 1});
    for (const ImageLayer& layer : image.layers) planes.push_back({layer.name, layer.values.data(), nullptr, 1});
    write_exr(path, info_of(image, spectral), planes);
}

void fill_rgb_from_bins(StokesImage& image, int first_component) {
    PATINA_EXPECT(image.rgb.size() == image.pixel_count() * 12);
    // The weight of a bin is the integral of the colour matching functions over it, in steps well below theirs of 5 nm.
    const int bins = image.bin_count();
    constexpr double step_nm = 1.0;
    std::vector<Eigen::Vector3d> weights;
    for (int bin = 0; bin < bins; ++bin) {
        const double first = image.bin_edges_nm[bin], width = image.bin_edges_nm[bin + 1] - first;
        const int steps = std::clamp(static_cast<int>(std::ceil(width / step_nm)), 1, 2000);
        Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
        for (int i = 0; i < steps; ++i)
            xyz += spectral::colour_matching(spectral::Observer::cie1931_2deg, first + width * (i + 0.5) / steps);
        xyz *= width / steps / spectral::luminance_integral_nm(spectral::Observer::cie1931_2deg);
        weights.push_back(spectral::xyz_to_linear_srgb(xyz));
    }
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        for (int component = first_component; component < 4; ++component) {
            Eigen::Vector3d rgb = Eigen::Vector3d::Zero();
            for (int bin = 0; bin < bins; ++bin) rgb += weights[bin] * image.stokes(pixel, bin)[component];
            Eigen::Map<Eigen::Vector3f>(image.stokes_rgb(pixel) + component * 3) = rgb.cast<float>();
        }
}

namespace {

// Reserves the bins and lists where their channels go.
void add_spectral_targets(const ExrInfo& info, StokesImage& image, std::vector<ExrTarget>& targets) {
    std::vector<SpectralChannel> found;
    std::vector<double> centres;
    for (const std::string& name : info.channels)
        if (const auto channel = parse_spectral_channel(name)) {
            found.push_back(*channel);
            if (channel->component == 0) centres.push_back(channel->wavelength_nm);
        }
    if (centres.empty()) return;
    std::sort(centres.begin(), centres.end());
    centres.erase(std::unique(centres.begin(), centres.end()), centres.end());
    image.bin_edges_nm = bin_edges(info, centres);
    image.spectral.assign(image.pixel_count() * centres.size() * 4, 0.0f);
    for (const SpectralChannel& channel : found) {
        const auto bin = std::lower_bound(centres.begin(), centres.end(), channel.wavelength_nm) - centres.begin();
        if (bin == static_cast<std::ptrdiff_t>(centres.size()) || centres[bin] != channel.wavelength_nm) continue;
        targets.push_back({channel.name, &image.spectral[bin * 4 + channel.component], centres.size() * 4});
    }
}

// Lists where the colour channels go; returns the first Stokes component that has none.
int add_rgb_targets(const ExrInfo& info, StokesImage& image, std::vector<ExrTarget>& targets) {
    image.rgb.assign(image.pixel_count() * 12, 0.0f);
    int component = 0;
    for (; component < 4; ++component) {
        const bool complete = std::all_of(rgb_names.begin(), rgb_names.end(), [&](const char* colour) {
            return has_channel(info, fmt::format("S{}.{}", component, colour));
        });
        if (!complete) break;
        for (int colour = 0; colour < 3; ++colour)
            targets.push_back({stokes_rgb_channel(component, colour), &image.rgb[component * 3 + colour], 12});
    }
    if (component > 0) return component;

    // Without Stokes channels the plain ones are S0; a grey image has Y alone.
    const bool grey = has_channel(info, "Y") && !has_channel(info, "R");
    for (int colour = 0; colour < 3; ++colour) {
        const char* name = grey ? "Y" : rgb_names[colour];
        if (!has_channel(info, name)) return 0;
    }
    if (grey)
        targets.push_back({"Y", &image.rgb[0], 12});
    else
        for (int colour = 0; colour < 3; ++colour) targets.push_back({rgb_names[colour], &image.rgb[colour], 12});
    return 1;
}

void add_other_targets(const ExrInfo& info, StokesImage& image, std::vector<float>& samples,
                       std::vector<ExrTarget>& targets) {
    if (has_channel(info, "A")) {
        image.alpha.assign(image.pixel_count(), 0.0f);
        targets.push_back({"A", image.alpha.data(), 1});
    }
    if (has_channel(info, "variance.S0")) image.variance.assign(image.pixel_count() * 4, 0.0f);
    for (int component = 0; component < 4; ++component) {
        const std::string name = fmt::format("variance.S{}", component);
        if (!image.variance.empty() && has_channel(info, name))
            targets.push_back({name, &image.variance[component], 4});
    }
    if (has_channel(info, "samples")) {
        samples.assign(image.pixel_count(), 0.0f);
        targets.push_back({"samples", samples.data(), 1});
    }
}

void copy_metadata(const ExrInfo& info, StokesImage& image) {
    for (const auto& [name, text] : info.strings) {
        const bool ours = name.rfind(metadata_prefix, 0) == 0;
        image.metadata[ours ? name.substr(metadata_prefix.size()) : name] = text;
    }
    // What the writer adds by itself is not metadata of the image.
    for (const char* name : {"spectralLayoutVersion", "emissiveUnits", "polarisationHandedness"})
        image.metadata.erase(name);
}

// S3 is kept with one sign in memory.
void make_right_handed(const ExrInfo& info, StokesImage& image) {
    const auto handedness = info.strings.find("polarisationHandedness");
    if (handedness == info.strings.end() || handedness->second != "left") return;
    for (std::size_t i = 3; i < image.spectral.size(); i += 4) image.spectral[i] = -image.spectral[i];
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        for (int colour = 0; colour < 3; ++colour) image.stokes_rgb(pixel)[9 + colour] *= -1.0f;
}

}  // namespace

StokesImage read_stokes_exr(const std::filesystem::path& path) {
    // Look at what is there before any memory is taken.
    const ExrInfo info = read_exr_info(path);
    StokesImage image;
    image.width = info.width;
    image.height = info.height;
    image.crop_x = info.data_x;
    image.crop_y = info.data_y;
    image.full_width = info.full_width;
    image.full_height = info.full_height;

    std::vector<ExrTarget> targets;
    std::vector<float> samples;
    add_spectral_targets(info, image, targets);
    const int coloured = add_rgb_targets(info, image, targets);
    if (targets.empty())
        throw input_error({path.string()}, "there is no channel of an image",
                          fmt::format("it has {}", fmt::join(info.channels.begin(),
                                                             info.channels.begin() + std::min<std::ptrdiff_t>(
                                                                                         20, std::ssize(info.channels)),
                                                             ", ")),
                          "known: S0.550,000000nm and so on, S0.R, R, Y");
    add_other_targets(info, image, samples, targets);
    read_exr_channels(path, targets);

    // Complete what the file left out.
    if (coloured == 1 && !has_channel(info, "R") && !has_channel(info, "S0.R"))
        for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
            image.stokes_rgb(pixel)[1] = image.stokes_rgb(pixel)[2] = image.stokes_rgb(pixel)[0];
    if (image.bin_count() > 0 && coloured < 4) fill_rgb_from_bins(image, coloured);
    for (const float count : samples)
        image.sample_count.push_back(static_cast<std::uint32_t>(std::clamp(count, 0.0f, 4.0e9f)));
    copy_metadata(info, image);
    make_right_handed(info, image);
    return image;
}

}  // namespace patina::io
