#include "patina/render/embree_scene.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/geometry.h"

namespace patina::render {

namespace {

// A ray on its way through Embree, with room for what only we know of an analytic hit.
struct Context {
    RTCIntersectContext embree;
    Hit analytic_hit;
};

using Shapes = std::span<const AnalyticShape>;

void bounds_of_analytic(const RTCBoundsFunctionArguments* args) {
    const AnalyticShape& s = (*static_cast<const Shapes*>(args->geometryUserPtr))[args->primID];
    Vec3 extent = s.a.cwiseAbs() + s.b.cwiseAbs();
    if (s.kind == AnalyticShape::Kind::sphere) extent = Vec3::Constant(s.radius);
    // A flat box still needs room for the rounding of the traversal.
    extent += Vec3::Constant(1e-6f * (s.o.cwiseAbs().maxCoeff() + extent.maxCoeff()));
    const Vec3 low = s.o - extent, high = s.o + extent;
    *args->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
}

// Inside an instance the ray is transformed, its direction not of unit length: distances grow by `scale`.
Ray unit_ray_of(const RTCRay& r, float& scale) {
    const Vec3 direction(r.dir_x, r.dir_y, r.dir_z);
    scale = direction.norm();
    return {{r.org_x, r.org_y, r.org_z}, direction / scale, r.tfar * scale};
}

void intersect_analytic(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* ray_hit = reinterpret_cast<RTCRayHit*>(args->rayhit);  // one ray at a time is all we send
    const AnalyticShape& s = (*static_cast<const Shapes*>(args->geometryUserPtr))[args->primID];
    Hit& hit = reinterpret_cast<Context*>(args->context)->analytic_hit;
    float scale = 1;
    const Ray ray = unit_ray_of(ray_hit->ray, scale);
    Hit found;
    found.t = ray.t_max;
    if (!s.intersect(ray, static_cast<int>(args->primID), found)) return;
    hit = found;
    ray_hit->ray.tfar = found.t / scale;
    ray_hit->hit.geomID = args->geomID;
    ray_hit->hit.primID = args->primID;
    ray_hit->hit.instID[0] = args->context->instID[0];
}

void occluded_analytic(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const AnalyticShape& s = (*static_cast<const Shapes*>(args->geometryUserPtr))[args->primID];
    float scale = 1;
    const Ray unit = unit_ray_of(*ray, scale);
    Hit hit;
    hit.t = unit.t_max;
    if (s.intersect(unit, 0, hit)) ray->tfar = -INFINITY;
}

template <class T>
void fill_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const T* data, std::size_t count) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count);
    if (!buffer) throw Error(ErrorKind::runtime, "out of memory for the scene's geometry");
    std::copy_n(data, count, static_cast<T*>(buffer));
}

void set_ray(RTCRay& out, const Ray& ray) {
    out.org_x = ray.origin.x(), out.org_y = ray.origin.y(), out.org_z = ray.origin.z();
    out.dir_x = ray.direction.x(), out.dir_y = ray.direction.y(), out.dir_z = ray.direction.z();
    out.tnear = 0;
    out.tfar = ray.t_max;
    out.time = ray.time;
    out.mask = 0xffffffffu;
    out.id = 0;
    out.flags = 0;
}

// One of Embree's scenes: the world, or a group of shapes in its own space.
struct Part {
    RTCScene scene = nullptr;
    Shapes analytic;
    unsigned analytic_id = RTC_INVALID_GEOMETRY_ID;
    std::vector<int> of_geometry;  // by Embree's number: the shape, or the instance

    void attach(RTCGeometry geometry, int index) {
        rtcCommitGeometry(geometry);
        const unsigned id = rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        of_geometry.resize(std::max<std::size_t>(of_geometry.size(), id + 1), -1);
        of_geometry[id] = index;
        if (index < 0) analytic_id = id;
    }
};

}  // namespace

struct EmbreeScene::State {
    RTCDevice device = nullptr;
    const Geometry* geometry = nullptr;
    std::vector<Part> parts;  // [0] the world, [1 + group]

