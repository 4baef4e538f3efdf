#include "patina/render/plugins.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/aov.h"
#include "patina/render/bsdf_set.h"
#include "patina/render/medium.h"
#include "patina/render/mesh_attribute.h"
#include "patina/render/texel_grid.h"

namespace patina::render {

namespace {

const ParameterDescriptor to_world = {
    "to_world", "transform", "",
    "identity", "",          "from the plugin's own space to the world; of shapes also an animation"};
const ParameterDescriptor flip_normals = {"flip_normals", "boolean", "", "false", "", "turns the outside inside"};

void add_shapes(std::vector<PluginDescriptor>& all) {
    const auto shape = [&](const char* name, const char* doc, std::vector<ParameterDescriptor> parameters) {
        parameters.push_back(to_world);
        parameters.push_back(flip_normals);
        all.push_back({"shape", name, doc, std::move(parameters)});
    };
    shape("sphere", "An exact sphere.",
          {{"center", "point", "scene units", "0, 0, 0", "", "its centre"},
           {"radius", "number", "scene units", "1", "> 0", "its radius"}});
    shape("rectangle", "The square -1 .. 1 in x and y, normal along +z.", {});
    shape("disk", "The unit disk in x and y, normal along +z; u is the radius, v the azimuth.", {});
    shape("cube", "The cube -1 .. 1, normals outward; u and v are 0 .. 1 on each face.", {});
    shape("cylinder", "The side of a cylinder, normals outward; 512 facets with its own normals.",
          {{"p0", "point", "scene units", "0, 0, 0", "", "middle of one end"},
           {"p1", "point", "scene units", "0, 0, 1", "", "middle of the other"},
           {"radius", "number", "scene units", "1", "> 0", "its radius"}});
    const std::vector<ParameterDescriptor> of_file = {
        {"filename", "path", "", "", "", "the file"},
        {"face_normals", "boolean", "", "false", "", "flat shading, the file's normals unused"},
        {"flip_tex_coords", "boolean", "", "true for obj", "", "v becomes 1 - v, for files whose v grows upwards"}};
    for (const char* name : {"obj", "ply"}) shape(name, "A triangle mesh from a file.", of_file);
    std::vector<ParameterDescriptor> packed = of_file;
    packed.push_back({"shape_index", "integer", "", "0", ">= 0", "which of the file's meshes"});
    shape("serialized", "A triangle mesh from a file of Mitsuba's.", std::move(packed));
}

const std::vector<ParameterDescriptor> polarization = {
    {"polarization", "string", "", "unpolarized", "unpolarized, linear, circular, elliptical", "state of the light"},
    {"polarization_degree", "number", "", "1", "0 .. 1", "degree of polarization"},
    {"polarization_angle", "number", "degree", "0", "-360 .. 360", "of the ellipse's long axis from polarization_axis"},
    {"polarization_ellipticity", "number", "degree", "45 (circular), 22.5", "-45 .. 45", "> 0 right-handed"},
    {"polarization_axis", "vector", "", "own x axis; surroundings y", "", "where angles count from"},
    {"stokes", "string", "", "", "Q^2 + U^2 + V^2 <= I^2", "I, Q, U, V instead of the words"}};

void add_copies(std::vector<PluginDescriptor>& all) {
    all.push_back({"shape", "shapegroup", "Shapes to be copied by instances; not seen itself.", {}});
    all.push_back({"shape", "instance", "A copy of a shapegroup, which it refers to.", {to_world}});
}

const std::vector<ParameterDescriptor> field_of_view = {
    {"fov", "number", "degree", "39.6", "0 .. 180", "field of view along fov_axis"},
    {"fov_axis", "string", "", "x", "x, y, diagonal, smaller, larger", "what fov measures"},
    {"focal_length", "string", "mm", "50mm", "> 0", "instead of fov, on 36 x 24 mm film"}};

void add_emitters(std::vector<PluginDescriptor>& all) {
    const auto emitter = [&](const char* name, const char* doc, std::vector<ParameterDescriptor> parameters) {
        parameters.insert(parameters.end(), polarization.begin(), polarization.end());
        all.push_back({"emitter", name, doc, std::move(parameters)});
    };
    const ParameterDescriptor sun = {"sun_direction", "vector", "",
                                     "0, 1, 0",       "",       "towards the sun, for polarization \"rayleigh\""};
    emitter("area", "A shape that shines from its outside.",
            {{"radiance", "spectrum or texture", "W/(m^2 sr nm)", "1", ">= 0", "the same into every direction"}});
    emitter("point", "A point that shines into every direction.",
            {{"position", "point", "scene units", "0, 0, 0", "", "its place"},
             to_world,
             {"intensity", "spectrum", "W/(sr nm)", "1", ">= 0", "radiant intensity"}});
    emitter("spot", "A cone of light along +z.",
            {to_world,
             {"intensity", "spectrum", "W/(sr nm)", "1", ">= 0", "radiant intensity inside beam_width"},
             {"cutoff_angle", "number", "degree", "20", "0 .. 180", "beyond it nothing"},
             {"beam_width", "number", "degree", "3/4 of cutoff_angle", "0 .. cutoff_angle", "until it constant"},
             {"texture", "texture", "", "", "", "factors on the intensity, over the square about the cone"}});
    std::vector<ParameterDescriptor> projector = field_of_view;
    projector.insert(projector.begin(), {to_world,
                                         {"irradiance", "texture or spectrum", "W/(m^2 nm)", "1", ">= 0",
                                          "1/pi of it, on a plane across the axis at distance 1"},
                                         {"scale", "number", "", "1", ">= 0", "factor on it"}});
    emitter("projector", "A picture thrown by a perspective camera turned round.", std::move(projector));
    emitter("directional", "Parallel light.",
            {{"direction", "vector", "", "+z through to_world", "", "in which the light travels"},
             to_world,
             {"irradiance", "spectrum", "W/(m^2 nm)", "1", ">= 0", "on a plane across the light"}});
    emitter("constant", "The same radiance from everywhere.",
            {{"radiance", "spectrum", "W/(m^2 sr nm)", "1", ">= 0", "of the surroundings"}, to_world, sun});
    emitter("envmap", "Surroundings as a latitude-longitude picture, y up.",
            {{"filename", "path", "", "", "", "the picture"},
             {"scale", "number", "", "1", ">= 0", "factor on its radiance"},
             to_world,
             sun});
}

void add_sensors(std::vector<PluginDescriptor>& all) {
    const auto sensor = [&](const char* name, const char* doc, std::vector<ParameterDescriptor> parameters) {
        parameters.push_back({"shutter_open", "number", "s", "0", "", "when light begins to count"});
        parameters.push_back({"shutter_close", "number", "s", "shutter_open", ">= shutter_open", "and ends"});
        all.push_back({"sensor", name, doc, std::move(parameters)});
    };
    const std::vector<ParameterDescriptor> planes = {
        to_world,
        {"near_clip", "number", "scene units", "0.01", "", "accepted, without effect"},
        {"far_clip", "number", "scene units", "10000", "", "accepted, without effect"}};
    std::vector<ParameterDescriptor> camera = planes;
    camera.insert(camera.end(), field_of_view.begin(), field_of_view.end());
    std::vector<ParameterDescriptor> pinhole = camera;
    pinhole.push_back({"focus_distance", "number", "scene units", "", "", "accepted, without effect"});
    sensor("perspective", "Pinhole camera.", pinhole);
    camera.push_back({"aperture_radius", "number", "scene units", "", ">= 0", "of the lens"});
    camera.push_back({"focus_distance", "number", "scene units", "", "> 0", "of the plane in focus"});
    sensor("thinlens", "Camera with depth of field.", camera);
    sensor("orthographic", "Parallel rays; the film is -1 .. 1 along x of the sensor's own space.", planes);
    sensor("radiancemeter", "Radiance along the ray from the origin of to_world along +z.", {to_world});
    sensor("irradiancemeter", "Irradiance on the outside of the shape it stands in, the mean over its area.", {});
    sensor("fluxmeter", "Flux onto the outside of the shape it stands in.", {});
    sensor("radiositymeter", "Radiosity (exitance) of the outside of the shape it stands in: emitted and reflected.",
           {});
    sensor("goniophotometer", "Far-field intensity of everything in the scene over all directions.", {to_world});
    sensor("distant", "Radiance that leaves the scene against one direction, the mean over its cross section.",
           {to_world,
            {"direction", "vector", "", "0, 0, 1", "", "instead of to_world: in which the sensor looks"},
            {"target", "point", "scene units", "", "", "look at this point alone"}});
}

void add_film(std::vector<PluginDescriptor>& all) {
    for (const char* name : {"hdrfilm", "specfilm"})
        all.push_back({"film",
                       name,
                       "The picture's size and window.",
                       {{"width", "integer", "pixel", "768", ">= 1", "of the whole picture"},
                        {"height", "integer", "pixel", "576", ">= 1", "of the whole picture"},
                        {"crop_offset_x", "integer", "pixel", "0", ">= 0", "first column of the window"},
                        {"crop_offset_y", "integer", "pixel", "0", ">= 0", "first row of the window"},
                        {"crop_width", "integer", "pixel", "width", ">= 1", "of the window"},
                        {"crop_height", "integer", "pixel", "height", ">= 1", "of the window"},
                        {"file_format", "string", "", "openexr", "", "accepted, the output's name decides"},
                        {"pixel_format", "string", "", "rgba", "", "accepted, without effect"},
                        {"component_format", "string", "", "float32", "", "accepted, without effect"},
                        {"banner", "boolean", "", "false", "", "accepted, without effect"},
                        {"compensate", "boolean", "", "false", "", "accepted, without effect"},
                        {"sample_border", "boolean", "", "false", "", "accepted, without effect"}}});
    const char* positive = "Reconstruction filter, sampled.";
    all.push_back({"rfilter", "box", positive, {{"radius", "number", "pixel", "0.5", "0.001 .. 100", "reach"}}});
    all.push_back({"rfilter", "tent", positive, {{"radius", "number", "pixel", "1", "0.001 .. 100", "reach"}}});
    all.push_back(
        {"rfilter", "gaussian", positive, {{"stddev", "number", "pixel", "0.5", "0.001 .. 100", "cut at 4 of it"}}});
    const char* lobed = "Reconstruction filter with negative lobes; needs more samples.";
    all.push_back({"rfilter",
                   "mitchell",
                   lobed,
                   {{"A", "number", "", "1/3", "0 .. 1", "B of Mitchell and Netravali (1988)"},
                    {"B", "number", "", "1/3", "0 .. 1", "their C"}}});
    all.push_back({"rfilter", "catmullrom", lobed, {}});
    all.push_back({"rfilter", "lanczos", lobed, {{"lobes", "integer", "pixel", "3", "1 .. 16", "reach"}}});
    for (const char* name : {"independent", "stratified", "multijitter", "orthogonal", "ldsampler"})
        all.push_back({"sampler",
                       name,
                       "All names give the same Owen-scrambled sampler.",
                       {{"sample_count", "integer", "per pixel", "16", ">= 1", "how many paths"},
                        {"seed", "integer", "", "0", ">= 0", "another seed, other noise"},
                        {"jitter", "boolean", "", "true", "", "accepted, without effect"}}});
}

void add_integrators(std::vector<PluginDescriptor>& all) {
    const std::vector<ParameterDescriptor> schedule = {
        {"samples_per_pass", "integer", "", "", ">= 1", "accepted, without effect"},
        {"block_size", "integer", "pixel", "", ">= 0", "accepted, without effect"}};
    const auto integrator = [&](const char* name, const char* doc, const char* hide_emitters,
                                std::vector<ParameterDescriptor> more = {}) {
        std::vector<ParameterDescriptor> parameters = {
            {"max_depth", "integer", "", "-1", ">= -1", "segments of a path, 1 = emitters only, -1 = no limit"},
            {"rr_depth", "integer", "", "5", ">= 1", "segments before Russian roulette begins, no more than 256"},
            {"hide_emitters", "boolean", "", hide_emitters, "", "emitters do not show directly"}};
        parameters.insert(parameters.end(), schedule.begin(), schedule.end());
        parameters.insert(parameters.end(), more.begin(), more.end());
        all.push_back({"integrator", name, doc, std::move(parameters)});
    };
    const std::vector<ParameterDescriptor> spread = {
        {"light_samples", "integer", "", "1; distribution 4", ">= 1", "shadow rays at the first surface"},
        {"lobe_samples", "integer", "", "1; distribution 4", ">= 1", "rays into the lobe of the first surface"}};
    integrator("path", "Path tracing with light sampling, polarized.", "false");
    for (const char* name : {"volumetric", "volpath", "volpathmis"})
        integrator(name, "Path tracing through media, polarized.", "false");
    integrator("appel", "Direct light only: E(D|G)L.", "true", spread);
    integrator("whitted", "Direct light, mirrors and refraction: ES*(D|G)L.", "true", spread);
    integrator("distribution", "Distribution ray tracing: E(S|G)*(D|G)?L.", "false", spread);
    for (const char* name : {"light", "ptracer"})
        integrator(name, "Light tracing, from the lamps to the camera; no mirrors and glass before the eye.", "false");
    const ParameterDescriptor samples = {"", "integer", "", "1", ">= 0", "accepted: samples per pixel decide"};
    std::vector<ParameterDescriptor> of_direct = {
        {"hide_emitters", "boolean", "", "false", "", "emitters do not show directly"}};
    for (const char* name : {"shading_samples", "emitter_samples", "bsdf_samples"})
        (of_direct.emplace_back(samples)).name = name;
    of_direct.insert(of_direct.end(), schedule.begin(), schedule.end());
    all.push_back({"integrator", "direct", "Path tracing of emitters and directly lit surfaces (max_depth 2).",
                   std::move(of_direct)});
    integrator("bidirectional", "Bidirectional path tracing with multiple importance sampling, polarized.", "false");
    all.push_back({"integrator",
                   "radiosity",
                   "Diffuse scenes as a linear system over patches, solved before the picture; no limit of depth.",
                   {{"patches", "integer", "", "600", "1 .. 6000", "about how many"},
                    {"rays", "integer", "", "1024", ">= 1", "from each patch, for its form factors"},
                    {"solver", "string", "", "lu", "lu, jacobi, gauss_seidel, neumann", "of the linear system"},
                    {"gather", "boolean", "", "true", "", "gather light at each point; false shows the patches"},
                    {"hide_emitters", "boolean", "", "false", "", "emitters do not show directly"}}});
    all.push_back({"integrator",
                   "aov",
                   "Wraps an integrator; what the camera sees first becomes further channels of the picture.",
                   {{"aovs", "string", "", "", "", "\"name:kind, ...\" of " + kinds_of_aovs()}}});
    all.push_back({"integrator", "stokes", "Wraps an integrator; every picture has Stokes components anyway.", {}});
    all.push_back({"integrator", "moment", "Wraps an integrator; every picture has variances anyway.", {}});
    all.push_back({"texture", "bitmap", "A picture as a reflectance, a number or a radiance over a surface.",
                   picture_parameters()});
    all.push_back({"texture",
                   "checkerboard",
                   "Two spectra or numbers in squares.",
                   {{"color0", "spectrum or texture", "", "0.4", "", "of the first square"},
                    {"color1", "spectrum or texture", "", "0.2", "", "of its neighbours"},
                    {"to_uv", "transform", "", "identity", "", "of texture coordinates"}}});
    all.push_back(attribute_descriptor());
}

std::vector<PluginDescriptor> build_registry() {
    std::vector<PluginDescriptor> all = bsdf_descriptors();
    for (PluginDescriptor& medium : medium_descriptors()) all.push_back(std::move(medium));
    all.push_back({"volume",
                   "constvolume",
                   "A coefficient of a medium that is the same everywhere.",
                   {{"value", "spectrum", "", "1", ">= 0", "of the coefficient"}}});
    add_shapes(all);
    add_copies(all);
    add_emitters(all);
    add_sensors(all);
    add_film(all);
    add_integrators(all);
    return all;
}

}  // namespace

const std::vector<PluginDescriptor>& plugins() {
    static const std::vector<PluginDescriptor> registry = build_registry();
    return registry;
}

namespace {

// What stands in for plugins of Mitsuba 3 that are not here.
struct WayOut {
    const char *category, *name, *instead;
};
constexpr WayOut ways_out[] = {
    {"bsdf", "measured", "convert the table to .pbsdf and use \"measured_polarized\", or use \"merl\""},
    {"bsdf", "principledthin", "use \"thindielectric\", or \"blendbsdf\" of it and \"diffuse\""},
    {"bsdf", "hair", "use \"roughdielectric\""},
    {"emitter", "sunsky",
     "write an \"envmap\" from another program, or use \"constant\" with polarization "
     "\"rayleigh\" and a \"directional\" sun"},
    {"emitter", "sky", "write an \"envmap\" from another program, or use \"constant\" with polarization \"rayleigh\""},
    {"emitter", "sun", "use \"directional\""},
    {"emitter", "directionalarea", "use \"directional\" or \"area\""},
    {"shape", "bsplinecurve", "convert the curves to a mesh"},
    {"shape", "linearcurve", "convert the curves to a mesh, or use \"cylinder\""},
    {"shape", "heightfield", "convert it to a mesh"},
    {"shape", "sdfgrid", "convert it to a mesh"},
    {"medium", "heterogeneous", "use \"homogeneous\""},
    {"volume", "gridvolume", "media are the same everywhere: use \"constvolume\""},
    {"shape", "merge", "leave its shapes as they are, each for itself"},
    {"texture", "volume", "bake the colours into a bitmap texture"},
    {"integrator", "depth", "use \"aov\" with aovs=\"d:depth\""},
};

std::string way_out(const Properties& node, const std::vector<std::string>& names) {
    for (const WayOut& way : ways_out)
        if (node.category == way.category && node.type == way.name) return way.instead;
    return did_you_mean(node.type, names);
}

}  // namespace

const PluginDescriptor& expect_plugin(const Properties& node) {
    std::vector<std::string> names;
    for (const PluginDescriptor& plugin : plugins()) {
        if (plugin.category != node.category) continue;
        if (plugin.name == node.type) return plugin;
        names.push_back(plugin.name);
    }
    throw input_error(node.where, fmt::format("unknown {} \"{}\"", node.category, node.type), "", way_out(node, names));
}

void expect_known_properties(const Properties& node) {
    std::vector<std::string> names;
    for (const ParameterDescriptor& parameter : expect_plugin(node).parameters) names.push_back(parameter.name);
    node.expect_all_used(names);
}

}  // namespace patina::render
