#include "patina/io/png_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <png.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t largest_side = 65500;
// Deflate packs at most 1032:1; a header that promises more is broken or a trap.
constexpr double largest_expansion = 1100;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// What libpng says before it jumps, and the jump's target. libpng returns from errors by longjmp only, so the functions
// that call setjmp below hold nothing with a destructor.
struct PngState {
    std::string message;
    png_structp png = nullptr;
    png_infop info = nullptr;
};

extern "C" void keep_png_error(png_structp png, png_const_charp message) {
    static_cast<PngState*>(png_get_error_ptr(png))->message = message;
    png_longjmp(png, 1);
}
extern "C" void ignore_png_warning(png_structp, png_const_charp) {}

struct PngReader : PngState {
    PngReader() {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(this), keep_png_error,
                                     ignore_png_warning);
        if (png) info = png_create_info_struct(png);
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
};

struct PngWriter : PngState {
    PngWriter() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(this), keep_png_error,
                                      ignore_png_warning);
        if (png) info = png_create_info_struct(png);
    }
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
};

// Reads the header and asks for grey or RGB, 8 or 16 bits in the machine's order, with alpha when there is any.
bool read_png_header(PngReader& reader, std::FILE* file) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_init_io(reader.png, file);
    png_set_user_limits(reader.png, largest_side, largest_side);
    png_read_info(reader.png, reader.info);
    png_set_expand(reader.png);
    if (png_get_bit_depth(reader.png, reader.info) == 16) png_set_swap(reader.png);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    return true;
}

bool read_png_pixels(PngReader& reader, png_bytep* rows) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_read_image(reader.png, rows);
    png_read_end(reader.png, nullptr);
    return true;
}

std::vector<std::string> channel_names(int count) {
    switch (count) {
        case 1:
            return {"Y"};
        case 2:
            return {"Y", "A"};
        case 3:
            return {"R", "G", "B"};
        default:
            return {"R", "G", "B", "A"};
    }
}

bool is_alpha(int channel, int count) {
    return count % 2 == 0 && channel == count - 1;
}

// The linear value of every code of a channel with `bits` bits.
std::vector<float> decoding_table(int bits, bool decode) {
    const int codes = 1 << bits;
    std::vector<float> table(codes);
    for (int code = 0; code < codes; ++code) {
        const double value = code / double(codes - 1);
        table[code] = static_cast<float>(decode ? spectral::srgb_decode(value) : value);
    }
    return table;
}

bool says_linear(const PngReader& reader) {
    double gamma = 0;
    return png_get_gAMA(reader.png, reader.info, &gamma) && std::abs(gamma - 1.0) < 1e-3;
}

}  // namespace

Bitmap read_png(const fs::path& path, bool raw) {
    std::error_code status_error;
    if (!fs::exists(path, status_error)) throw input_error({path.string()}, "file not found");
    if (!fs::is_regular_file(path, status_error)) throw input_error({path.string()}, "not a regular file");
    const File file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) throw input_error({path.string()}, "cannot be read");
    PngReader reader;
    if (!reader.info) throw Error(ErrorKind::runtime, "libpng refuses to start");
    if (!read_png_header(reader, file.get()))
        throw input_error({path.string()}, "not a readable PNG image", reader.message);

    // Take memory for no more than the file can hold.
    const auto width = png_get_image_width(reader.png, reader.info),
               height = png_get_image_height(reader.png, reader.info);
    const int channels = png_get_channels(reader.png, reader.info), bits = png_get_bit_depth(reader.png, reader.info);
    const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
    if (double(row_bytes) * height / 8 > largest_expansion * double(fs::file_size(path)))
        throw input_error({path.string()}, "the header cannot be true",
                          fmt::format("{} x {} pixels in so small a file", width, height));
    std::vector<png_byte> bytes(row_bytes * height);
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < height; ++y) rows.push_back(bytes.data() + y * row_bytes);
    if (!read_png_pixels(reader, rows.data()))
        throw input_error({path.string()}, "the pixels cannot be read", reader.message);

    // Decode; alpha is linear as it stands.
    Bitmap image{path.string(), static_cast<int>(width), static_cast<int>(height), channel_names(channels), {}};
    const std::vector<float> colour = decoding_table(bits, !raw && !says_linear(reader)),
                             plain = decoding_table(bits, false);
    image.data.reserve(std::size_t{width} * height * channels);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t i = 0; i < std::size_t{width} * channels; ++i) {
            const auto* wide = reinterpret_cast<const std::uint16_t*>(rows[y]);
            const int code = bits == 16 ? wide[i] : rows[y][i];
            image.data.push_back((is_alpha(static_cast<int>(i % channels), channels) ? plain : colour)[code]);
        }
    return image;
}

