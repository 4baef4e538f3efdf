#include "patina/io/bitmap_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/io/exr_file.h"
#include "patina/io/jpeg_file.h"
#include "patina/io/located_text.h"
#include "patina/io/png_file.h"

namespace patina::io {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t largest_side = 65500;

bool contains(const std::vector<std::string>& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

Bitmap read_exr_bitmap(const fs::path& path) {
    const ExrInfo info = read_exr_info(path);
    const auto has_all = [&](const std::vector<std::string>& names) {
        return std::all_of(names.begin(), names.end(), [&](const auto& name) { return contains(info.channels, name); });
    };
    std::vector<std::string> sources;
    for (const auto& names : {std::vector<std::string>{"R", "G", "B"}, {"Y"}, {"S0.R", "S0.G", "S0.B"}})
        if (sources.empty() && has_all(names)) sources = names;
    if (sources.empty())
        throw input_error({path.string()}, "there are no channels of a picture", "", "it needs R, G and B, or Y");
    Bitmap image{path.string(), info.width, info.height, {}, {}};
    image.channels = sources.size() == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    if (sources[0] == "R" && contains(info.channels, "A")) {
        sources.push_back("A");
        image.channels.push_back("A");
    }

    image.data.resize(static_cast<std::size_t>(info.width) * info.height * sources.size());
    std::vector<ExrTarget> targets;
    for (std::size_t i = 0; i < sources.size(); ++i) targets.push_back({sources[i], &image.data[i], sources.size()});
    read_exr_channels(path, targets);
    return image;
}

// The next word of a header of words between white space, which it leaves behind `text`.
std::string_view take_word(std::string_view& text) {
    const auto space = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
    while (!text.empty() && space(text[0])) text.remove_prefix(1);
    std::size_t size = 0;
    while (size < text.size() && !space(text[size])) ++size;
    const std::string_view word = text.substr(0, size);
    text.remove_prefix(size);
    return word;
}

int parse_side(std::string_view word, const SourceLocation& where) {
    const std::int64_t side = parse_integer(word, where, "size");
    if (side < 1 || side > largest_side)
        throw input_error(where, fmt::format("a size of {} pixels", side),
                          fmt::format("1 to {} are read", largest_side));
    return static_cast<int>(side);
}

void expect_values(const Bitmap& image, bool signed_values) {
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const float value = image.data[i];
        if (std::isfinite(value) && (signed_values || value >= 0)) continue;
        const std::size_t pixel = i / image.channels.size();
        throw input_error({image.name},
                          fmt::format("pixel ({}, {}) of channel {} is {}", pixel % image.width, pixel / image.width,
                                      image.channels[i % image.channels.size()], value),
                          "light is finite and not negative");
    }
}

}  // namespace

void write_exr_bitmap(const fs::path& path, const Bitmap& image, const std::map<std::string, std::string>& metadata) {
    ExrInfo info;
    info.width = info.full_width = image.width;
    info.height = info.full_height = image.height;
    for (const auto& [key, value] : metadata) info.strings["patina." + key] = value;
    std::vector<ExrPlane> planes;
    for (std::size_t c = 0; c < image.channels.size(); ++c)
        planes.push_back({image.channels[c], &image.data[c], nullptr, image.channels.size()});
    write_exr(path, info, planes);
}

Bitmap read_pfm(const fs::path& path) {
    const std::string bytes = read_text_file(path);
    const SourceLocation where{path.string()};
    std::string_view rest = bytes;
    const std::string_view magic = take_word(rest);
    if (magic != "PF" && magic != "Pf")
        throw input_error(where, "not a portable float map", "it starts neither with PF nor with Pf");
    Bitmap image{path.string(), 0, 0, {"R", "G", "B"}, {}};
    if (magic == "Pf") image.channels = {"Y"};
    image.width = parse_side(take_word(rest), where);
    image.height = parse_side(take_word(rest), where);
    const double scale = parse_float(take_word(rest), where, "scale");
    const std::size_t row = static_cast<std::size_t>(image.width) * image.channels.size();
    if (rest.size() < 1 + row * image.height * 4) throw input_error(where, "the file is truncated");
    rest.remove_prefix(1);

    // A negative scale says little-endian; the rows come from the bottom.
    const bool swap = (scale < 0) != (std::endian::native == std::endian::little);
    image.data.resize(row * image.height);
    for (int y = 0; y < image.height; ++y)
        for (std::size_t i = 0; i < row; ++i) {
            std::uint32_t word = 0;
            std::memcpy(&word, rest.data() + (y * row + i) * 4, 4);
            image.data[(image.height - 1 - y) * row + i] = std::bit_cast<float>(swap ? __builtin_bswap32(word) : word);
        }
    return image;
}

