#pragma once
// Which columns of a mesh file make an attribute together, and what it is called: Mitsuba's rules for PLY.
//
// red, green, blue (or r, g, b) are "color"; a_x, a_y, a_z, or a_0, a_1, a_2, or a_1, a_2, a_3 are "a"; a_r, a_g, a_b
// are "a_color"; any other column is an attribute by itself. Fourth channels are left out. Names get "vertex_" or
// "face_" before them.

#include <string>
#include <vector>

namespace patina::io {

struct AttributeColumns {
    std::string name;
    std::vector<std::size_t> columns;  // 1 or 3
    bool colour = false;
};

// `names` of an element's columns, "" for those that are taken already.
std::vector<AttributeColumns> group_attributes(const std::vector<std::string>& names, const std::string& prefix);

}  // namespace patina::io
