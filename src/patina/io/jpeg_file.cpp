#include "patina/io/jpeg_file.h"

#include <array>
#include <csetjmp>
#include <cstdio>

#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace {

constexpr std::uint64_t largest_file_bytes = std::uint64_t{1} << 30;
// Blocks of one colour take a few bits each; a header that promises more is broken or a trap.
constexpr double most_pixels_a_byte = 1000;

// What libjpeg says before it jumps. It returns from errors by longjmp only, so the functions that call setjmp below
// hold nothing with a destructor.
struct JpegReader {
    jpeg_error_mgr errors;
    jpeg_decompress_struct jpeg;
    std::array<char, JMSG_LENGTH_MAX> message{};
    std::jmp_buf target;
    bool created = false;

    JpegReader() {
        jpeg.err = jpeg_std_error(&errors);
        jpeg.client_data = this;
        errors.error_exit = [](j_common_ptr common) {
            auto* reader = static_cast<JpegReader*>(common->client_data);
            common->err->format_message(common, reader->message.data());
            std::longjmp(reader->target, 1);
        };
        // A file that ends too early is a warning to libjpeg; other warnings are harmless.
        errors.emit_message = [](j_common_ptr common, int) {
            const int code = common->err->msg_code;
            if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER) common->err->error_exit(common);
        };
    }
    ~JpegReader() {
        if (created) jpeg_destroy_decompress(&jpeg);
    }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
};

bool read_header(JpegReader& reader, const unsigned char* data, std::size_t size) {
    if (setjmp(reader.target)) return false;
    jpeg_create_decompress(&reader.jpeg);
    reader.created = true;
    jpeg_mem_src(&reader.jpeg, data, static_cast<unsigned long>(size));
    jpeg_read_header(&reader.jpeg, TRUE);
    return true;
}

bool read_rows(JpegReader& reader, unsigned char* bytes) {
    if (setjmp(reader.target)) return false;
    jpeg_start_decompress(&reader.jpeg);
    const std::size_t row_bytes = static_cast<std::size_t>(reader.jpeg.output_width) * reader.jpeg.output_components;
    while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
        JSAMPROW row = bytes + reader.jpeg.output_scanline * row_bytes;
        jpeg_read_scanlines(&reader.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&reader.jpeg);
    return true;
}

}  // namespace

Bitmap read_jpeg(const std::filesystem::path& path, bool raw) {
    const SourceLocation where{path.string()};
    const std::string file = read_text_file(path, largest_file_bytes);
    JpegReader reader;
    if (!read_header(reader, reinterpret_cast<const unsigned char*>(file.data()), file.size()))
        throw input_error(where, "not a readable JPEG image", reader.message.data());
    jpeg_decompress_struct& jpeg = reader.jpeg;
    if (jpeg.num_components != 1 && jpeg.num_components != 3)
        throw input_error(where, fmt::format("a JPEG image of {} inks is not read", jpeg.num_components), "",
                          "convert it to RGB");
    const bool grey = jpeg.num_components == 1;
    jpeg.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    const std::size_t width = jpeg.image_width, height = jpeg.image_height, channels = grey ? 1 : 3;
    if (static_cast<double>(width) * static_cast<double>(height) >
        most_pixels_a_byte * static_cast<double>(file.size()))
        throw input_error(where, "the header cannot be true",
                          fmt::format("{} x {} pixels in so small a file", width, height));
    std::vector<unsigned char> bytes(width * height * channels);
    if (!read_rows(reader, bytes.data())) throw input_error(where, "the pixels cannot be read", reader.message.data());

    Bitmap image{path.string(), static_cast<int>(width), static_cast<int>(height), {}, {}};
    image.channels = grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    std::array<float, 256> linear{};
    for (int code = 0; code < 256; ++code)
        linear[code] = static_cast<float>(raw ? code / 255.0 : spectral::srgb_decode(code / 255.0));
    image.data.reserve(bytes.size());
    for (const unsigned char code : bytes) image.data.push_back(linear[code]);
    return image;
}

}  // namespace patina::io
