#include "patina/io/grid_hdf5.h"

#include "patina/core/contract.h"
#include "patina/core/files.h"
#include "patina/io/table_hdf5_file.h"

namespace patina::io {

void write_grid_hdf5(const std::filesystem::path& path, const std::vector<GridAxis>& axes,
                     const std::vector<GridVariable>& variables, const std::map<std::string, std::string>& attributes) {
    hdf5::Writer writer;
    for (const auto& [name, value] : attributes) writer.attribute("/", name, value);
    for (const GridAxis& axis : axes) {
        const std::string name = "/" + axis.name;
        writer.dataset(name, {axis.values.size()}, axis.values);
        writer.attribute(name, "units", axis.units);
        writer.make_scale(name);
    }
    for (const GridVariable& variable : variables) {
        hdf5::Shape shape;
        std::vector<std::string> scales, labels;
        std::size_t count = 1;
        for (const int axis : variable.axes) {
            shape.push_back(axes[axis].values.size());
            count *= shape.back();
            scales.push_back("/" + axes[axis].name);
            labels.push_back(axes[axis].name);
        }
        PATINA_EXPECT(count == variable.values.size());
        const std::string name = "/" + variable.name;
        writer.dataset(name, shape, variable.values);
        writer.attribute(name, "units", variable.units);
        writer.attribute(name, "long_name", variable.long_name);
        writer.attach_scales(name, scales, labels);
    }
    write_text_file(path, writer.image());
}

}  // namespace patina::io
