// SPDX-License-Identifier: MIT
// What it costs that a mesh deforms or tears. Each frame shears the first model along x by another
// amount, fits its hierarchy, and finds the overlaps with the second, which stays as it was baked.
// Beside Embree (REFIT), Bullet's GImpact and FCL, each in its own precision. Processor time, one
// thread, contenders in turn.
//
// Usage: deform_bench DEFORMING FIXED [FRAMES]
// Both are bakes with --effects overlap. The place of the second is such that the two overlap.
//
// Prints a CSV table: microseconds of a frame by way, medians and 95th percentiles, with the
// triangle pairs of the last frame. "refit 1 %" moves the hundredth of the vertices that lies
// lowest along x, "tear 1 %" removes a hundredth of the triangles and appends them again.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <vector>

#include "bench_input.h"
#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "live_object.h"

#ifdef CDPREP_HAVE_EMBREE
#include <embree3/rtcore.h>
#endif
#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif
#ifdef CDPREP_HAVE_BULLET
#include "gimpact_mesh.h"
#endif

namespace cdprep {
namespace {

constexpr double kMostShear = 0.5;

/// A mesh in the numbering of its source, and its shape in each frame.
struct Deforming {
    std::vector<Float3> rest;
    std::vector<Float3> now;
    std::vector<format::Triangle> triangles;
    std::vector<std::uint32_t> by_x;  ///< vertices

    explicit Deforming(const Model& model) : rest(model.vertex_count()) {
        for (std::uint32_t i = 0; i < model.vertex_count(); ++i) {
            rest[i] = model.mesh().positions_f32[i];
        }
        triangles.assign(model.mesh().triangles.begin(), model.mesh().triangles.end());
        now = rest;
        by_x.resize(rest.size());
        std::iota(by_x.begin(), by_x.end(), 0U);
        std::ranges::sort(by_x, {}, [&](std::uint32_t v) { return rest[v].x; });
    }
    void shear(int frame) {
        const auto by = static_cast<float>(kMostShear * std::sin(0.37 * frame));
        for (std::size_t i = 0; i < rest.size(); ++i) now[i].x = rest[i].x + by * rest[i].z;
    }
};

/// A way to do a frame: what is timed, and the pairs it finds.
class Way {
public:
    Way() = default;
    Way(const Way&) = delete;
    Way& operator=(const Way&) = delete;
    virtual ~Way() = default;
    [[nodiscard]] virtual const char* name() const = 0;
    /// Fits to the present shape.
    virtual void fit(const Deforming& mesh, int frame) = 0;
    /// Returns the number of pairs of triangles that overlap the fixed model.
    virtual std::size_t overlap() {
        return 0;
    }
};

class OurRefit : public Way {
public:
    /// Moves a share of the vertices; 1: all.
    OurRefit(const char* name, const Deforming& mesh, const Model& fixed, double share,
             const LiveLimits& limits = {})
        : name_(name), live_(make_live(mesh.rest, mesh.triangles, limits)), fixed_(fixed) {
        const auto count = static_cast<std::size_t>(share * static_cast<double>(mesh.by_x.size()));
        if (share < 1)
            vertices_.assign(mesh.by_x.begin(),
                             mesh.by_x.begin() + static_cast<std::ptrdiff_t>(count));
        positions_.resize(vertices_.size());
    }
    [[nodiscard]] const char* name() const override {
        return name_;
    }
    void fit(const Deforming& mesh, int /*frame*/) override {
        for (std::size_t i = 0; i < vertices_.size(); ++i) positions_[i] = mesh.now[vertices_[i]];
        const auto done = vertices_.empty() ? live_.model.refit(mesh.now)
                                            : live_.model.refit(vertices_, positions_);
        if (!done) stop(done.error().message);
    }
    std::size_t overlap() override {
        return overlaps({live_.model.model(), fixed_, Placement::b_moves({})}, workspace_, {});
    }

protected:
    LiveModel& model() {
        return live_.model;
    }

private:
    const char* name_;
    LiveObject live_;
    const Model& fixed_;
    std::vector<std::uint32_t> vertices_;
    std::vector<Float3> positions_;
    Workspace workspace_;
};

/// Removes a hundredth of the triangles and appends them again, then moves all vertices.
class OurTear final : public OurRefit {
public:
    OurTear(const Deforming& mesh, const Model& fixed)
        : OurRefit("cdprep_tear_1_percent", mesh, fixed, 1,
                   {.triangles = static_cast<std::uint32_t>(mesh.triangles.size())}),
          numbers_(mesh.triangles.size()) {
        std::iota(numbers_.begin(), numbers_.end(), 0U);
    }
    void fit(const Deforming& mesh, int frame) override {
        const std::size_t size = mesh.triangles.size() / 100;
        const std::size_t first = static_cast<std::size_t>(frame) * size % (99 * size);
        const auto gone = std::span(numbers_).subspan(first, size);
        if (!model().remove(gone)) stop("No triangle was removed.");
        const auto added = model().append(std::span(mesh.triangles).subspan(first, size));
        if (!added) stop(added.error().message);
        std::iota(gone.begin(), gone.end(), added.value());
        OurRefit::fit(mesh, frame);
    }

private:
    std::vector<std::uint32_t> numbers_;
};

#ifdef CDPREP_HAVE_EMBREE
class EmbreeRefit final : public Way {
public:
    explicit EmbreeRefit(const Deforming& mesh)
        : device_(rtcNewDevice("threads=1")),
          scene_(rtcNewScene(device_)),
          geometry_(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE)) {
        // Embree reads up to the end of the last vector of four.
        points_ = static_cast<Float3*>(rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, sizeof(Float3),
                                                               mesh.rest.size()));
        auto* const corners = static_cast<format::Triangle*>(
            rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(format::Triangle), mesh.triangles.size()));
        std::ranges::copy(mesh.rest, points_);
        std::ranges::copy(mesh.triangles, corners);
        rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);  // else it builds anew
        rtcCommitGeometry(geometry_);
        rtcAttachGeometry(scene_, geometry_);
        rtcCommitScene(scene_);
    }
    ~EmbreeRefit() override {
        rtcReleaseGeometry(geometry_);
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    [[nodiscard]] const char* name() const override {
        return "embree_refit";
    }
    void fit(const Deforming& mesh, int /*frame*/) override {
        std::ranges::copy(mesh.now, points_);
        rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry_);
        rtcCommitScene(scene_);
    }

