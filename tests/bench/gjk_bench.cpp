// SPDX-License-Identifier: MIT
// Two convex hulls that move little from question to question, asked beside libccd and
// Bullet where those are installed. B walks: each step moves it by 1/1000 of the diagonal
// and turns it by 0.2 degrees about its middle, in one direction a walk. All contenders
// are asked the same questions in turns; a cache, or the last point of a climb, lives as
// long as a walk. The first step of a walk is timed as well. One thread.
//
// Usage: gjk_bench [ROUNDS [BAKE...]]
//
// Hulls are 1,000 random points of an ellipsoid each, and 24; of every baked model that is named,
// the hull of its vertices, against itself. Situations: `near` begins 1 % of the diagonal
// apart, `far` half of it, `deep` with a tenth of the diagonal in common.
//
// Contenders: ours with a cache, without, and without neighbours (a scan); the nearest features,
// which march from the last ones, and without a cache; libccd's
// ccdGJKIntersect for the flag and, where FCL is installed, its distance on libccd;
// Bullet's btGjkPairDetector in float, as Debian builds it by default. Each of those with
// its scan of all points, and climbing along our neighbours from where it was last.
//
// Prints a CSV table: nanoseconds a question, the median of the rounds, and the spread of
// their middle half; `times` is it by ours with a cache. `wrong` counts answers of the
// wrong sign (flag; or a distance of 0 though apart), `worst` the largest error of a
// distance, in diagonals.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/closest_features.h"
#include "cdprep/advanced/convex_distance.h"
#include "support/small_hull.h"

#ifdef CDPREP_HAVE_CCD
#include <ccd/ccd.h>
#endif
#ifdef CDPREP_HAVE_FCL
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk_libccd.h>
#endif
#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "bullet_transform.h"
#endif

namespace cdprep {
namespace {

constexpr double kStep = 0.001;  ///< of the diagonal
constexpr double kTurn = 0.2 * std::numbers::pi / 180;
constexpr std::size_t kSteps = 20;  ///< of a walk
constexpr std::size_t kWalks = 50;

using Walk = std::vector<Pose>;
using test::SmallHull;

/// The triangles of a hull as closest_features() wants them, each a face of its own.
struct Surface {
    std::vector<format::PieceFacet> facets;
    std::vector<format::PieceAdjacency> adjacency;

