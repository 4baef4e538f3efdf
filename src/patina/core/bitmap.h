#pragma once
// An image as plain data: what readers of image files return and textures and environment maps are made from.

#include <cstddef>
#include <string>
#include <vector>

namespace patina {

struct Bitmap {
    std::string name;  // for messages: the file
    int width = 0, height = 0;
    std::vector<std::string> channels;  // C names: {"R","G","B"}, {"R","G","B","A"}, {"Y"}, ...
    std::vector<float> data;            // [y][x][c], row 0 on top; LINEAR values (sRGB-encoded files are decoded)

    int channel_count() const { return static_cast<int>(channels.size()); }
    const float* pixel(int x, int y) const {
        return data.data() + (static_cast<std::size_t>(y) * width + x) * channels.size();
    }
};

}  // namespace patina