private:
    RTCDevice device_;
    RTCScene scene_;
    RTCGeometry geometry_;
    Float3* points_;
};
#endif

#ifdef CDPREP_HAVE_BULLET
class GImpactRefit final : public Way {
public:
    explicit GImpactRefit(const Deforming& mesh) : mesh_(mesh.rest, mesh.triangles) {}
    [[nodiscard]] const char* name() const override {
        return "bullet_gimpact";
    }
    void fit(const Deforming& mesh, int /*frame*/) override {
        mesh_.refit(mesh.now);
    }

private:
    GImpactMesh mesh_;
};
#endif

#ifdef CDPREP_HAVE_FCL
template <class Box>
class FclRefit final : public Way {
public:
    FclRefit(const char* name, const Model& moving, const Model& fixed)
        : name_(name), moving_(fcl_model<Box>(moving)), fixed_(fcl_model<Box>(fixed)) {}
    [[nodiscard]] const char* name() const override {
        return name_;
    }
    void fit(const Deforming& mesh, int /*frame*/) override {
        fcl_refit(moving_, mesh.now, points_);
    }
    std::size_t overlap() override {
        fcl::CollisionResultd result;
        const auto still = fcl::Transform3d::Identity();
        fcl::collide(&moving_, still, &fixed_, still, fcl::CollisionRequestd(1U << 30, false),
                     result);
        return result.numContacts();
    }

private:
    const char* name_;
    fcl::BVHModel<Box> moving_;
    fcl::BVHModel<Box> fixed_;
    std::vector<fcl::Vector3d> points_;
};
#endif

std::vector<std::unique_ptr<Way>> all_ways(const Deforming& mesh, const Model& moving,
                                           const Model& fixed) {
    std::vector<std::unique_ptr<Way>> ways;
    ways.push_back(std::make_unique<OurRefit>("cdprep_refit", mesh, fixed, 1));
    ways.push_back(std::make_unique<OurRefit>("cdprep_refit_10_percent", mesh, fixed, 0.1));
    ways.push_back(std::make_unique<OurRefit>("cdprep_refit_1_percent", mesh, fixed, 0.01));
    ways.push_back(std::make_unique<OurTear>(mesh, fixed));
#ifdef CDPREP_HAVE_EMBREE
    ways.push_back(std::make_unique<EmbreeRefit>(mesh));
#endif
#ifdef CDPREP_HAVE_BULLET
    ways.push_back(std::make_unique<GImpactRefit>(mesh));
#endif
#ifdef CDPREP_HAVE_FCL
    ways.push_back(std::make_unique<FclRefit<fcl::AABBd>>("fcl_aabb", moving, fixed));
    ways.push_back(std::make_unique<FclRefit<fcl::OBBd>>("fcl_obb", moving, fixed));
    ways.push_back(std::make_unique<FclRefit<fcl::OBBRSSd>>("fcl_obbrss", moving, fixed));
#endif
    return ways;
}

void run(const Model& moving, const Model& fixed, int frames) {
    Deforming mesh(moving);
    const auto ways = all_ways(mesh, moving, fixed);
    std::vector<std::vector<double>> fit_us(ways.size()), overlap_us(ways.size());
    std::vector<std::size_t> pairs(ways.size());
    for (int frame = 0; frame < frames; ++frame) {
        mesh.shear(frame);
        for (std::size_t i = 0; i < ways.size(); ++i) {
            const double begun = thread_us();
            ways[i]->fit(mesh, frame);
            const double fitted = thread_us();
            pairs[i] = ways[i]->overlap();
            overlap_us[i].push_back(thread_us() - fitted);
            fit_us[i].push_back(fitted - begun);
        }
    }
    std::printf("way,triangles,fit_us,fit_p95_us,overlap_us,pairs\n");
    for (std::size_t i = 0; i < ways.size(); ++i) {
        std::printf("%s,%zu,%.0f,%.0f,%.0f,%zu\n", ways[i]->name(), mesh.triangles.size(),
                    median(fit_us[i]), median(fit_us[i], 0.95), median(overlap_us[i]), pairs[i]);
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 3) cdprep::stop("Usage: deform_bench DEFORMING FIXED [FRAMES]");
    cdprep::run(cdprep::open_or_stop(arguments[1]), cdprep::open_or_stop(arguments[2]),
                count > 3 ? std::max(1, std::atoi(arguments[3])) : 50);
}