    explicit Surface(const SmallHull& hull) {
        std::map<std::array<std::uint32_t, 2>, std::uint32_t> left_of;
        for (const auto& c : hull.triangles()) {
            const auto facet = static_cast<std::uint32_t>(facets.size());
            for (std::size_t k = 0; k < 3; ++k) left_of[{c[k], c[(k + 1) % 3]}] = facet;
            facets.push_back({c, format::facet_first_of_face});
        }
        for (const auto& c : hull.triangles()) {
            adjacency.push_back(
                {{left_of.at({c[1], c[0]}), left_of.at({c[2], c[1]}), left_of.at({c[0], c[2]})}});
        }
    }
};

/// Two hulls and where B goes.
struct Scene {
    std::string name;
    const SmallHull* a;
    const SmallHull* b;
    double diagonal;
    std::vector<Walk> walks;
    Surface surface_a, surface_b;
};

/// What a contender answered: distances, or 0 and 1 for the flag.
using Answers = std::vector<double>;

/// Asks all questions of a scene and appends the answers.
struct Contender {
    std::string name;
    std::function<void(const Scene&, Answers&)> ask;
};

Double3 random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Double3 v = {normal(random), normal(random), normal(random)};
    const double length = std::hypot(v.x, v.y, v.z);
    return {v.x / length, v.y / length, v.z / length};
}

double dot(const Double3& a, const Double3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A direction turned back to the frame of the points.
Double3 turned_back(const Pose& pose, const Double3& d) {
    const auto& r = pose.rotation();
    return {r[0] * d.x + r[3] * d.y + r[6] * d.z, r[1] * d.x + r[4] * d.y + r[7] * d.z,
            r[2] * d.x + r[5] * d.y + r[8] * d.z};
}

std::uint32_t scan(const ConvexPoints& hull, const Double3& d) {
    std::array<double, 8> best;
    std::array<double, 8> block{};
    best.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < hull.blocks.size(); ++k) {
        const auto& at = hull.blocks[k].at;
        for (std::size_t i = 0; i < 8; ++i) {
            const double value = d.x * at[0][i] + d.y * at[1][i] + d.z * at[2][i];
            block[i] = value > best[i] ? static_cast<double>(k) : block[i];
            best[i] = value > best[i] ? value : best[i];
        }
    }
    const auto lane =
        static_cast<std::size_t>(std::max_element(best.begin(), best.end()) - best.begin());
    return std::min(static_cast<std::uint32_t>(block[lane]) * 8 + static_cast<std::uint32_t>(lane),
                    hull.count - 1);
}

std::uint32_t climb(const ConvexPoints& hull, const Double3& d, std::uint32_t from) {
    double height = dot(d, hull.point(from));
    for (std::uint32_t last = hull.count; last != from;) {
        last = from;
        for (std::uint32_t i = hull.neighbour_begins[last]; i < hull.neighbour_begins[last + 1];
             ++i) {
            const double other = dot(d, hull.point(hull.neighbours[i]));
            if (!(other > height)) continue;
            height = other;
            from = hull.neighbours[i];
        }
    }
    return from;
}

enum class Support : std::uint8_t { scan, climb };
enum class Asked : std::uint8_t { flag, distance };

/// A hull as a callback wants it.
struct Placed {
    ConvexPoints hull;
    Pose pose;
    Support support;
    std::uint32_t near = 0;

    Double3 farthest(const Double3& direction) {
        const Double3 local = turned_back(pose, direction);
        near = support == Support::climb ? climb(hull, local, near) : scan(hull, local);
        return transform_point(pose, hull.point(near));
    }
};

/// Calls ask(pose, cache) along every walk.
template <class Cache, class Ask>
void along_walks(const Scene& scene, Answers& answers, Ask&& ask) {
    for (const Walk& walk : scene.walks) {
        Cache cache{};
        for (const Pose& pose : walk) answers.push_back(ask(pose, cache));
    }
}

Contender ours(const std::string& name, Asked asked, bool cached, bool climbs) {
    return {name, [=](const Scene& scene, Answers& answers) {
                ConvexPoints a = scene.a->view(), b = scene.b->view();
                if (!climbs) a.neighbour_begins = b.neighbour_begins = {};
                along_walks<ConvexCache>(
                    scene, answers, [&](const Pose& pose, ConvexCache& cache) -> double {
                        const Placement placement = Placement::b_moves(pose);
                        ConvexCache* used = cached ? &cache : nullptr;
                        if (asked == Asked::flag) return convex_collide(a, b, placement, used);
                        return convex_distance(a, b, placement, {}, used)->upper;
                    });
            }};
}

/// From the features where the last question ended, or cold: then GJK, and its features.
Contender features(const std::string& name, bool cached) {
    return {name, [=](const Scene& scene, Answers& answers) {
                const FeatureHull a = {scene.a->view(), scene.surface_a.facets,
                                       scene.surface_a.adjacency};
                const FeatureHull b = {scene.b->view(), scene.surface_b.facets,
                                       scene.surface_b.adjacency};
                along_walks<FeatureCache>(
                    scene, answers, [&](const Pose& pose, FeatureCache& cache) -> double {
                        const auto found = closest_features(a, b, Placement::b_moves(pose),
                                                            cached ? &cache : nullptr);
                        return found ? found->upper : 0;
                    });
            }};
}

#ifdef CDPREP_HAVE_CCD
void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
    auto& placed = *static_cast<Placed*>(const_cast<void*>(object));
    const Double3 p = placed.farthest({direction->v[0], direction->v[1], direction->v[2]});
    ccdVec3Set(point, p.x, p.y, p.z);
}

