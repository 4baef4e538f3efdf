// Meters against the textbook of radiometry and photometry.

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/spectral/illuminants.h"
#include "patina/spectral/observer.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

constexpr double visible_nm = 400;  // 380 .. 780 nm

Measurement read(const Node& tree, const std::string& integrator = "path", int samples = 64,
                 const std::string& sensor = "") {
    RenderOptions options;
    options.integrator = integrator;
    options.samples_per_pixel = samples;
    return *render_parts(*build_scene(*tree, {}, sensor), options).measurement;
}
Node meter(const std::string& type, std::vector<Value> values = {}) {
    return node("sensor", type, std::move(values));
}
Node black() {
    return node("bsdf", "diffuse", {uniform("reflectance", 0)});
}
// A square at the origin, turned about x.
Node target(const std::string& type, double tilt_deg = 0, double half_side = 0.01) {
    return node("shape", "rectangle",
                {{"to_world", Eigen::Matrix4d(rotate_x(tilt_deg) * scale(half_side, half_side, 1))}},
                {black(), meter(type)});
}
Node point(double power_w, const Vector3d& position) {
    // Spread evenly over the visible range and all directions.
    return node("emitter", "point", {{"position", position}, uniform("intensity", power_w / (4 * pi * visible_nm))});
}

// E = Phi cos/(4 pi r^2), by every integrator: what is seen directly belongs to them all.
TEST(Meters, PointLightOfKnownPowerIlluminatesBySquareAndCosine) {
    for (const char* integrator : {"path", "light", "bidirectional", "whitted"})
        for (double distance : {1.0, 2.0, 4.0})
            for (double tilt_deg : {0.0, 60.0}) {
                const double power_w = 100;
                const double expected = power_w * std::cos(radians(tilt_deg)) / (4 * pi * distance * distance);
                const Measurement m =
                    read(scene({target("irradiancemeter", tilt_deg, 1e-3), point(power_w, {0, 0, distance})}),
                         integrator, 1);
                // Over the square of 0.002 irradiance varies by some 0.2 %, and there are 256 points.
                EXPECT_NEAR(m.radiometric[0], expected, 4e-4 * expected) << integrator << " " << distance;
                EXPECT_EQ(m.quantity, Quantity::irradiance);
            }
}

// A sphere around a lamp receives all of its power, wherever the lamp is inside.
TEST(Meters, SphereAroundALampReceivesItsPower) {
    const Node sphere =
        node("shape", "sphere", {{"radius", 2.0}, {"flip_normals", true}}, {black(), meter("fluxmeter")});
    const Measurement centred = read(scene({sphere, point(60, {0, 0, 0})}), "path", 4);
    EXPECT_NEAR(centred.radiometric[0], 60, 60 * 1e-4);
    EXPECT_STREQ(names_of(centred.quantity).unit, "W");
    // Away from the middle the points of the meter are unequal: 256 pixels of 64 points, a spread of 100 %.
    const Measurement aside = read(scene({sphere, point(60, {0.8, 0.5, 0})}), "path", 64);
    EXPECT_NEAR(aside.radiometric[0], 60, 4 * 60 / std::sqrt(256 * 64.0));
}

// An area light sends pi L A, its radiosity is pi L; all of it arrives at the sphere around it.
TEST(Meters, LambertianLampSendsPiTimesItsRadiance) {
    const double radiance = 3;
    const auto lamp = [&](std::vector<Node> sensor) {
        sensor.push_back(black());
        sensor.push_back(node("emitter", "area", {uniform("radiance", radiance)}));
        return node("shape", "disk", {{"to_world", scale(0.5, 0.5, 1)}}, sensor);
    };
    const auto room = [&](std::vector<Node> sensor) {
        sensor.push_back(black());
        return node("shape", "sphere", {{"radius", 3.0}, {"flip_normals", true}}, sensor);
    };
    const double exitance = pi * radiance * visible_nm, area = pi * 0.25;
    const Measurement leaving = read(scene({lamp({meter("radiositymeter")}), room({})}));
    EXPECT_NEAR(leaving.radiometric[0], exitance, 1e-4 * exitance);
    // The lamp fills little of what the meter sees: hits of 4.6 %, of 256 * 1024 rays, are known to 1 %.
    const Measurement arriving = read(scene({lamp({}), room({meter("fluxmeter")})}), "path", 1024);
    EXPECT_NEAR(arriving.radiometric[0], exitance * area, 0.03 * exitance * area);
    // Light tracing has no such trouble.
    const Measurement by_light = read(scene({lamp({}), room({meter("fluxmeter")})}), "bidirectional", 256);
    EXPECT_NEAR(by_light.radiometric[0], exitance * area, 0.06 * exitance * area);
}

