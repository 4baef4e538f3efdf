#pragma once
// The property elements of a Mitsuba scene file: <float>, <point>, <rgb>, <spectrum>, <transform>, ...

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "patina/core/properties.h"
#include "patina/io/mitsuba_element.h"

namespace patina::io {

// Finds the file a scene names, or throws Error(input) at the place that names it.
using FileResolver = std::function<std::filesystem::path(const LocatedText& name)>;

// The names of all property elements.
const std::vector<std::string>& property_tags();

// The value of a property element; nothing when the element is no property. Throws Error(input) for a value that does
// not read as its type, at the line and column of that value.
std::optional<PropertyValue> read_property(const Element& element, const FileResolver& resolve);

// translate, rotate, scale, lookat and matrix, each applied after the ones above it (multiplied from the left).
Eigen::Matrix4d read_transform(const Element& element);

// <animation name="to_world"> with <transform time="..."> inside, at ascending times in seconds, as a node of category
// "animation": entries "time_0", "transform_0", "time_1", ...
std::shared_ptr<Properties> read_animation(const Element& element);

// <rgb>, <color>: linear sRGB, or "#rrggbb" in encoded sRGB, which is made linear.
SpectrumSpec read_rgb(const Element& element);

// <spectrum> in all forms: value="0.5", value="400:0.1, 500:0.2", filename="x.spd",
// type="uniform|regular|irregular|blackbody|d65|srgb" with its own properties.
SpectrumSpec read_spectrum(const Element& element, const FileResolver& resolve);

}  // namespace patina::io