struct CcdPair {
    Placed a, b;
};

Contender ccd(const std::string& name, Asked asked, Support support) {
    return {name, [=](const Scene& scene, Answers& answers) {
                ccd_t settings;
                CCD_INIT(&settings);
                settings.support1 = settings.support2 = ccd_support;
                settings.max_iterations = 500;
                for (const Walk& walk : scene.walks) {
                    CcdPair pair = {{scene.a->view(), {}, support}, {scene.b->view(), {}, support}};
                    for (const Pose& pose : walk) {
                        pair.b.pose = pose;
                        if (asked == Asked::flag) {
                            answers.push_back(ccdGJKIntersect(&pair.a, &pair.b, &settings));
                            continue;
                        }
#ifdef CDPREP_HAVE_FCL
                        double distance = 0;
                        constexpr double kTolerance = 1e-6;  // FCL's own default
                        fcl::detail::GJKDistance<double>(&pair.a, ccd_support, &pair.b, ccd_support,
                                                         500, kTolerance, &distance, nullptr,
                                                         nullptr);
                        answers.push_back(std::max(0.0, distance));
#endif
                    }
                }
            }};
}
#endif

#ifdef CDPREP_HAVE_BULLET
/// Bullet's hull with the climb in place of its scan.
class ClimbingHull : public btConvexInternalShape {
public:
    explicit ClimbingHull(const ConvexPoints& hull) : hull_(hull) {
        m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
        for (std::uint32_t i = 0; i < hull.count; ++i) {
            points_.push_back(bullet_vector(hull.point(i)));
        }
    }
    btVector3 localGetSupportingVertexWithoutMargin(const btVector3& d) const override {
        btScalar height = d.dot(points_[near_]);
        for (std::uint32_t last = hull_.count; last != near_;) {
            last = near_;
            for (std::uint32_t i = hull_.neighbour_begins[last];
                 i < hull_.neighbour_begins[last + 1]; ++i) {
                const btScalar other = d.dot(points_[hull_.neighbours[i]]);
                if (!(other > height)) continue;
                height = other;
                near_ = hull_.neighbours[i];
            }
        }
        return points_[near_];
    }
    btVector3 localGetSupportingVertex(const btVector3& d) const override {
        return localGetSupportingVertexWithoutMargin(d);
    }
    void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3*, btVector3*,
                                                           int) const override {}
    void calculateLocalInertia(btScalar, btVector3&) const override {}
    void getAabb(const btTransform&, btVector3&, btVector3&) const override {}
    int getNumPreferredPenetrationDirections() const override {
        return 0;
    }
    void getPreferredPenetrationDirection(int, btVector3&) const override {}
    const char* getName() const override {
        return "climbing";
    }

private:
    ConvexPoints hull_;
    std::vector<btVector3> points_;
    mutable std::uint32_t near_ = 0;
};

void ask_bullet(const Scene& scene, Answers& answers, btConvexShape& a, btConvexShape& b,
                Asked asked) {
    a.setMargin(0);
    b.setMargin(0);
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector detector(&a, &b, &simplex, nullptr);
    for (const Walk& walk : scene.walks) {
        for (const Pose& pose : walk) {
            btGjkPairDetector::ClosestPointInput input;
            input.m_transformA.setIdentity();
            input.m_transformB = bullet_transform(pose);
            btPointCollector found;
            detector.getClosestPoints(input, found, nullptr);
            const bool apart = found.m_hasResult && found.m_distance > 0;
            const double distance = apart ? static_cast<double>(found.m_distance) : 0;
            answers.push_back(asked == Asked::flag ? (apart ? 0 : 1) : distance);
        }
    }
}