// Reflected light: radiosity of a wall = reflectance times irradiance.
TEST(Meters, WallSendsItsReflectanceOfWhatArrives) {
    const auto wall = [&](const char* type) {
        return scene(
            {node("shape", "rectangle", {}, {node("bsdf", "diffuse", {uniform("reflectance", 0.37)}), meter(type)}),
             point(10, {0.2, 0.1, 1.5}), constant_light(0.01)});
    };
    const double arriving = read(wall("irradiancemeter"), "path", 64).radiometric[0];
    const double leaving = read(wall("radiositymeter"), "path", 64).radiometric[0];
    // Irradiance varies by half over the wall, 16384 points each.
    EXPECT_NEAR(leaving, 0.37 * arriving, 0.37 * arriving * 4 * 0.5 * std::sqrt(2.0 / 16384));
}

// Radiance does not change along a ray, whatever the distance; illuminance does, by the square.
TEST(Meters, RadianceIsInvariantAlongARay) {
    const auto at = [&](double distance) {
        return scene({node("shape", "sphere", {{"radius", 0.5}}, {node("emitter", "area", {uniform("radiance", 2)})}),
                      meter("radiancemeter", {{"to_world", look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0})}})});
    };
    for (double distance : {1.0, 10.0, 1000.0})
        EXPECT_NEAR(read(at(distance), "path", 1).radiometric[0], 2 * visible_nm, 1e-3) << distance;
}

// Straubel (1902), Clausius: L / n^2 is invariant through refraction. A meter in a block of glass in uniform
// surroundings sees n^2 L, reflections inside included.
TEST(Meters, RadianceGrowsByTheSquareOfTheIndexInGlass) {
    const double n = 1.5;
    for (const Vector3d& target : {Vector3d(0, 0, 1), Vector3d(0.3, 0.4, 1)}) {
        const Node block = node("shape", "sphere", {{"radius", 1.0}},
                                {node("bsdf", "dielectric", {{"int_ior", n}, {"ext_ior", 1.0}})});
        const Measurement m =
            read(scene({path(200), block, constant_light(1),
                        meter("radiancemeter", {{"to_world", look_at({0.1, 0.2, -0.3}, target, {0, 1, 0})}})}),
                 "path", 1024);
        // Every path ends outside with n^2 L in this lossless block. The rarer way at an interface is taken more often
        // than it is light, so weights scatter by half: 5e-4 is seen at 64 well-spread samples, a fourth of it here.
        EXPECT_NEAR(m.radiometric[0], n * n * visible_nm, 5e-4 * n * n * visible_nm);
    }
}

// A goniophotometer sees I = L A cos of a small Lambertian lamp, and the intensity of a point; over all directions its
// flux.
TEST(Meters, GoniophotometerSeesIntensities) {
    const Node lamp = node("shape", "disk", {{"to_world", scale(0.1, 0.1, 1)}},
                           {black(), node("emitter", "area", {uniform("radiance", 5)})});
    const auto tree = scene({lamp, meter("goniophotometer")});
    RenderOptions options;
    options.samples_per_pixel = 64;
    const Pictures pictures = render_parts(*build_scene(*tree, {}), options);
    const double area = pi * 0.01, flux = pi * 5 * area * visible_nm;
    EXPECT_NEAR((*pictures.measurement->total_flux)[0], flux, 0.02 * flux);
    // Rows are of equal width in the cosine: 72 x 36, the first has cos 1 .. 0.944.
    double first = 0;
    for (int x = 0; x < 72; ++x) first += pictures.whole.spectral[pictures.whole.pixel_index(x, 0) * 64] / 72;
    // The disk fills its own bounding sphere's cross section: nothing but wavelengths vary.
    EXPECT_NEAR(first, 5 * area * (1 - 1 / 36.0), 0.02 * 5 * area);

    const Measurement bare =
        read(scene({point(100, {0.3, 0, 0}), target("irradiancemeter"), meter("goniophotometer")}), "path", 1, "0");
    EXPECT_NEAR(bare.radiometric[0], 100 / (4 * pi), 1e-3 * 100 / (4 * pi));
    EXPECT_NEAR((*bare.total_flux)[0], 100, 0.1);
}

// A standard lamp: 1 W/(m^2 nm) at 555 nm alone is 683 lm/W; illuminant A of 100 W has the efficacy of its spectrum.
TEST(Meters, PhotometricTwinsWeighByTheEfficiencyOfTheEye) {
    const auto lux = [&](Value irradiance) {
        return read(scene({target("irradiancemeter"),
                           node("emitter", "directional", {{"direction", Vector3d(0, 0, -1)}, irradiance})}),
                    "path", 256);
    };
    const Measurement equal = lux(uniform("irradiance", 1));
    // Hero wavelengths at 65536 samples integrate a smooth spectrum to 1e-3.
    EXPECT_NEAR(equal.photometric[0], 683 * 106.857, 1e-3 * 683 * 106.857);
    EXPECT_NEAR(equal.radiometric[0], visible_nm, 1e-3 * visible_nm);

    std::vector<double> nm, values;
    const spectral::Spectrum illuminant = spectral::illuminant_a();
    double watts = 0, lumens = 0;
    for (int i = 380; i <= 780; i += 5) {
        const double value = illuminant(i) / 100;
        nm.push_back(i), values.push_back(value);
        const double weight = (i == 380 || i == 780 ? 2.5 : 5.0) * value;
        watts += weight, lumens += 683 * weight * spectral::photopic_efficiency(i);
    }
    const Measurement a = lux(sampled("irradiance", nm, values));
    EXPECT_NEAR(a.radiometric[0], watts, 2e-3 * watts);
    EXPECT_NEAR(a.photometric[0], lumens, 2e-3 * lumens);
    EXPECT_STREQ(names_of(a.quantity).photometric_unit, "lx");
    EXPECT_GT(a.standard_error, 0);
}

