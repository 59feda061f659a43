// SPDX-License-Identifier: GPL-3.0-or-later
// What it costs to ask a deforming mesh about itself. A cloth-like sheet lies folded in two layers
// that touch at their ripples, in about 1 % of its triangles. Each frame moves the ripples, fits
// the hierarchy, and finds the pairs of triangles that overlap and share no vertex. Beside CGAL's
// self_intersections(), FCL and Bullet's GImpact. Processor time, one thread, contenders in turn.
//
// Usage: self_overlaps_bench [FRAMES [ROWS]]
// The sheet has 2 ROWS^2 triangles.
//
// Prints a CSV table: milliseconds of a frame by way, medians. `times` is the whole frame by ours.
// `pairs` are each way's own, `same` counts the frames with exactly ours. FCL and Bullet know no
// common vertices. Neighbours are dropped from FCL's pairs untimed, and from Bullet's before it
// tests the triangles. Ends with 1 if CGAL's pairs differ: it alone is exact.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/self.h"
#include "live_object.h"

#ifdef CDPREP_HAVE_CGAL
#include "cgal_surface.h"
#endif
#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif
#ifdef CDPREP_HAVE_BULLET
#include "gimpact_mesh.h"
#endif

namespace cdprep {
namespace {

using format::Float3;
using format::Triangle;
using Pairs = std::vector<TrianglePair>;

/// A square sheet that is folded once, about the y axis.
class Cloth {
public:
    explicit Cloth(std::uint32_t rows) : rows_(rows) {
        const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * (rows + 1) + j; };
        for (std::uint32_t i = 0; i < rows; ++i) {
            for (std::uint32_t j = 0; j < rows; ++j) {
                triangles.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
                triangles.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
            }
        }
        set(0);
    }
    /// Moves the ripples of both layers.
    void set(int frame) {
        now.clear();
        for (std::uint32_t i = 0; i <= rows_; ++i) {
            for (std::uint32_t j = 0; j <= rows_; ++j) {
                now.push_back(at(2.0 * i / rows_ - 1, 2.0 * j / rows_ - 1, 0.1 * frame));
            }
        }
    }
    [[nodiscard]] bool share_a_vertex(std::uint32_t a, std::uint32_t b) const {
        const auto& v = triangles[a].vertex;
        const auto& w = triangles[b].vertex;
        return std::find_first_of(v.begin(), v.end(), w.begin(), w.end()) != v.end();
    }

    std::vector<Float3> now;
    std::vector<Triangle> triangles;
    double gap = 0.01;  ///< half the distance of the layers

private:
    [[nodiscard]] Float3 at(double s, double t, double time) const {
        constexpr double kRadius = 0.02, kRipple = 0.01;
        const double layer = std::tanh(s / kRadius);
        const double across = (layer > 0 ? 17 : 13) * std::fabs(s) + time;
        const double along = (layer > 0 ? 11 : 19) * t - time;
        const double ripple = kRipple * std::sin(across) * std::cos(along);
        return {static_cast<float>(std::hypot(s, kRadius)), static_cast<float>(t),
                static_cast<float>(layer * gap + std::fabs(layer) * ripple)};
    }

