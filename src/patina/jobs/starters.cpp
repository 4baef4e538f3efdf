#include "patina/jobs/starters.h"

#include <fmt/format.h>

#include "patina/coating/key_info.h"

namespace patina::jobs {

namespace {

constexpr const char* recipe_body = R"(# A paint recipe for Patina.
#   patina solve THIS.toml -o paint.h5      its 4x4 Mueller BRDF, wavelength by wavelength
#   patina plot paint.h5 -o lobe.svg --kind lobe
title = "my paint"
extrapolation = "hold"            # materials are measured over a range; hold their ends outside it (flagged), or "refuse"

[interface]                       # air above a smooth binder surface; omit for an index-matched top
type = "smooth"

[[layers]]                        # top to bottom; repeat for more
thickness_um = 30                 # dry film thickness
binder = "acrylic"                # `patina materials list`, an n,k file, or { n = 1.5, k = 0 }

[[layers.pigments]]               # repeat for more
material = "TiO2-rutile"
volume_fraction = 0.15            # of the dry film (PVC / 100)
size = { distribution = "lognormal", median_radius_um = 0.125, sigma_g = 1.3 }

[base]
type = "lambertian"               # "none" | "lambertian" | "metal" (material = "Al")
reflectance = 0.5

# Every key:
)";

constexpr const char* scene_body = R"(<!-- A scene for Patina, in Mitsuba 3's format: a painted sphere on a grey floor.
     patina render THIS.xml -o picture.exr -->
<scene version="3.0.0">
    <default name="spp" value="64"/>
    <integrator type="stokes">
        <integrator type="path">
            <integer name="max_depth" value="8"/>
        </integrator>
    </integrator>
    <sensor type="perspective">
        <float name="fov" value="35"/>
        <transform name="to_world">
            <lookat origin="0, 1.6, 5" target="0, 0.9, 0" up="0, 1, 0"/>
        </transform>
        <sampler type="independent">
            <integer name="sample_count" value="$spp"/>
        </sampler>
        <film type="hdrfilm">
            <integer name="width" value="480"/>
            <integer name="height" value="360"/>
        </film>
    </sensor>
    <shape type="sphere">
        <point name="center" value="0, 1, 0"/>
        <float name="radius" value="1"/>
        <!-- filename names a recipe (.toml, solved first) or a table (.h5) -->
        <bsdf type="paint">
            <string name="filename" value="paint.toml"/>
        </bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <rotate x="1" angle="-90"/>
            <scale value="10"/>
        </transform>
        <bsdf type="diffuse">
            <spectrum name="reflectance" value="0.3"/>
        </bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <rotate x="1" angle="90"/>
            <scale value="1.2"/>
            <translate value="-2, 4, 2"/>
        </transform>
        <emitter type="area">
            <spectrum name="radiance" value="12"/>
        </emitter>
    </shape>
    <emitter type="constant">
        <spectrum name="radiance" value="0.25"/>
    </emitter>
</scene>
)";

}  // namespace

std::string starter_recipe() {
    std::string text = recipe_body;
    for (const coating::TableInfo& table : coating::recipe_tables()) {
        text += fmt::format("#\n# {} - {}\n", table.heading.empty() ? "(top)" : table.heading, table.doc);
        for (const coating::KeyInfo& key : table.keys)
            text += fmt::format("#   {:<26} {}{}{}\n", key.name, key.doc,
                                key.unit.empty() || key.unit == "1" ? "" : fmt::format(" [{}]", key.unit),
                                key.fallback.empty() ? "" : fmt::format(" (default {})", key.fallback));
    }
    return text;
}

std::string starter_scene() {
    return scene_body;
}

}  // namespace patina::jobs
