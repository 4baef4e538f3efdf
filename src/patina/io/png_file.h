#pragma once
// PNG images, 8 and 16 bits a channel.

#include <filesystem>
#include <map>
#include <string>

#include "patina/core/bitmap.h"

namespace patina::io {

// Grey, RGB, palette and alpha, interlaced or not; channels {"Y"}, {"Y","A"}, {"R","G","B"} or {"R","G","B","A"}.
// Values are made linear with the curve of sRGB unless `raw` (the numbers are data) or the file says gamma 1.
// Throws Error(input) for a truncated or corrupt file.
Bitmap read_png(const std::filesystem::path& path, bool raw = false);

struct PngOptions {
    int bits = 8;                             // 8 or 16
    bool raw = false;                         // store the numbers as they are instead of encoding them for sRGB
    std::map<std::string, std::string> text;  // text chunks: provenance
};

// Writes 1, 2, 3 or 4 channels of linear values; what is below 0 or above 1 is clipped. Values that are not finite are
// an Error(runtime) naming the pixel. Written under a temporary name and renamed.
void write_png(const std::filesystem::path& path, const Bitmap& image, const PngOptions& options = {});

}  // namespace patina::io
