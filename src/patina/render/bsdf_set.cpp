#include "patina/render/bsdf_set.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

struct Entry {
    PluginDescriptor descriptor;
    Bsdf (*build)(const Properties&, const BsdfBuilder&);
};

template <class... Models>
std::vector<Entry> entries_of(std::variant<Models...>*) {
    return {Entry{Models::describe(), [](const Properties& node, const BsdfBuilder& builder) {
                      return Bsdf{Models::build(node, builder)};
                  }}...};
}

std::vector<Entry> entries() {
    return entries_of(static_cast<Bsdf::Model*>(nullptr));
}

}  // namespace

std::vector<PluginDescriptor> bsdf_descriptors() {
    std::vector<PluginDescriptor> descriptors;
    for (Entry& entry : entries()) descriptors.push_back(std::move(entry.descriptor));
    return descriptors;
}

Bsdf build_bsdf(const Properties& node, const BsdfBuilder& builder) {
    const std::string& name = expect_plugin(node).name;
    for (const Entry& entry : entries()) {
        if (entry.descriptor.name != name) continue;
        Bsdf bsdf = entry.build(node, builder);
        expect_known_properties(node);
        return bsdf;
    }
    throw input_error(node.where, fmt::format("\"{}\" is no bsdf", node.type));
}

}  // namespace patina::render