namespace {

// One scan line of 4 bytes a pixel, from one of Ward's two encodings; advances `rest`.
void read_rgbe_line(std::string_view& rest, std::vector<std::uint8_t>& line, const SourceLocation& where) {
    const std::size_t width = line.size() / 4;
    const auto take = [&]() -> std::uint8_t {
        if (rest.empty()) throw input_error(where, "the file is truncated");
        const auto byte = static_cast<std::uint8_t>(rest[0]);
        rest.remove_prefix(1);
        return byte;
    };
    for (std::size_t i = 0; i < 4; ++i) line[i] = take();
    const bool packed =
        width >= 8 && width < 32768 && line[0] == 2 && line[1] == 2 && ((line[2] << 8) | line[3]) == int(width);
    if (!packed) {
        for (std::size_t i = 4; i < line.size(); ++i) line[i] = take();
        return;
    }
    for (std::size_t component = 0; component < 4; ++component)
        for (std::size_t x = 0; x < width;) {
            const int code = take();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128 : code;
            if (count == 0 || x + count > width) throw input_error(where, "a run of pixels goes beyond its line");
            const std::uint8_t value = run ? take() : std::uint8_t{0};
            for (std::size_t i = 0; i < count; ++i, ++x) line[x * 4 + component] = run ? value : take();
        }
}

}  // namespace

Bitmap read_hdr(const fs::path& path) {
    const std::string bytes = read_text_file(path);
    const SourceLocation where{path.string()};
    if (bytes.rfind("#?", 0) != 0) throw input_error(where, "not a Radiance picture", "it does not start with #?");
    const std::size_t header = bytes.find("\n\n");
    if (header == std::string::npos) throw input_error(where, "the header has no end");
    if (bytes.substr(0, header).find("32-bit_rle_xyze") != std::string::npos)
        throw input_error(where, "the picture is in XYZ", "RGB is read only");
    std::string_view rest = std::string_view(bytes).substr(header + 2);
    if (take_word(rest) != "-Y") throw input_error(where, "the picture's orientation is not -Y +X");
    Bitmap image{path.string(), 0, 0, {"R", "G", "B"}, {}};
    image.height = parse_side(take_word(rest), where);
    if (take_word(rest) != "+X") throw input_error(where, "the picture's orientation is not -Y +X");
    image.width = parse_side(take_word(rest), where);
    if (rest.empty()) throw input_error(where, "the file is truncated");
    rest.remove_prefix(1);

    std::vector<std::uint8_t> line(static_cast<std::size_t>(image.width) * 4);
    for (int y = 0; y < image.height; ++y) {
        read_rgbe_line(rest, line, where);
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* pixel = &line[x * 4];
            // Ward's mantissas stand for the middle of their interval.
            const float scale = pixel[3] ? std::ldexp(1.0f, pixel[3] - 136) : 0.0f;
            for (int c = 0; c < 3; ++c) image.data.push_back((pixel[c] + (pixel[3] ? 0.5f : 0.0f)) * scale);
        }
    }
    return image;
}

Bitmap read_bitmap(const fs::path& path, bool raw) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    Bitmap image;
    if (extension == ".exr")
        image = read_exr_bitmap(path);
    else if (extension == ".png")
        image = read_png(path, raw);
    else if (extension == ".jpg" || extension == ".jpeg")
        image = read_jpeg(path, raw);
    else if (extension == ".pfm")
        image = read_pfm(path);
    else if (extension == ".hdr" || extension == ".rgbe")
        image = read_hdr(path);
    else
        throw input_error({path.string()}, fmt::format("pictures of type {} are not read", in_quotes(extension)), "",
                          "known: .exr, .png, .jpg, .pfm, .hdr");
    expect_values(image, raw);
    return image;
}

}  // namespace patina::io
