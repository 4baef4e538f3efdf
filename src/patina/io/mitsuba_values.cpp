#include "patina/io/mitsuba_values.h"

#include <cmath>

#include <fmt/format.h>

namespace patina::io {

namespace {

Eigen::Vector3d read_vector(const Element& element) {
    element.expect_attributes({"name", "value", "x", "y", "z"});
    element.expect_no_children();
    const bool components = element.has("x") || element.has("y") || element.has("z");
    if (components && element.has("value"))
        throw input_error(element.where(), fmt::format("<{}> has both a value and x, y, z", element.tag()), "",
                          "give one");
    if (!components && !element.has("value"))
        throw input_error(element.where(), fmt::format("<{}> needs x, y, z or a value", element.tag()));

    if (element.has("value")) {
        const LocatedText value = element.text("value");
        const std::vector<double> numbers = parse_floats(value.text, value.where);
        if (numbers.size() == 1) return Eigen::Vector3d::Constant(numbers[0]);
        if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
        throw input_error(value.where, fmt::format("{} has {} numbers", in_quotes(value.text), numbers.size()),
                          "a point or vector has 3");
    }
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
        if (!element.has(names[axis])) continue;
        const LocatedText text = element.text(names[axis]);
        vector[axis] = parse_float(text.text, text.where);
    }
    return vector;
}

PropertyValue read_scalar(const Element& element) {
    element.expect_attributes({"name", "value"});
    element.expect_no_children();
    const LocatedText value = element.text("value");
    if (element.tag() == "integer") return parse_integer(value.text, value.where);
    if (element.tag() == "boolean") return parse_boolean(value.text, value.where);
    if (element.tag() == "string") return value.text;
    return parse_float(value.text, value.where);
}

// The decoding curve of sRGB (IEC 61966-2-1:1999).
double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::vector<double> parse_hexadecimal_colour(const LocatedText& value, std::string_view digits) {
    const bool short_form = digits.size() == 3;
    if (!short_form && digits.size() != 6)
        throw input_error(value.where, fmt::format("{} is not a colour", in_quotes(value.text)), "", "write #rrggbb");
    std::vector<double> rgb;
    for (int channel = 0; channel < 3; ++channel) {
        int byte = 0;
        for (int i = 0; i < 2; ++i) {
            const char c = digits[static_cast<std::size_t>(short_form ? channel : 2 * channel + i)];
            const std::size_t digit = std::string_view("0123456789abcdef").find(static_cast<char>(std::tolower(c)));
            if (digit == std::string_view::npos)
                throw input_error(value.where, fmt::format("{} is not a colour", in_quotes(value.text)),
                                  "a digit is not hexadecimal", "write #rrggbb");
            byte = 16 * byte + static_cast<int>(digit);
        }
        rgb.push_back(linear_from_srgb(byte / 255.0));
    }
    return rgb;
}

}  // namespace

const std::vector<std::string>& property_tags() {
    static const std::vector<std::string> tags{"boolean", "integer", "float", "string",   "point",
                                               "vector",  "rgb",     "color", "spectrum", "transform"};
    return tags;
}

std::optional<PropertyValue> read_property(const Element& element, const FileResolver& resolve) {
    const std::string tag = element.tag();
    if (tag == "boolean" || tag == "integer" || tag == "float" || tag == "string") return read_scalar(element);
    if (tag == "point" || tag == "vector") return PropertyValue(read_vector(element));
    if (tag == "rgb" || tag == "color") return PropertyValue(read_rgb(element));
    if (tag == "spectrum") return PropertyValue(read_spectrum(element, resolve));
    if (tag == "transform") return PropertyValue(read_transform(element));
    return std::nullopt;
}

SpectrumSpec read_rgb(const Element& element) {
    element.expect_attributes({"name", "value"});
    element.expect_no_children();
    const LocatedText value = element.text("value");
    const std::string_view body = trimmed(value.text);
    SpectrumSpec spectrum;
    spectrum.kind = SpectrumSpec::Kind::rgb;
    if (!body.empty() && body[0] == '#') {
        spectrum.values = parse_hexadecimal_colour(value, body.substr(1));
        return spectrum;
    }
    spectrum.values = parse_floats(value.text, value.where);
    if (spectrum.values.size() == 1) spectrum.values.assign(3, spectrum.values[0]);
    if (spectrum.values.size() != 3)
        throw input_error(value.where, fmt::format("{} has {} numbers", in_quotes(value.text), spectrum.values.size()),
                          "a colour has 3 (red, green, blue) or 1 (grey)");
    return spectrum;
}

}  // namespace patina::io
