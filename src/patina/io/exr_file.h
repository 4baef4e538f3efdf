#pragma once
// OpenEXR files as named planes of floats, with the library's exceptions turned into ours.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace patina::io {

// What a file says of itself before its pixels are read.
struct ExrInfo {
    int width = 0, height = 0;                              // of the data window
    int data_x = 0, data_y = 0;                             // its upper left corner relative to the display window's
    int full_width = 0, full_height = 0;                    // of the display window
    std::vector<std::string> channels;                      // in the file's (alphabetic) order
    std::map<std::string, std::string> strings;             // string attributes
    std::map<std::string, std::vector<float>> float_lists;  // attributes that are vectors of floats
};

// A channel of the file and where its pixels go: pixel (x, y) to data[(y * width + x) * stride].
struct ExrTarget {
    std::string channel;
    float* data = nullptr;
    std::size_t stride = 1;
};

// A plane to write; pixels as in ExrTarget. One of the two pointers is set.
struct ExrPlane {
    std::string channel;
    const float* floats = nullptr;
    const std::uint32_t* integers = nullptr;
    std::size_t stride = 1;
};

// Throws Error(input) for what is no OpenEXR file, incomplete, deep, subsampled or announces more pixels than it can
// hold.
ExrInfo read_exr_info(const std::filesystem::path& path);

// Reads the channels named by `targets`, converted to float; those the file lacks are an Error(input).
void read_exr_channels(const std::filesystem::path& path, const std::vector<ExrTarget>& targets);

// Writes the planes with ZIP compression; info.channels is not looked at. Throws Error(runtime).
void write_exr(const std::filesystem::path& path, const ExrInfo& info, const std::vector<ExrPlane>& planes);

}  // namespace patina::io