Contender bullet(const std::string& name, Asked asked, Support support) {
    return {name, [=](const Scene& scene, Answers& answers) {
                const auto shape = [](const SmallHull& hull) {
                    btConvexHullShape result;
                    for (const Double3& p : hull.points()) {
                        result.addPoint(bullet_vector(p), false);
                    }
                    result.recalcLocalAabb();
                    return result;
                };
                if (support == Support::climb) {
                    ClimbingHull a(scene.a->view()), b(scene.b->view());
                    return ask_bullet(scene, answers, a, b, asked);
                }
                btConvexHullShape a = shape(*scene.a), b = shape(*scene.b);
                ask_bullet(scene, answers, a, b, asked);
            }};
}
#endif

std::vector<Contender> contenders(Asked asked) {
    std::vector<Contender> all = {ours("ours", asked, true, true),
                                  ours("ours_uncached", asked, false, true),
                                  ours("ours_scan", asked, true, false)};
    if (asked == Asked::distance) {
        all.push_back(features("features", true));
        all.push_back(features("features_uncached", false));
    }
#ifdef CDPREP_HAVE_CCD
    bool asks_ccd = asked == Asked::flag;
#ifdef CDPREP_HAVE_FCL
    asks_ccd = true;
#endif
    if (asks_ccd) {
        all.push_back(ccd("libccd_scan", asked, Support::scan));
        all.push_back(ccd("libccd_climb", asked, Support::climb));
    }
#endif
#ifdef CDPREP_HAVE_BULLET
    all.push_back(bullet("bullet_scan", asked, Support::scan));
    all.push_back(bullet("bullet_climb", asked, Support::climb));
#endif
    return all;
}

std::vector<Double3> ellipsoid(std::size_t count, std::mt19937& random) {
    std::vector<Double3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Double3 d = random_direction(random);
        points.push_back({d.x, 0.8 * d.y, 0.6 * d.z});
    }
    return points;
}

std::vector<Double3> points_of(const std::filesystem::path& path) {
    const Model model = open_or_stop(path);
    std::vector<Double3> points(model.mesh().positions_f64.begin(),
                                model.mesh().positions_f64.end());
    for (const format::Float3& p : model.mesh().positions_f32) points.push_back({p.x, p.y, p.z});
    std::mt19937 random(3);
    std::shuffle(points.begin(), points.end(), random);  // grows fast, so that most lie inside
    return points;
}

double diagonal_of(const SmallHull& hull) {
    Double3 lower = hull.points()[0], upper = lower;
    for (const Double3& p : hull.points()) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    return std::hypot(upper.x - lower.x, upper.y - lower.y, upper.z - lower.z);
}

Pose turned(const Pose& from, const Double3& axis, double angle, const Double3& translation) {
    const double s = std::sin(angle / 2);
    const Pose turn =
        Pose::from_quaternion(std::cos(angle / 2), s * axis.x, s * axis.y, s * axis.z, {}).value();
    const auto& t = turn.rotation();
    const auto& r = from.rotation();
    std::array<double, 12> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) rows[3 * i + j] += t[3 * i + k] * r[3 * k + j];
        }
    }
    rows[9] = translation.x;
    rows[10] = translation.y;
    rows[11] = translation.z;
    return Pose::from_rows(rows).value();
}

/// Begins `gap` apart along a random direction, or as deep where that is negative.
Walk walk_from(const SmallHull& a, const SmallHull& b, double gap, double diagonal,
               std::mt19937& random) {
    const Double3 way = random_direction(random);
    Pose pose = turned({}, random_direction(random), 3 * std::numbers::pi / 4, {});
    const ConvexPoints hull_a = a.view(), hull_b = b.view();
    const Double3 top = hull_a.point(scan(hull_a, way));
    const Double3 back = {-way.x, -way.y, -way.z};
    const Double3 low = transform_point(pose, hull_b.point(scan(hull_b, turned_back(pose, back))));
    // Apart along `way` by the gap at most: so the distance is about that.
    const double shift = dot(way, top) - dot(way, low) + gap;
    Double3 at = {shift * way.x, shift * way.y, shift * way.z};
    const Double3 step = random_direction(random);
    const Double3 axis = random_direction(random);
    Walk walk;
    for (std::size_t i = 0; i < kSteps; ++i) {
        pose = turned(pose, axis, kTurn, at);
        walk.push_back(pose);
        const double length = kStep * diagonal;
        at = {at.x + length * step.x, at.y + length * step.y, at.z + length * step.z};
    }
    return walk;
}

