#pragma once
// Quantities on a product grid of parameters as an HDF5 file with dimension scales (opens in h5py, xarray, MATLAB).

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace patina::io {

struct GridAxis {
    std::string name;  // no slash
    std::string units;
    std::vector<double> values;
};

struct GridVariable {
    std::string name, units, long_name;
    std::vector<int> axes;       // positions in the list of axes
    std::vector<double> values;  // C order over them; NaN where not defined
};

// Writes the file whole or not at all; `attributes` go to the root. Throws Error(runtime) when it cannot be written.
void write_grid_hdf5(const std::filesystem::path& path, const std::vector<GridAxis>& axes,
                     const std::vector<GridVariable>& variables, const std::map<std::string, std::string>& attributes);

}  // namespace patina::io