// A candle at one metre gives one lux.
TEST(Meters, OneCandelaAtOneMetreIsOneLux) {
    const double intensity = 1 / (683 * 106.857);
    const Measurement m =
        read(scene({target("irradiancemeter"),
                    node("emitter", "point", {{"position", Vector3d(0, 0, 1)}, uniform("intensity", intensity)})}),
             "path", 256);
    EXPECT_NEAR(m.photometric[0], 1, 2e-3);
}

// Light tracing, path tracing and both together read the same on a meter and far away, polarization included.
TEST(Meters, DoNotDependOnTheIntegrator) {
    const Node gold = node("shape", "sphere", {{"center", Vector3d(0, 0, 1)}, {"radius", 0.5}},
                           {node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", 0.4}})});
    const Node lamp =
        node("shape", "rectangle",
             {{"to_world", Eigen::Matrix4d(translate({1, 0, 2}) * rotate_x(180) * scale(1.2, 1.2, 1))}},
             {black(), node("emitter", "area", {uniform("radiance", 4), {"polarization", std::string("linear")}})});
    const Node floor = node("shape", "rectangle", {},
                            {node("bsdf", "diffuse", {uniform("reflectance", 0.6)}), meter("irradiancemeter")});
    const Node film = node("film", "hdrfilm", {{"width", std::int64_t{16}}, {"height", std::int64_t{8}}});
    const Node far = node("sensor", "goniophotometer", {}, {film});
    const Node distant = meter("distant", {{"direction", Vector3d(1, 0, -1)}});
    const auto tree = scene({path(5), far, distant, gold, lamp, floor});
    for (const char* sensor : {"0", "1", "2"}) {
        const Measurement a = read(tree, "path", 350, sensor), b = read(tree, "light", 300, sensor),
                          c = read(tree, "bidirectional", 150, sensor);
        // Three and a half standard errors of a difference, were the others no better than the path tracer's.
        const double allowed = 5 * a.standard_error / a.photometric[0];
        EXPECT_LT(allowed, 0.09);
        for (const Measurement* m : {&b, &c})
            for (int k = 0; k < 4; ++k)
                EXPECT_NEAR(m->radiometric[k], a.radiometric[k], allowed * a.radiometric[0]) << sensor << " " << k;
    }
}

TEST(Meters, OrthographicCameraSeesParallel) {
    // A square of side 1 fills half of a film of 2, near and far.
    for (double distance : {2.0, 50.0}) {
        const auto tree =
            scene({node("shape", "rectangle", {{"to_world", scale(0.5, 0.5, 1)}},
                        {node("emitter", "area", {uniform("radiance", 1)})}),
                   node("sensor", "orthographic", {{"to_world", look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0})}},
                        {node("film", "hdrfilm", {{"width", std::int64_t{4}}, {"height", std::int64_t{4}}})})});
        const StokesImage image = render_tree(tree);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x)
                EXPECT_EQ(image.alpha[image.pixel_index(x, y)], (x == 1 || x == 2) && (y == 1 || y == 2) ? 1 : 0);
    }
}

TEST(Meters, SayWhatTheyNeed) {
    const auto message = [&](const Node& tree, const std::string& integrator = "path", const std::string& sensor = "") {
        try {
            read(tree, integrator, 1, sensor);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto has = [&](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    EXPECT_PRED2(has, message(scene({meter("fluxmeter"), constant_light()})), "put it inside the shape");
    EXPECT_PRED2(has, message(scene({meter("radiancemeter"), constant_light()}), "light"), "no light path meets");
    EXPECT_PRED2(has, message(scene({meter("radiancemeter"), constant_light()}), "path", "1"), "has no sensor \"1\"");
    EXPECT_PRED2(has, message(scene({meter("distant", {{"direction", Vector3d(0, 0, 0)}}), constant_light()})),
                 "length zero");
    EXPECT_PRED2(
        has,
        message(scene({meter("radiancemeter", {{"shutter_open", 1.0}, {"shutter_close", 0.5}}), constant_light()})),
        "closes before it opens");
}

}  // namespace
}  // namespace patina::render::test
