#include <algorithm>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "patina/io/mitsuba_values.h"
#include "patina/spectral/spectrum_file.h"

namespace patina::io {

namespace {

// Throws unless wavelengths are positive and ascend and there is one value for each.
void expect_sampled(const SpectrumSpec& spectrum, const SourceLocation& where) {
    const auto& wavelengths = spectrum.wavelengths_nm;
    if (wavelengths.empty()) throw input_error(where, "the spectrum has no sample");
    if (wavelengths.size() != spectrum.values.size())
        throw input_error(where, fmt::format("the spectrum has {} wavelengths and {} values", wavelengths.size(),
                                             spectrum.values.size()));
    if (wavelengths.front() <= 0)
        throw input_error(where, fmt::format("wavelength {} nm is not positive", wavelengths.front()));
    for (std::size_t i = 1; i < wavelengths.size(); ++i) {
        if (wavelengths[i] > wavelengths[i - 1]) continue;
        throw input_error(where, fmt::format("wavelength {} nm follows {} nm", wavelengths[i], wavelengths[i - 1]),
                          "they must ascend");
    }
}

SpectrumSpec uniform(double value) {
    return {SpectrumSpec::Kind::uniform, {}, {value}};
}

// "400:0.1, 500:0.2": wavelength in nm and value.
SpectrumSpec parse_pairs(const LocatedText& value) {
    SpectrumSpec spectrum;
    spectrum.kind = SpectrumSpec::Kind::sampled;
    for (const std::string_view piece : split_list(value.text)) {
        const std::size_t colon = piece.find(':');
        if (colon == std::string_view::npos)
            throw input_error(value.where, fmt::format("{} is not wavelength:value", in_quotes(piece)),
                              "a list of pairs looks like \"400:0.1, 500:0.2\"");
        spectrum.wavelengths_nm.push_back(parse_float(piece.substr(0, colon), value.where, "wavelength"));
        spectrum.values.push_back(parse_float(piece.substr(colon + 1), value.where));
    }
    expect_sampled(spectrum, value.where);
    return spectrum;
}

// `values` at equal steps over [first, last] nm.
SpectrumSpec regular(std::vector<double> values, double first_nm, double last_nm, const SourceLocation& where) {
    if (values.size() < 2) throw input_error(where, "a regular spectrum needs 2 values or more");
    if (!(first_nm > 0) || !(last_nm > first_nm))
        throw input_error(where, fmt::format("the wavelengths {} to {} nm are no range", first_nm, last_nm));
    SpectrumSpec spectrum;
    spectrum.kind = SpectrumSpec::Kind::sampled;
    const double step = (last_nm - first_nm) / static_cast<double>(values.size() - 1);
    for (std::size_t i = 0; i < values.size(); ++i)
        spectrum.wavelengths_nm.push_back(first_nm + step * static_cast<double>(i));
    spectrum.values = std::move(values);
    expect_sampled(spectrum, where);
    return spectrum;
}

// The properties inside <spectrum type="...">, each to be asked for once; what is left is unknown.
class PluginProperties {
  public:
    PluginProperties(const Element& element, std::vector<std::string> known) : element_(element) {
        for (const Element& child : element.children()) {
            const std::string name = child.name("name");
            if (std::find(known.begin(), known.end(), name) == known.end())
                throw input_error(child.where(), fmt::format("a spectrum has no property {} here", in_quotes(name)), "",
                                  did_you_mean(name, known));
            if (!children_.emplace(name, std::make_unique<Element>(child)).second)
                throw input_error(child.where(), fmt::format("{} is given twice", in_quotes(name)));
        }
    }

    bool has(const std::string& name) const { return children_.count(name) != 0; }

    LocatedText text(const std::string& name) const {
        const Element& child = at(name);
        child.expect_attributes({"name", "value"});
        child.expect_no_children();
        return child.text("value");
    }
    std::vector<double> list(const std::string& name) const {
        const LocatedText value = text(name);
        return parse_floats(value.text, value.where);
    }
    double number(const std::string& name) const {
        const LocatedText value = text(name);
        return parse_float(value.text, value.where);
    }
    double number(const std::string& name, double fallback) const { return has(name) ? number(name) : fallback; }
    const Element& at(const std::string& name) const {
        const auto found = children_.find(name);
        if (found == children_.end())
            throw input_error(element_.where(), fmt::format("this spectrum needs a property \"{}\"", name));
        return *found->second;
    }