double median_of(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Against ours: the distance is proved, and so is the flag.
struct Faults {
    std::size_t wrong = 0;
    double worst = 0;
};

Faults faults_of(const Answers& answers, const Answers& truth, Asked asked, double diagonal) {
    Faults faults;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if ((answers[i] > 0) != (truth[i] > 0)) ++faults.wrong;
        if (asked == Asked::flag) continue;
        faults.worst = std::max(faults.worst, std::fabs(answers[i] - truth[i]) / diagonal);
    }
    return faults;
}

void measure(const Scene& scene, Asked asked, std::size_t rounds) {
    const std::vector<Contender> all = contenders(asked);
    std::vector<std::vector<double>> times(all.size());
    std::vector<Answers> answers(all.size());
    for (std::size_t round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            answers[i].clear();
            answers[i].reserve(kSteps * kWalks);
            const auto begin = std::chrono::steady_clock::now();
            all[i].ask(scene, answers[i]);
            const std::chrono::duration<double, std::nano> took =
                std::chrono::steady_clock::now() - begin;
            times[i].push_back(took.count() / static_cast<double>(answers[i].size()));
        }
    }
    const double ours = median_of(times[0], 0.5);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Faults faults = faults_of(answers[i], answers[0], asked, scene.diagonal);
        const double median = median_of(times[i], 0.5);
        const auto touching = std::count_if(answers[0].begin(), answers[0].end(), [&](double x) {
            return (x > 0) == (asked == Asked::flag);
        });
        std::printf("%s,%zu,%s,%s,%zu,%td,%.0f,%.0f,%.2f,%zu,%.1e\n", scene.name.c_str(),
                    scene.a->points().size(), asked == Asked::flag ? "collide" : "distance",
                    all[i].name.c_str(), answers[i].size(), touching, median,
                    median_of(times[i], 0.75) - median_of(times[i], 0.25), median / ours,
                    faults.wrong, faults.worst);
    }
    std::fflush(stdout);
}

void measure_all(const std::string& name, const SmallHull& a, const SmallHull& b,
                 std::size_t rounds) {
    const double diagonal = diagonal_of(b);
    std::mt19937 random(11);
    const std::array<std::pair<const char*, double>, 3> situations = {
        {{"near", 0.01}, {"far", 0.5}, {"deep", -0.1}}};
    for (const auto& [situation, gap] : situations) {
        Scene scene = {name + "/" + situation, &a, &b, diagonal, {}, Surface(a), Surface(b)};
        for (std::size_t i = 0; i < kWalks; ++i) {
            scene.walks.push_back(walk_from(a, b, gap * diagonal, diagonal, random));
        }
        measure(scene, Asked::flag, rounds);
        if (gap > 0) measure(scene, Asked::distance, rounds);
    }
}

}  // namespace
}  // namespace cdprep

int main(int argc, char** argv) {
    using namespace cdprep;
    const std::size_t rounds = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 9;
    std::printf(
        "hulls,corners,question,contender,questions,touching,median_ns,spread_ns,times,wrong,"
        "worst\n");
    std::mt19937 random(5);
    const test::SmallHull a(ellipsoid(1000, random)), b(ellipsoid(1000, random));
    measure_all("ellipsoids", a, b, rounds);
    const test::SmallHull small_a(ellipsoid(24, random)), small_b(ellipsoid(24, random));
    measure_all("small", small_a, small_b, rounds);
    for (int i = 2; i < argc; ++i) {
        const std::filesystem::path path = argv[i];
        const test::SmallHull hull(points_of(path));
        measure_all(path.stem().stem().string(), hull, hull, rounds);
    }
}