namespace {

std::vector<std::uint16_t> encode(const Bitmap& image, const PngOptions& options) {
    const double top = options.bits == 16 ? 65535 : 255;
    const int channels = image.channel_count();
    std::vector<std::uint16_t> codes;
    codes.reserve(image.data.size());
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const double value = image.data[i];
        if (!std::isfinite(value)) {
            const std::size_t pixel = i / channels;
            throw Error(ErrorKind::runtime, fmt::format("{}: pixel ({}, {}) is not a finite number", image.name,
                                                        pixel % image.width, pixel / image.width));
        }
        const double clipped = std::clamp(value, 0.0, 1.0);
        const bool plain = options.raw || is_alpha(static_cast<int>(i % channels), channels);
        codes.push_back(
            static_cast<std::uint16_t>(std::lround(top * (plain ? clipped : spectral::srgb_encode(clipped)))));
    }
    return codes;
}

bool write_png_file(PngWriter& writer, std::FILE* file, const Bitmap& image, int bits, png_bytep* rows, png_textp text,
                    int text_count) {
    constexpr int colour_types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                    PNG_COLOR_TYPE_RGB_ALPHA};
    if (setjmp(png_jmpbuf(writer.png))) return false;
    png_init_io(writer.png, file);
    png_set_IHDR(writer.png, writer.info, image.width, image.height, bits, colour_types[image.channel_count() - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_text(writer.png, writer.info, text, text_count);
    png_write_info(writer.png, writer.info);
    if (bits == 16) png_set_swap(writer.png);
    png_write_image(writer.png, rows);
    png_write_end(writer.png, writer.info);
    return true;
}

}  // namespace

void write_png(const fs::path& path, const Bitmap& image, const PngOptions& options) {
    PATINA_EXPECT(options.bits == 8 || options.bits == 16);
    PATINA_EXPECT(image.channel_count() >= 1 && image.channel_count() <= 4 && image.width > 0 && image.height > 0);
    const std::size_t row = static_cast<std::size_t>(image.width) * image.channels.size();
    PATINA_EXPECT(image.data.size() == row * image.height);

    // Pack the codes into rows of bytes.
    const std::vector<std::uint16_t> codes = encode(image, options);
    std::vector<png_byte> bytes(options.bits == 8 ? codes.begin() : codes.end(), codes.end());
    std::vector<png_bytep> rows;
    for (int y = 0; y < image.height; ++y)
        rows.push_back(options.bits == 8
                           ? bytes.data() + y * row
                           : reinterpret_cast<png_bytep>(const_cast<std::uint16_t*>(codes.data() + y * row)));

    std::vector<png_text> text;
    constexpr std::size_t longest_key = 79;
    std::vector<std::string> keys;
    for (const auto& [key, value] : options.text) keys.push_back(key.substr(0, longest_key));
    std::size_t index = 0;
    for (const auto& [key, value] : options.text) {
        png_text chunk{};
        chunk.compression = PNG_TEXT_COMPRESSION_NONE;
        chunk.key = keys[index++].data();
        chunk.text = const_cast<char*>(value.c_str());
        text.push_back(chunk);
    }

    write_file_atomically(path, [&](const fs::path& temporary) {
        File file(std::fopen(temporary.c_str(), "wb"), std::fclose);
        PngWriter writer;
        bool good = file && writer.info &&
                    write_png_file(writer, file.get(), image, options.bits, rows.data(), text.data(),
                                   static_cast<int>(text.size()));
        good = file && std::fclose(file.release()) == 0 && good;
        if (!good)
            throw Error(ErrorKind::runtime,
                        fmt::format("{}: cannot be written ({})", path.string(),
                                    writer.message.empty() ? std::strerror(errno) : writer.message));
    });
}

}  // namespace patina::io
