#include "patina/render/emission.h"

#include "patina/render/shape_area.h"

namespace patina::render {

namespace {

struct Start {
    const Geometry& geometry;
    const Wavelengths& w;
    const Vec2 &u_origin, &u_ray;
    EmittedRay& out;

    bool operator()(const AreaEmitter& e) const {
        const Shape& shape = geometry.shapes[e.shape];
        float density = 1;
        const Vec2 place = e.table ? e.table->sample(u_origin, density) : u_origin;
        point_of_shape(geometry, shape, place, out.position, out.normal, out.uv);
        const Vec3 local = cosine_hemisphere(u_ray);
        out.direction = Frame(out.normal).to_world(local);
        out.origin_pdf = density / shape.area;
        out.ray_pdf = local.z() * inv_pi_f;
        out.power = e.radiance.at(w, out.uv) * (pi_f * shape.area / density);
        // Start on the side it leaves to.
        const float reach = std::max(out.position.cwiseAbs().maxCoeff(), 0.1f * geometry.radius());
        out.position += out.normal * (2e-6f * reach);
        return out.ray_pdf > 0;
    }
    bool operator()(const PointEmitter& e) const {
        out.position = e.position;
        out.direction = uniform_sphere(u_ray);
        out.origin_pdf = 1;
        out.ray_pdf = 0.25f * inv_pi_f;
        out.power = e.intensity.at(w) * (4 * pi_f);
        return out.delta_origin = true;
    }
    bool operator()(const SpotEmitter& e) const {
        const float solid_angle = 2 * pi_f * (1 - std::cos(e.cutoff_rad));
        const float cos = 1 - u_ray.x() * (1 - std::cos(e.cutoff_rad)), sin = safe_sqrt(1 - cos * cos);
        const float phi = 2 * pi_f * u_ray.y();
        out.position = e.position;
        out.direction = Frame(e.axis).to_world({sin * std::cos(phi), sin * std::sin(phi), cos});
        out.origin_pdf = 1;
        out.ray_pdf = 1 / solid_angle;
        out.power = e.intensity_along(w, out.direction) * solid_angle;
        return out.delta_origin = true;
    }
    bool operator()(const DirectionalEmitter& e) const {
        from_disk(e.direction, e.irradiance.at(w), 1);
        return out.delta_origin = true;
    }
    bool operator()(const ConstantEmitter& e) const {
        const float pdf = 0.25f * inv_pi_f;
        from_disk(uniform_sphere(u_origin), e.radiance.at(w) / pdf, pdf);
        return true;
    }
    bool operator()(const EnvironmentEmitter& e) const {
        Vec3 to_infinity;
        float pdf = 0;
        e.sample(u_origin, to_infinity, pdf);
        if (!(pdf > 0)) return false;
        from_disk(-to_infinity, e.radiance(w, to_infinity) / pdf, pdf);
        return true;
    }

  private:
    // Parallel light through a disk as wide as the scene, before it.
    void from_disk(const Vec3& direction, Float4 irradiance, float direction_pdf) const {
        const float radius = geometry.radius();
        const Vec2 on_disk = concentric_disk(u_ray) * radius;
        out.infinite = true;
        out.direction = direction;
        out.position = geometry.centre() + Frame(direction).to_world({on_disk.x(), on_disk.y(), -1.01f * radius});
        out.origin_pdf = direction_pdf;
        out.ray_pdf = inv_pi_f / sqr(radius);
        out.power = irradiance / out.ray_pdf;
    }
};

}  // namespace

Emission::Emission(const Lights& lights, const Geometry& geometry) : lights_(lights), geometry_(geometry) {
    std::vector<double> powers;
    double total = 0;
    for (const Emitter& emitter : lights.all()) total += powers.emplace_back(emitted_power(emitter, geometry));
    if (!(total > 0)) powers.assign(powers.size(), 1.0);
    choice_ = DiscreteDistribution(powers);
}

bool Emission::sample(const Wavelengths& w, float u, const Vec2& u_origin, const Vec2& u_ray, EmittedRay& ray) const {
    const DiscreteDistribution::Choice choice = choice_.sample(u);
    ray.emitter = choice.index;
    if (!std::visit(Start{geometry_, w, u_origin, u_ray, ray}, lights_.all()[choice.index])) return false;
    ray.origin_pdf *= choice.probability;
    ray.power /= choice.probability;
    return largest(ray.power) > 0;
}

void Emission::surface_pdfs(int emitter, float cos, float area_density, float& origin_pdf, float& ray_pdf) const {
    const auto& area = std::get<AreaEmitter>(lights_.all()[emitter]);
    origin_pdf = choice_.probability(emitter) * area_density / geometry_.shapes[area.shape].area;
    ray_pdf = std::max(cos, 0.0f) * inv_pi_f;
}

void Emission::environment_pdfs(int emitter, const Vec3& to_infinity, float& origin_pdf, float& ray_pdf) const {
    const auto* map = std::get_if<EnvironmentEmitter>(&lights_.all()[emitter]);
    origin_pdf = choice_.probability(emitter) * (map ? map->pdf(to_infinity) : 0.25f * inv_pi_f);
    ray_pdf = inv_pi_f / sqr(geometry_.radius());
}

void Emission::delta_pdfs(int emitter, float& origin_pdf, float& ray_pdf) const {
    origin_pdf = choice_.probability(emitter);
    ray_pdf = 0.25f * inv_pi_f;
    const Emitter& e = lights_.all()[emitter];
    if (const auto* spot = std::get_if<SpotEmitter>(&e)) ray_pdf = 1 / (2 * pi_f * (1 - std::cos(spot->cutoff_rad)));
    if (std::holds_alternative<DirectionalEmitter>(e)) ray_pdf = inv_pi_f / sqr(geometry_.radius());
}

}  // namespace patina::render