    std::uint32_t rows_;
};

/// A way to do a frame.
class Way {
public:
    Way() = default;
    Way(const Way&) = delete;
    Way& operator=(const Way&) = delete;
    virtual ~Way() = default;
    [[nodiscard]] virtual const char* name() const = 0;
    virtual void fit(const Cloth& cloth) = 0;
    virtual void ask() = 0;
    /// Returns the pairs of the last ask(), without neighbours, sorted.
    [[nodiscard]] virtual Pairs pairs(const Cloth& cloth) const = 0;
};

class Ours final : public Way {
public:
    explicit Ours(const Cloth& cloth)
        : live_(make_live(cloth.now, cloth.triangles)), room_(10 * cloth.triangles.size()) {}
    [[nodiscard]] const char* name() const override {
        return "cdprep";
    }
    void fit(const Cloth& cloth) override {
        if (const auto done = live_.model.refit(cloth.now); !done) stop(done.error().message);
    }
    void ask() override {
        count_ = self_overlaps(live_.model.model(), workspace_, room_);
    }
    [[nodiscard]] Pairs pairs(const Cloth& /*cloth*/) const override {
        if (count_ > room_.size()) stop("There is too little room for the pairs.");
        return {room_.begin(), room_.begin() + static_cast<std::ptrdiff_t>(count_)};
    }

private:
    LiveObject live_;
    Workspace workspace_;
    Pairs room_;
    std::size_t count_ = 0;
};

/// Returns the pairs a < b that share no vertex, sorted, each once.
Pairs without_neighbours(const Cloth& cloth, Pairs pairs) {
    std::erase_if(pairs, [&](const TrianglePair& pair) {
        return pair.a >= pair.b || cloth.share_a_vertex(pair.a, pair.b);
    });
    std::ranges::sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    return pairs;
}

#ifdef CDPREP_HAVE_CGAL
class Cgal final : public Way {
public:
    explicit Cgal(const Cloth& cloth) : surface_(CgalSurface::of(cloth.now, cloth.triangles)) {
        if (!surface_) stop("CGAL cannot hold the sheet.");
    }
    [[nodiscard]] const char* name() const override {
        return "cgal";
    }
    void fit(const Cloth& cloth) override {
        surface_->move(cloth.now);
    }
    void ask() override {
        found_ = surface_->self_intersections();
    }
    [[nodiscard]] Pairs pairs(const Cloth& cloth) const override {
        Pairs pairs;
        for (const CgalSurface::Pair& pair : found_) pairs.push_back({pair[0], pair[1]});
        return without_neighbours(cloth, std::move(pairs));
    }

private:
    std::optional<CgalSurface> surface_;
    std::vector<CgalSurface::Pair> found_;
};
#endif

#ifdef CDPREP_HAVE_FCL
template <class Box>
class Fcl final : public Way {
public:
    Fcl(const char* name, const Cloth& cloth)
        : name_(name), model_(fcl_model<Box>(fcl_points(cloth.now), cloth.triangles)) {}
    [[nodiscard]] const char* name() const override {
        return name_;
    }
    void fit(const Cloth& cloth) override {
        fcl_refit(model_, cloth.now, points_);
    }
    void ask() override {
        result_.clear();
        const auto still = fcl::Transform3d::Identity();
        fcl::collide(&model_, still, &model_, still, fcl::CollisionRequestd(1U << 30, true),
                     result_);
    }
    [[nodiscard]] Pairs pairs(const Cloth& cloth) const override {
        Pairs pairs;
        for (std::size_t i = 0; i < result_.numContacts(); ++i) {
            const auto& contact = result_.getContact(i);
            pairs.push_back({static_cast<std::uint32_t>(std::min(contact.b1, contact.b2)),
                             static_cast<std::uint32_t>(std::max(contact.b1, contact.b2))});
        }
        return without_neighbours(cloth, std::move(pairs));
    }

private:
    const char* name_;
    fcl::BVHModel<Box> model_;
    fcl::CollisionResultd result_;
    std::vector<fcl::Vector3d> points_;
};
#endif

#ifdef CDPREP_HAVE_BULLET
/// As btGImpactCollisionAlgorithm asks two meshes.
class GImpact final : public Way {
public:
    explicit GImpact(const Cloth& cloth) : cloth_(cloth), mesh_(cloth.now, cloth.triangles) {}
    [[nodiscard]] const char* name() const override {
        return "bullet_gimpact";
    }
    void fit(const Cloth& cloth) override {
        mesh_.refit(cloth.now);
    }
    void ask() override {
        found_.clear();
        const btGImpactMeshShapePart& part = mesh_.part();
        btPairSet candidates;
        const btTransform still = btTransform::getIdentity();
        btGImpactBoxSet::find_collision(part.getBoxSet(), still, part.getBoxSet(), still,
                                        candidates);
        part.lockChildShapes();
        for (int i = 0; i < candidates.size(); ++i) test(part, candidates[i]);
        part.unlockChildShapes();
    }
    [[nodiscard]] Pairs pairs(const Cloth& cloth) const override {
        return without_neighbours(cloth, found_);
    }

private:
    void test(const btGImpactMeshShapePart& part, const GIM_PAIR& pair) {
        const TrianglePair numbers = {static_cast<std::uint32_t>(pair.m_index1),
                                      static_cast<std::uint32_t>(pair.m_index2)};
        if (numbers.a >= numbers.b || cloth_.share_a_vertex(numbers.a, numbers.b)) return;
        btPrimitiveTriangle a;
        btPrimitiveTriangle b;
        part.getPrimitiveTriangle(pair.m_index1, a);
        part.getPrimitiveTriangle(pair.m_index2, b);
        a.buildTriPlane();
        b.buildTriPlane();
        GIM_TRIANGLE_CONTACT contact;
        if (a.overlap_test_conservative(b) && a.find_triangle_collision_clip_method(b, contact)) {
            found_.push_back(numbers);
        }
    }

