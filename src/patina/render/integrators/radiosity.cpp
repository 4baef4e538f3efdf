#include "patina/render/integrators/radiosity.h"

#include <atomic>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/render/arriving_light.h"

namespace patina::render {

namespace {

constexpr int most_patches = 6000;  // the matrix then takes 0.3 GB
constexpr int nodes = 21;           // of wavelength, every 20 nm of 380 .. 780
constexpr float node_step_nm = wavelength_range_nm / (nodes - 1);
constexpr double tolerance = 1e-9;  // of an iteration, relative to the largest radiosity
constexpr int most_iterations = 100'000;
constexpr std::uint32_t first_draw = 8;

float node_nm(int node) {
    return wavelength_min_nm + node_step_nm * static_cast<float>(node);
}

// Lambert's reflectance of a surface seen from one side.
float reflectance(const Scene& scene, const SurfacePoint& at, bool back, const Wavelengths& w) {
    const Vec3 normal(0, 0, back ? -1.0f : 1.0f);
    BsdfValue value;
    const ShadingPoint shading{&w, at.uv, scene.bsdfs.data()};
    const Bsdf& bsdf = scene.bsdfs[scene.geometry.shapes[at.shape].bsdf];
    return bsdf_evaluate(bsdf, shading, normal, normal, value) ? pi_f * value.f.intensity()[0] : 0.0f;
}

}  // namespace

struct RadiosityIntegrator::Row {
    std::vector<double> form_factors;
    std::array<double, nodes> irradiance{};   // of lights that are no patches
    std::array<double, nodes> reflectance{};  // mean over the patch
    std::array<double, nodes> emission{};     // radiosity
};

RadiosityIntegrator::Row RadiosityIntegrator::cast_rays(const TransportProblem& problem, int index) const {
    const Scene& scene = problem.scene;
    const Patch& patch = (*patches_)[index];
    Row row;
    row.form_factors.assign(patches_->count(), 0.0);
    std::vector<Wavelengths> at;
    for (int n = 0; n < nodes; ++n) at.push_back(Wavelengths::all_at(node_nm(n)));
    const double share = 1.0 / settings_.rays;
    const int emitter = scene.geometry.shapes[patch.centre.shape].emitter;
    for (int r = 0; r < settings_.rays; ++r) {
        Sampler sampler(static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(r), 0x7261646eu);
        const SurfacePoint point = patches_->sample(index, sampler.next2());
        const Vec3 normal = patch.back ? Vec3(-point.geometric_normal) : point.geometric_normal;
        const Ray ray = [&] {
            const Vec3 direction = Frame(normal).to_world(cosine_hemisphere(sampler.next2()));
            return Ray{point.origin(direction), direction, INFINITY};
        }();
        for (int n = 0; n < nodes; ++n) row.reflectance[n] += share * reflectance(scene, point, patch.back, at[n]);

        // What the ray meets.
        Hit hit;
        if (scene.geometry.intersect(ray, hit)) {
            const int other = patches_->find(hit, scene.geometry.surface(ray, hit), ray.direction);
            if (other >= 0) row.form_factors[other] += share;
        } else {
            for (int n = 0; n < nodes; ++n)
                scene.lights.for_each_environment(ray.direction, at[n], [&](Float4 radiance, float, int) {
                    row.irradiance[n] += share * pi_f * radiance[0];
                });
        }

        // Point and parallel lights, one drawn.
        LightSample light;
        const float choice = sampler.next();
        if (!scene.lights.any_sampled() ||
            !scene.lights.sample(scene.geometry, point.position, at[0], choice, Vec2(0.5f, 0.5f), light) ||
            !light.delta)
            continue;
        const float cos = normal.dot(light.direction);
        if (cos <= 0 ||
            scene.geometry.occluded({point.origin(light.direction), light.direction, light.distance * (1 - 1e-4f)}))
            continue;
        for (int n = 0; n < nodes; ++n) {
            scene.lights.sample(scene.geometry, point.position, at[n], choice, Vec2(0.5f, 0.5f), light);
            row.irradiance[n] += share * cos * light.radiance[0] / light.pdf;
        }
    }
    if (emitter >= 0 && !patch.back)
        for (int n = 0; n < nodes; ++n)
            row.emission[n] =
                pi_f * scene.lights.surface_radiance(emitter, patch.centre, patch.centre.geometric_normal, at[n])[0];
    return row;
}

void RadiosityIntegrator::prepare(const TransportProblem& problem, const JobControl& control) {
    if (!problem.scene.geometry.instances.empty())
        throw input_error({}, "radiosity does not know instances", "a patch belongs to one shape", "use path");
    for (const Emitter& emitter : problem.scene.lights.all())
        if (const auto* area = std::get_if<AreaEmitter>(&emitter); area && area->radiance.varies())
            throw input_error({}, "radiosity does not know textured lamps", "a patch shines alike all over",
                              "use path");
    patches_.emplace(problem.scene, settings_.patches, most_patches);
    const int n = patches_->count();
    std::vector<Row> rows(n);
    std::atomic<int> done{0};
    parallel_for(0, n, [&](std::ptrdiff_t i) {
        if (control.stop_requested()) return;
        rows[i] = cast_rays(problem, static_cast<int>(i));
        if (const int d = ++done; d % 64 == 0) control.report({"form factors", d, n, ""});
    });
    if (control.stop_requested()) throw Error(ErrorKind::interrupted, "stopped while casting form factors");
    form_factors_.resize(n, n);
    for (int i = 0; i < n; ++i)
        form_factors_.row(i) = Eigen::Map<const Eigen::RowVectorXd>(rows[i].form_factors.data(), n);

    // Solve at every wavelength; keep what is reflected.
    radiance_.resize(static_cast<std::size_t>(n) * nodes);
    for (int node = 0; node < nodes; ++node) {
        Eigen::VectorXd rho(n), irradiance(n), emission(n);
        for (int i = 0; i < n; ++i) {
            rho[i] = rows[i].reflectance[node];
            irradiance[i] = rows[i].irradiance[node];
            emission[i] = rows[i].emission[node];
        }
        const Eigen::VectorXd radiosity = solve(rho, irradiance, emission);
        for (int i = 0; i < n; ++i)
            radiance_[static_cast<std::size_t>(i) * nodes + node] =
                static_cast<float>((radiosity[i] - emission[i]) * inv_pi_f);
    }
    notes_["radiosity_patches"] = fmt::format("{}", n);
    if (settings_.solver != Solver::lu) notes_["radiosity_iterations"] = fmt::format("{}", iterations_);
}

Eigen::VectorXd RadiosityIntegrator::solve(const Eigen::VectorXd& rho, const Eigen::VectorXd& irradiance,
                                           const Eigen::VectorXd& emission) {
    const Eigen::VectorXd source = emission + rho.cwiseProduct(irradiance);
    if (rho.maxCoeff() >= 1 && settings_.solver != Solver::lu)
        throw input_error({}, "a surface reflects all light", "the iteration need not end", "use solver = \"lu\"");
    if (settings_.solver != Solver::lu) return iterate(rho, source);
    if (!factorization_ || factored_reflectance_ != rho) {
        factorization_.emplace(Eigen::MatrixXd::Identity(rho.size(), rho.size()) - rho.asDiagonal() * form_factors_);
        factored_reflectance_ = rho;
    }
    const Eigen::VectorXd radiosity = factorization_->solve(source);
    if (!radiosity.allFinite() || radiosity.minCoeff() < -1e-6 * (1 + radiosity.cwiseAbs().maxCoeff()))
        throw Error(ErrorKind::runtime, "the radiosity system has no solution: a closed room that absorbs nothing");
    return radiosity;
}

Eigen::VectorXd RadiosityIntegrator::iterate(const Eigen::VectorXd& rho, const Eigen::VectorXd& source) {
    // Neumann: B <- E + rho F B. Jacobi: the same with a patch's own light solved for. Gauss and Seidel: at once.
    Eigen::VectorXd b = source;
    const int n = static_cast<int>(b.size());
    for (int iteration = 1;; ++iteration) {
        const Eigen::VectorXd before = b;
        const Eigen::VectorXd& from = settings_.solver == Solver::gauss_seidel ? b : before;
        for (int i = 0; i < n; ++i) {
            const double received = form_factors_.row(i).dot(from);
            const double own = settings_.solver == Solver::neumann ? 0.0 : form_factors_(i, i);
            b[i] = (source[i] + rho[i] * (received - own * from[i])) / (1 - rho[i] * own);
        }
        iterations_ = std::max(iterations_, iteration);
        if ((b - before).cwiseAbs().maxCoeff() <= tolerance * b.cwiseAbs().maxCoeff()) return b;
        if (iteration >= most_iterations)
            throw Error(ErrorKind::check, "the radiosity iteration does not converge: use solver = \"lu\"");
    }
}

Float4 RadiosityIntegrator::reflected(int patch, const Wavelengths& w) const {
    Float4 result;
    const float* values = &radiance_[static_cast<std::size_t>(patch) * nodes];
    for (int lane = 0; lane < wavelengths_per_path; ++lane) {
        const float x = (w.nm[lane] - wavelength_min_nm) / node_step_nm;
        const int node = std::min(static_cast<int>(x), nodes - 2);
        result[lane] = values[node] + (x - node) * (values[node + 1] - values[node]);
    }
    return result;
}

void RadiosityIntegrator::trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& w,
                                Sampler& sampler, PathRecord& record) const {
    const Scene& scene = problem.scene;
    const auto add = [&](Float4 radiance) { record.add(make_stokes(radiance, splat(0), splat(0), splat(0)), 0); };
    const auto show = [&](int emitter, Float4 radiance) {
        const Throughput camera_ray(camera.stokes_axis);
        record.add(arriving(camera_ray, scene.lights, emitter, radiance, -camera.ray.direction), 0);
    };
    sampler.seek(first_draw);

    // What the camera sees directly.
    Hit hit;
    record.hit = scene.geometry.intersect(camera.ray, hit);
    if (!record.hit) {
        if (!settings_.hide_emitters)
            scene.lights.for_each_environment(camera.ray.direction, w,
                                              [&](Float4 radiance, float, int emitter) { show(emitter, radiance); });
        return;
    }
    const SurfacePoint point = scene.geometry.surface(camera.ray, hit);
    const Shape& shape = scene.geometry.shapes[hit.shape];
    if (shape.emitter >= 0 && !settings_.hide_emitters)
        show(shape.emitter, scene.lights.surface_radiance(shape.emitter, point, -camera.ray.direction, w));
    if (!settings_.gather) {
        const int patch = patches_->find(hit, point, camera.ray.direction);
        if (patch >= 0) add(reflected(patch, w));
        return;
    }

    // Direct light by light sampling.
    const Bsdf& bsdf = scene.bsdfs[shape.bsdf];
    const ShadingPoint shading{&w, point.uv, scene.bsdfs.data()};
    const Vec3 outgoing = point.frame.to_local(-camera.ray.direction);
    LightSample light;
    BsdfValue value;
    const float choice = sampler.next();
    if (scene.lights.any_sampled() &&
        scene.lights.sample(scene.geometry, point.position, w, choice, sampler.next2(), light) &&
        bsdf_evaluate(bsdf, shading, outgoing, point.frame.to_local(light.direction), value) &&
        !scene.geometry.occluded({point.origin(light.direction), light.direction, light.distance * (1 - 1e-4f)})) {
        const float share = light.delta ? 1.0f : power_heuristic(light.pdf, value.pdf);
        add(light.radiance * value.f.intensity() * (share / light.pdf));
    }

    // One ray gathers: the rest of the direct light, and what patches reflect.
    BsdfSample sample;
    const float lobe = sampler.next();
    if (!bsdf_sample(bsdf, shading, outgoing, lobe, sampler.next2(), sample)) return;
    const Vec3 direction = point.frame.to_world(sample.incident).normalized();
    const Ray ray{point.origin(direction), direction, INFINITY};
    const auto share = [&](float light_pdf) { return light_pdf > 0 ? power_heuristic(sample.pdf, light_pdf) : 1.0f; };
    const Float4 weight = sample.weight.intensity();
    if (!scene.geometry.intersect(ray, hit)) {
        scene.lights.for_each_environment(
            direction, w, [&](Float4 radiance, float light_pdf, int) { add(weight * radiance * share(light_pdf)); });
        return;
    }
    const SurfacePoint seen = scene.geometry.surface(ray, hit);
    if (const int emitter = scene.geometry.shapes[hit.shape].emitter; emitter >= 0)
        add(weight * scene.lights.surface_radiance(emitter, seen, -direction, w) *
            share(scene.lights.surface_pdf(emitter, scene.geometry, hit, seen, point.position)));
    if (const int patch = patches_->find(hit, seen, direction); patch >= 0) add(weight * reflected(patch, w));
}

}  // namespace patina::render
