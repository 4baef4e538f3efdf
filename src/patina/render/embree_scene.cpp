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

Ray ray_of(const RTCRay& r) {
    return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar};
}

void intersect_analytic(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* ray_hit = reinterpret_cast<RTCRayHit*>(args->rayhit);  // one ray at a time is all we send
    const AnalyticShape& s = (*static_cast<const Shapes*>(args->geometryUserPtr))[args->primID];
    Hit& hit = reinterpret_cast<Context*>(args->context)->analytic_hit;
    hit.t = ray_hit->ray.tfar;
    if (!s.intersect(ray_of(ray_hit->ray), static_cast<int>(args->primID), hit)) return;
    ray_hit->ray.tfar = hit.t;
    ray_hit->hit.geomID = args->geomID;
    ray_hit->hit.primID = args->primID;
}

void occluded_analytic(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const AnalyticShape& s = (*static_cast<const Shapes*>(args->geometryUserPtr))[args->primID];
    Hit hit;
    hit.t = ray->tfar;
    if (s.intersect(ray_of(*ray), 0, hit)) ray->tfar = -INFINITY;
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
    out.time = 0;
    out.mask = 0xffffffffu;
    out.id = 0;
    out.flags = 0;
}

}  // namespace

struct EmbreeScene::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    Shapes analytic;
    unsigned analytic_id = RTC_INVALID_GEOMETRY_ID;
    std::vector<int> shape_of_geometry;

    ~State() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void attach(RTCGeometry geometry, int shape) {
        rtcCommitGeometry(geometry);
        const unsigned id = rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        shape_of_geometry.resize(std::max<std::size_t>(shape_of_geometry.size(), id + 1), -1);
        shape_of_geometry[id] = shape;
        if (shape < 0) analytic_id = id;
    }
};

EmbreeScene::EmbreeScene(const std::vector<MeshShape>& meshes, std::span<const AnalyticShape> analytic)
    : state_(std::make_unique<State>()) {
    state_->analytic = analytic;
    state_->device = rtcNewDevice(nullptr);
    if (!state_->device)
        throw Error(ErrorKind::runtime,
                    fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    state_->scene = rtcNewScene(state_->device);
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_HIGH);

    for (const MeshShape& m : meshes) {
        RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        fill_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, m.mesh->positions.data(),
                    m.mesh->positions.size());
        fill_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, m.mesh->triangles.data(),
                    m.mesh->triangles.size());
        state_->attach(geometry, m.shape);
    }
    if (!analytic.empty()) {
        RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(analytic.size()));
        rtcSetGeometryUserData(geometry, &state_->analytic);
        rtcSetGeometryBoundsFunction(
            geometry, [](const RTCBoundsFunctionArguments* args) { bounds_of_analytic(args); }, nullptr);
        rtcSetGeometryIntersectFunction(geometry, intersect_analytic);
        rtcSetGeometryOccludedFunction(geometry, occluded_analytic);
        state_->attach(geometry, -1);
    }
    rtcCommitScene(state_->scene);
    if (const RTCError error = rtcGetDeviceError(state_->device); error != RTC_ERROR_NONE)
        throw Error(ErrorKind::runtime,
                    fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::intersect(const Ray& ray, Hit& hit) const {
    RTCRayHit query;
    set_ray(query.ray, {ray.origin, ray.direction, hit.t});
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Context context;
    rtcInitIntersectContext(&context.embree);
    rtcIntersect1(state_->scene, &context.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    if (query.hit.geomID == state_->analytic_id) {
        hit = context.analytic_hit;
        hit.t = query.ray.tfar;
        return true;
    }
    hit = {query.ray.tfar,
           state_->shape_of_geometry[query.hit.geomID],
           static_cast<int>(query.hit.primID),
           true,
           query.hit.u,
           query.hit.v};
    return true;
}

bool EmbreeScene::occluded(const Ray& ray) const {
    RTCRay query;
    set_ray(query, ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(state_->scene, &context, &query);
    return query.tfar < 0;
}

}  // namespace patina::render
