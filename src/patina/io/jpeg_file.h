#pragma once
// JPEG images, the textures of most scenes that are passed around.

#include <filesystem>

#include "patina/core/bitmap.h"

namespace patina::io {

// Grey or colour of 8 bits; channels {"Y"} or {"R","G","B"}. Values are made linear with the curve of sRGB unless
// `raw`. Throws Error(input) for a truncated or corrupt file, and for the four inks of printers.
Bitmap read_jpeg(const std::filesystem::path& path, bool raw = false);

}  // namespace patina::io
