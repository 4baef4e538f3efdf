#include "patina/io/exr_file.h"

#include <algorithm>
#include <fstream>

#include <ImfChannelList.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/files.h"

namespace patina::io {

namespace fs = std::filesystem;

namespace {

// A header can promise any size. Deflate packs at most 1032:1, the other methods more for constant images; beyond these
// the file is broken or a trap.
constexpr double largest_expansion = 8192;
constexpr double largest_pixel_bytes = 8e9;
constexpr int largest_side = 65536;

// Runs `work` and turns what OpenEXR throws into an Error of `kind`.
template <class Work>
auto guarded(const fs::path& path, ErrorKind kind, const char* problem, const Work& work) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        // OpenEXR's messages start with the file's name, which ours do as well.
        std::string reason = error.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        throw Error(kind, fmt::format("{}: {} ({})", path.string(), problem, reason));
    }
}

// Walks the attributes of the (first) header, name\0 type\0 size data, up to the empty name. The library allocates what
// they claim before it misses the bytes.
void expect_honest_attributes(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::uintmax_t file_bytes = fs::file_size(path);
    constexpr std::streamoff magic_and_version = 8;
    stream.seekg(magic_and_version);
    std::string name, type;
    while (std::getline(stream, name, '\0') && !name.empty() && std::getline(stream, type, '\0')) {
        std::uint32_t size = 0;
        stream.read(reinterpret_cast<char*>(&size), sizeof size);
        if (!stream) return;
        if (size > file_bytes)
            throw input_error({path.string()}, "the header cannot be true",
                              fmt::format("an attribute of {} bytes in a file of {}", size, file_bytes));
        stream.seekg(size, std::ios::cur);
    }
}

// A regular file without monstrous claims, which the library would try to fill before it found them wrong.
void expect_openable(const fs::path& path) {
    std::error_code status_error;
    if (!fs::exists(path, status_error)) throw input_error({path.string()}, "file not found");
    if (!fs::is_regular_file(path, status_error)) throw input_error({path.string()}, "not a regular file");
    static const bool limited = [] {
        Imf::Header::setMaxImageSize(largest_side, largest_side);
        return true;
    }();
    PATINA_EXPECT(limited);
    expect_honest_attributes(path);
}

void expect_plausible(const fs::path& path, const Imf::Header& header) {
    const Imath::Box2i window = header.dataWindow();
    const double width = double(window.max.x) - window.min.x + 1, height = double(window.max.y) - window.min.y + 1;
    double channels = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        ++channels;
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw input_error({path.string()}, fmt::format("channel \"{}\" is subsampled", channel.name()),
                              "luminance/chroma images are not read");
    }
    const double bytes = width * height * channels * sizeof(float);
    const double file_bytes = static_cast<double>(fs::file_size(path));
    if (bytes > std::min(largest_pixel_bytes, largest_expansion * file_bytes))
        throw input_error(
            {path.string()}, "the header cannot be true",
            fmt::format("{} x {} pixels with {} channels in a file of {} bytes", width, height, channels, file_bytes));
}

ExrInfo info_of(const Imf::Header& header) {
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    ExrInfo info;
    info.width = data.max.x - data.min.x + 1;
    info.height = data.max.y - data.min.y + 1;
    info.data_x = data.min.x - display.min.x;
    info.data_y = data.min.y - display.min.y;
    info.full_width = display.max.x - display.min.x + 1;
    info.full_height = display.max.y - display.min.y + 1;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        info.channels.emplace_back(channel.name());
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
            info.strings[attribute.name()] = text->value();
        if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute.attribute()))
            info.float_lists[attribute.name()] = list->value();
    }
    return info;
}

Imf::Header header_of(const ExrInfo& info, const std::vector<ExrPlane>& planes) {
    const Imath::Box2i display({0, 0}, {info.full_width - 1, info.full_height - 1});
    const Imath::V2i corner(info.data_x, info.data_y);
    const Imath::Box2i data(corner, corner + Imath::V2i(info.width - 1, info.height - 1));
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    // Noise does not compress: more effort makes files of 64 samples a pixel 1 % smaller for half as much time again.
    header.zipCompressionLevel() = 1;
    for (const auto& [name, text] : info.strings) header.insert(name, Imf::StringAttribute(text));
    for (const auto& [name, list] : info.float_lists) header.insert(name, Imf::FloatVectorAttribute(list));
    for (const ExrPlane& plane : planes)
        header.channels().insert(plane.channel, Imf::Channel(plane.integers ? Imf::UINT : Imf::FLOAT));
    return header;
}

// OpenEXR addresses pixels from the origin of the display window, outside of the memory when the window is cropped.
Imf::Slice slice(Imf::PixelType type, const void* data, std::size_t stride, const Imath::Box2i& window) {
    constexpr std::size_t value_bytes = 4;
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    return Imf::Slice::Make(type, data, window, stride * value_bytes, width * stride * value_bytes);
}

}  // namespace

ExrInfo read_exr_info(const fs::path& path) {
    expect_openable(path);
    return guarded(path, ErrorKind::input, "not a readable OpenEXR image", [&] {
        const Imf::InputFile file(path.c_str());
        expect_plausible(path, file.header());
        if (!file.isComplete()) throw input_error({path.string()}, "the image is incomplete", "scan lines are missing");
        return info_of(file.header());
    });
}

void read_exr_channels(const fs::path& path, const std::vector<ExrTarget>& targets) {
    expect_openable(path);
    guarded(path, ErrorKind::input, "the pixels cannot be read", [&] {
        Imf::InputFile file(path.c_str());
        expect_plausible(path, file.header());
        const Imath::Box2i window = file.header().dataWindow();
        Imf::FrameBuffer buffer;
        for (const ExrTarget& target : targets) {
            if (!file.header().channels().findChannel(target.channel))
                throw input_error({path.string()}, fmt::format("there is no channel \"{}\"", target.channel));
            buffer.insert(target.channel, slice(Imf::FLOAT, target.data, target.stride, window));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(window.min.y, window.max.y);
    });
}

void write_exr(const fs::path& path, const ExrInfo& info, const std::vector<ExrPlane>& planes) {
    PATINA_EXPECT(info.width > 0 && info.height > 0 && info.full_width > 0 && info.full_height > 0);
    PATINA_EXPECT(!planes.empty());
    write_file_atomically(path, [&](const fs::path& temporary) {
        guarded(path, ErrorKind::runtime, "the image cannot be written", [&] {
            const Imf::Header header = header_of(info, planes);
            Imf::FrameBuffer buffer;
            for (const ExrPlane& plane : planes) {
                const void* data = plane.integers ? static_cast<const void*>(plane.integers) : plane.floats;
                buffer.insert(plane.channel,
                              slice(plane.integers ? Imf::UINT : Imf::FLOAT, data, plane.stride, header.dataWindow()));
            }
            {
                Imf::OutputFile file(temporary.c_str(), header);
                file.setFrameBuffer(buffer);
                file.writePixels(info.height);
            }
            // OpenEXR keeps silent when a full disk spoils the table it writes last.
            if (!Imf::InputFile(temporary.c_str()).isComplete())
                throw std::runtime_error("the file came out incomplete");
        });
    });
}

}  // namespace patina::io
