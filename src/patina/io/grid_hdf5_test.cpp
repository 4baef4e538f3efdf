#include "patina/io/grid_hdf5.h"

#include <cmath>
#include <limits>

#include "patina/core/error.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/io/table_hdf5_file.h"

namespace patina::io {
namespace {

TEST(GridHdf5, KeepsAxesValuesUnitsAndWhatIsUndefined) {
    const ScratchFolder folder;
    const std::filesystem::path path = folder / "grid.h5";
    const double none = std::numeric_limits<double>::quiet_NaN();
    write_grid_hdf5(path, {{"layers.0.thickness_um", "um", {1, 2}}, {"wavelength_nm", "nm", {400, 500, 600}}},
                    {{"hiding_power_m2_per_l", "m2/l", "spreading rate", {0}, {none, 7.5}},
                     {"reflectance", "1", "reflectance factor", {0, 1}, {1, 2, 3, 4, 5, 6}}},
                    {{"format", "patina-sweep"}});
    const hdf5::Reader reader(path);
    EXPECT_EQ(reader.text_attribute("/", "format"), "patina-sweep");
    EXPECT_EQ(reader.text_attribute("/layers.0.thickness_um", "units"), "um");
    EXPECT_EQ(reader.text_attribute("/reflectance", "long_name"), "reflectance factor");
    const auto reflectance = reader.numbers("/reflectance", 2);
    EXPECT_EQ(reflectance.shape, (hdf5::Shape{2, 3}));
    EXPECT_EQ(reflectance.values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
    const auto rate = reader.numbers("/hiding_power_m2_per_l", 1);
    EXPECT_TRUE(std::isnan(rate.values[0]));
    EXPECT_EQ(rate.values[1], 7.5);
    EXPECT_TRUE(reader.has_attribute("/reflectance", "DIMENSION_LIST"));
}

TEST(GridHdf5, UnwritableFolderIsARuntimeError) {
    EXPECT_THROW(write_grid_hdf5("/nowhere/grid.h5", {{"a", "1", {1}}}, {}, {}), Error);
}

}  // namespace
}  // namespace patina::io
