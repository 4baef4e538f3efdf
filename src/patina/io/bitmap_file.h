#pragma once
// Pictures for textures and environment maps, by extension: .exr, .png, .jpg, .pfm, .hdr.

#include <filesystem>
#include <map>
#include <string>

#include "patina/core/bitmap.h"

namespace patina::io {

// Linear values, row 0 on top. From .exr: R, G, B and A, else Y, else S0.R, S0.G, S0.B. `raw` matters for .png and .jpg
// only: the numbers are data. Values that are not finite, or negative unless `raw`, are an Error(input) naming the
// pixel.
Bitmap read_bitmap(const std::filesystem::path& path, bool raw = false);

// Channels under their names, 32-bit float, and text attributes patina.<key>.
void write_exr_bitmap(const std::filesystem::path& path, const Bitmap& image,
                      const std::map<std::string, std::string>& metadata = {});

// Portable float map: "PF" (3 channels) or "Pf" (1), rows from the bottom (Debevec 1998).
Bitmap read_pfm(const std::filesystem::path& path);

// Radiance's RGBE picture, flat or run-length encoded (Ward 1991), orientation -Y +X.
Bitmap read_hdr(const std::filesystem::path& path);

}  // namespace patina::io