  private:
    Element element_;
    std::map<std::string, std::unique_ptr<Element>> children_;
};

SpectrumSpec read_regular(const Element& element) {
    const PluginProperties properties(
        element, {"values", "value", "wavelength_min", "wavelength_max", "lambda_min", "lambda_max"});
    const auto either = [&](const char* name, const char* older) {
        return properties.number(properties.has(older) ? older : name);
    };
    return regular(properties.list(properties.has("value") ? "value" : "values"),
                   either("wavelength_min", "lambda_min"), either("wavelength_max", "lambda_max"), element.where());
}

SpectrumSpec read_irregular(const Element& element) {
    const PluginProperties properties(element, {"wavelengths", "values"});
    SpectrumSpec spectrum{SpectrumSpec::Kind::sampled, properties.list("wavelengths"), properties.list("values")};
    expect_sampled(spectrum, element.where());
    return spectrum;
}

SpectrumSpec read_blackbody(const Element& element) {
    const PluginProperties properties(element, {"temperature", "scale"});
    const double kelvin = properties.number("temperature");
    if (kelvin <= 0)
        throw input_error(properties.text("temperature").where,
                          fmt::format("temperature {} K is not positive", kelvin));
    return {SpectrumSpec::Kind::blackbody, {}, {kelvin, properties.number("scale", 1.0)}};
}

// An <rgb> emitter multiplies D65, so that D65 itself is white.
SpectrumSpec read_d65(const Element& element) {
    const PluginProperties properties(element, {"scale"});
    return {SpectrumSpec::Kind::rgb, {}, std::vector<double>(3, properties.number("scale", 1.0))};
}

SpectrumSpec read_srgb(const Element& element) {
    const PluginProperties properties(element, {"color"});
    return read_rgb(properties.at("color"));
}

SpectrumSpec read_uniform(const Element& element) {
    const PluginProperties properties(element, {"value"});
    return uniform(properties.number("value", 1.0));
}

SpectrumSpec read_plugin(const Element& element) {
    const LocatedText type = element.text("type");
    static const std::map<std::string, SpectrumSpec (*)(const Element&)> readers{
        {"uniform", read_uniform},     {"regular", read_regular}, {"irregular", read_irregular},
        {"blackbody", read_blackbody}, {"d65", read_d65},         {"srgb", read_srgb}};
    const auto reader = readers.find(type.text);
    if (reader != readers.end()) return reader->second(element);
    std::vector<std::string> known;
    for (const auto& [name, function] : readers) known.push_back(name);
    throw input_error(type.where, fmt::format("unknown spectrum {}", in_quotes(type.text)), "",
                      did_you_mean(type.text, known));
}

SpectrumSpec read_value(const Element& element) {
    const LocatedText value = element.text("value");
    if (element.has("wavelength_min") || element.has("wavelength_max")) {
        const LocatedText first = element.text("wavelength_min");
        const LocatedText last = element.text("wavelength_max");
        return regular(parse_floats(value.text, value.where), parse_float(first.text, first.where),
                       parse_float(last.text, last.where), value.where);
    }
    if (value.text.find(':') != std::string::npos) return parse_pairs(value);
    const std::vector<double> numbers = parse_floats(value.text, value.where);
    if (numbers.size() == 1) return uniform(numbers[0]);
    throw input_error(value.where, fmt::format("{} values without wavelengths", numbers.size()), "",
                      "write \"400:0.1, 500:0.2\", or give wavelength_min and wavelength_max");
}

}  // namespace

SpectrumSpec read_spectrum(const Element& element, const FileResolver& resolve) {
    element.expect_attributes({"name", "id", "type", "value", "filename", "wavelength_min", "wavelength_max"});
    const int forms = int(element.has("type")) + int(element.has("value")) + int(element.has("filename"));
    if (forms != 1)
        throw input_error(element.where(), "<spectrum> needs one of value, filename and type",
                          fmt::format("{} are given", forms));
    if (element.has("type")) return read_plugin(element);
    element.expect_no_children();
    if (element.has("value")) return read_value(element);
    const spectral::Spectrum file = spectral::read_spectrum(resolve(element.text("filename")), spectral::Outside::zero);
    return {SpectrumSpec::Kind::sampled, file.wavelengths_nm(), file.values()};
}

}  // namespace patina::io
