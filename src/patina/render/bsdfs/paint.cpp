#include "patina/render/bsdfs/paint.h"

#include "patina/core/error.h"

namespace patina::render {

PluginDescriptor Paint::describe() {
    return {"bsdf",
            "paint",
            "A coating from its recipe or its solved Mueller BRDF table.",
            {{"recipe", "path", "", "", "", "paint recipe (TOML), solved before rendering"},
             {"table", "path", "", "", "", "BRDF table (HDF5), instead of a recipe"},
             {"filename", "path", "", "", "", "either of them"}}};
}

Paint Paint::build(const Properties& node, const BsdfBuilder& builder) {
    std::string key;
    for (const char* name : {"recipe", "table", "filename"}) {
        if (!node.has(name)) continue;
        if (!key.empty())
            throw input_error(node.location_of(name), "a paint takes one file",
                              "both \"" + key + "\" and \"" + name + "\" are given");
        key = name;
    }
    if (key.empty()) throw input_error(node.where, "a paint needs a \"recipe\" or a \"table\"");
    const std::string path = node.string(key);
    if (!builder.resources->load_brdf_table)
        throw Error(ErrorKind::not_built, node.where.to_string() + ": paint tables are not available");
    const std::shared_ptr<const brdf::MuellerTable> table = builder.resources->load_brdf_table(path);
    table->validate(node.location_of(key));
    if (!table->provenance.command.empty()) (*builder.notes)["paint " + path] = table->provenance.command;
    return {std::make_shared<const PaintTable>(*table)};
}

}  // namespace patina::render