    ~State() {
        for (const Part& part : parts)
            if (part.scene) rtcReleaseScene(part.scene);
        if (device) rtcReleaseDevice(device);
    }
    // Meshes and analytic shapes of the world (group -1) or of a group.
    void fill(Part& part, int group) {
        part.scene = rtcNewScene(device);
        rtcSetSceneFlags(part.scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(part.scene, RTC_BUILD_QUALITY_HIGH);
        for (const MeshShape& m : geometry->meshes) {
            if (m.group != group) continue;
            RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            fill_buffer(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, m.mesh->positions.data(),
                        m.mesh->positions.size());
            fill_buffer(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, m.mesh->triangles.data(),
                        m.mesh->triangles.size());
            part.attach(mesh, m.shape);
        }
        if (part.analytic.empty()) return;
        RTCGeometry shapes = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(shapes, static_cast<unsigned>(part.analytic.size()));
        rtcSetGeometryUserData(shapes, &part.analytic);
        rtcSetGeometryBoundsFunction(
            shapes, [](const RTCBoundsFunctionArguments* args) { bounds_of_analytic(args); }, nullptr);
        rtcSetGeometryIntersectFunction(shapes, intersect_analytic);
        rtcSetGeometryOccludedFunction(shapes, occluded_analytic);
        part.attach(shapes, -1);
    }
    void attach_instance(int index) {
        const Instance& instance = geometry->instances[index];
        RTCGeometry copy = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(copy, parts[1 + instance.group].scene);
        rtcSetGeometryTimeStepCount(copy, static_cast<unsigned>(instance.to_world.size()));
        for (unsigned step = 0; step < instance.to_world.size(); ++step)
            rtcSetGeometryTransform(copy, step, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, instance.to_world[step].data());
        parts[0].attach(copy, index);
    }
};

EmbreeScene::EmbreeScene(const Geometry& geometry, std::span<const AnalyticShape> analytic)
    : state_(std::make_unique<State>()) {
    state_->geometry = &geometry;
    state_->device = rtcNewDevice(nullptr);
    if (!state_->device)
        throw Error(ErrorKind::runtime,
                    fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));

    // Groups before their copies. Embree keeps pointers to the parts: all of them are made first.
    state_->parts.resize(1 + geometry.groups.size());
    state_->parts[0].analytic = analytic;
    for (int group = -1; group < static_cast<int>(geometry.groups.size()); ++group) {
        Part& part = state_->parts[1 + group];
        if (group >= 0)
            part.analytic =
                Shapes(geometry.group_analytic).subspan(geometry.groups[group].first, geometry.groups[group].count);
        state_->fill(part, group);
        if (group >= 0) rtcCommitScene(part.scene);
    }
    for (int i = 0; i < static_cast<int>(geometry.instances.size()); ++i) state_->attach_instance(i);
    rtcCommitScene(state_->parts[0].scene);
    if (const RTCError error = rtcGetDeviceError(state_->device); error != RTC_ERROR_NONE)
        throw Error(ErrorKind::runtime,
                    fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::intersect(const Ray& ray, Hit& hit) const {
    RTCRayHit query;
    set_ray(query.ray, {ray.origin, ray.direction, hit.t, ray.time});
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Context context;
    rtcInitIntersectContext(&context.embree);
    rtcIntersect1(state_->parts[0].scene, &context.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    int instance = -1, first = 0;
    const Part* part = &state_->parts[0];
    if (query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
        instance = part->of_geometry[query.hit.instID[0]];
        const int group = state_->geometry->instances[instance].group;
        first = state_->geometry->groups[group].first;
        part = &state_->parts[1 + group];
    }
    if (query.hit.geomID == part->analytic_id) {
        hit = context.analytic_hit;
        hit.t = query.ray.tfar;
        hit.primitive += first;
    } else {
        hit = {
            query.ray.tfar, part->of_geometry[query.hit.geomID], static_cast<int>(query.hit.primID), true, query.hit.u,
            query.hit.v};
    }
    hit.instance = instance;
    return true;
}

bool EmbreeScene::occluded(const Ray& ray) const {
    RTCRay query;
    set_ray(query, ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(state_->parts[0].scene, &context, &query);
    return query.tfar < 0;
}

}  // namespace patina::render