    const Cloth& cloth_;
    GImpactMesh mesh_;
    Pairs found_;
};
#endif

std::vector<std::unique_ptr<Way>> all_ways(const Cloth& cloth) {
    std::vector<std::unique_ptr<Way>> ways;
    ways.push_back(std::make_unique<Ours>(cloth));
#ifdef CDPREP_HAVE_CGAL
    ways.push_back(std::make_unique<Cgal>(cloth));
#endif
#ifdef CDPREP_HAVE_FCL
    ways.push_back(std::make_unique<Fcl<fcl::AABBd>>("fcl_aabb", cloth));
    ways.push_back(std::make_unique<Fcl<fcl::OBBRSSd>>("fcl_obbrss", cloth));
#endif
#ifdef CDPREP_HAVE_BULLET
    ways.push_back(std::make_unique<GImpact>(cloth));
#endif
    return ways;
}

/// Returns the share of triangles that are in a pair.
double share_in_contact(const Pairs& pairs, std::size_t triangles) {
    std::set<std::uint32_t> in_contact;
    for (const TrianglePair& pair : pairs) {
        in_contact.insert(pair.a);
        in_contact.insert(pair.b);
    }
    return static_cast<double>(in_contact.size()) / static_cast<double>(triangles);
}

/// Moves the layers so far apart that 1 % of the triangles are in contact.
void choose_gap(Cloth& cloth) {
    Ours ours(cloth);
    double near = 0, far = 0.02;
    for (int step = 0; step < 20; ++step) {
        cloth.gap = (near + far) / 2;
        cloth.set(0);
        ours.fit(cloth);
        ours.ask();
        const bool is_many = share_in_contact(ours.pairs(cloth), cloth.triangles.size()) > 0.01;
        (is_many ? near : far) = cloth.gap;
    }
}

int run(int frames, std::uint32_t rows) {
    Cloth cloth(rows);
    choose_gap(cloth);
    const auto ways = all_ways(cloth);
    std::vector<std::vector<double>> fit(ways.size()), ask(ways.size()), whole(ways.size());
    std::vector<int> same(ways.size());
    std::vector<std::vector<double>> counts(ways.size());
    std::vector<double> share;
    bool is_exact = true;
    for (int frame = 0; frame < frames; ++frame) {
        cloth.set(frame);
        Pairs ours;
        for (std::size_t i = 0; i < ways.size(); ++i) {
            const double begun = thread_us();
            ways[i]->fit(cloth);
            const double fitted = thread_us();
            ways[i]->ask();
            const double answered = thread_us();
            fit[i].push_back((fitted - begun) * 1e-3);
            ask[i].push_back((answered - fitted) * 1e-3);
            whole[i].push_back((answered - begun) * 1e-3);
            const Pairs pairs = ways[i]->pairs(cloth);
            counts[i].push_back(static_cast<double>(pairs.size()));
            if (i == 0) ours = pairs;
            same[i] += pairs == ours ? 1 : 0;
            if (std::string(ways[i]->name()) == "cgal") is_exact = is_exact && pairs == ours;
        }
        share.push_back(share_in_contact(ours, cloth.triangles.size()));
    }
    std::printf("way,triangles,in_contact,pairs,fit_ms,ask_ms,frame_ms,times,same\n");
    for (std::size_t i = 0; i < ways.size(); ++i) {
        std::printf("%s,%zu,%.4f,%.0f,%.2f,%.2f,%.2f,%.1f,%d/%d\n", ways[i]->name(),
                    cloth.triangles.size(), median(share), median(counts[i]), median(fit[i]),
                    median(ask[i]), median(whole[i]), median(whole[i]) / median(whole[0]), same[i],
                    frames);
    }
    return is_exact ? 0 : 1;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const int frames = count > 1 ? std::max(1, std::atoi(arguments[1])) : 20;
    const int rows = count > 2 ? std::max(2, std::atoi(arguments[2])) : 224;
    return cdprep::run(frames, static_cast<std::uint32_t>(rows));
}
