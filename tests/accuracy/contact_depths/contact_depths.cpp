// SPDX-License-Identifier: MIT
// How deep contacts() says that bodies overlap, beside the truth.
//
// Models rest on a large box or on each other, sunk in by a known share of their size. For each
// contact of two overlapping pieces, the truth is the shortest way out that brute force finds: over
// the normals of all triangles of both pieces, the products of all their edges, and 2,000 spread
// directions, those along which the corner of the piece that is farthest is the highest of its
// neighbourhood in the whole mesh, on either side. A contact without any such direction has no
// truth; those are counted.
//
// Prints a histogram of depth by truth, and what lies beyond 2. Fails where a promise of contacts.h
// breaks: a depth of more than twice the truth, an interval that does not hold the pieces' own
// depth, a normal that is no unit vector.
//
// Usage: contact_depths [POSES]: a sixteenth of 1,000 by default, all with CDPREP_ALL_POSES=yes.
// The models are those beside the checkout, or in CDPREP_SHARED.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "import/import_file.h"
#include "mesh/normalize.h"
#include "mesh/weld.h"
#include "study/memory_model.h"
#include "support/rounds.h"
#include "support/shared_models.h"

namespace cdprep {
namespace {

constexpr double kMostRatio = 2;
constexpr double kLevel = 1e-9;  ///< of a piece's extent: corners of equal height

Double3 operator-(const Double3& a, const Double3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Double3 operator*(double s, const Double3& a) {
    return {s * a.x, s * a.y, s * a.z};
}
double dot(const Double3& a, const Double3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Double3 cross(const Double3& a, const Double3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
bool make_unit(Double3& d) {
    const double length = std::sqrt(dot(d, d));
    if (!(length > 0)) return false;
    d = 1 / length * d;
    return true;
}

double length(const Double3& d) {
    return std::sqrt(dot(d, d));
}

/// The lowest and the highest coordinates of a mesh.
std::pair<Double3, Double3> corners_of(const mesh::Mesh& mesh) {
    Double3 lower = mesh.positions[0], upper = lower;
    for (const Double3& p : mesh.positions) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    return {lower, upper};
}

/// A model with what the oracle reads: for each vertex its neighbours.
struct Body {
    std::string name;
    study::MemoryModel baked;
    std::vector<std::vector<std::uint32_t>> triangles_at;  ///< by vertex
    double size;                                           ///< diagonal

    Body(std::string called, const mesh::Mesh& mesh)
        : name(std::move(called)),
          baked(study::make_memory_model(mesh, {.pieces = true}).value()),
          triangles_at(baked.ordered.positions.size()) {
        const auto [lower, upper] = corners_of(mesh);
        size = length(upper - lower);
        for (std::uint32_t t = 0; t < baked.ordered.triangles.size(); ++t) {
            for (const std::uint32_t v : baked.ordered.triangles[t].vertex) {
                triangles_at[v].push_back(t);
            }
        }
    }
    [[nodiscard]] const Model& model() const {
        return baked.model;
    }
};

/// A piece of a body as moved.
class Side {
public:
    Side(const Body& body, const Pose* pose, std::uint32_t piece) : body_(body), pose_(pose) {
        const auto& pieces = body.model().pieces();
        const std::size_t end = piece + 1 < pieces.pieces.size()
                                    ? pieces.pieces[piece + 1].first_triangle
                                    : pieces.triangles.size();
        for (std::size_t i = pieces.pieces[piece].first_triangle; i < end; ++i) {
            const auto& vertex = mesh().triangles[pieces.triangles[i]].vertex;
            triangles_.push_back(pieces.triangles[i]);
            vertices_.insert(vertices_.end(), vertex.begin(), vertex.end());
        }
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        for (const std::uint32_t v : vertices_) points_.push_back(at(v));
    }

    [[nodiscard]] double highest(const Double3& d) const {
        double most = -std::numeric_limits<double>::infinity();
        for (const Double3& p : points_) most = std::max(most, dot(d, p));
        return most;
    }
    /// Whether the mesh around the highest corners of the piece goes no higher, and faces up there.
    [[nodiscard]] bool ends_along(const Double3& d) const {
        const double most = highest(d), level = kLevel * (most + highest(-1 * d));
        bool faces = false;
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            if (dot(d, points_[i]) < most - level) continue;
            for (const std::uint32_t t : body_.triangles_at[vertices_[i]]) {
                for (const std::uint32_t near : mesh().triangles[t].vertex) {
                    if (dot(d, at(near)) > most + level) return false;
                }
                faces = faces || dot(d, normal(t)) > 0;
            }
        }
        return faces;
    }
    void add_normals(double sign, std::vector<Double3>& directions) const {
        for (const std::uint32_t t : triangles_) directions.push_back(sign * normal(t));
    }
    [[nodiscard]] std::vector<Double3> edges() const {
        std::vector<Double3> all;
        for (const std::uint32_t t : triangles_) {
            const auto& v = mesh().triangles[t].vertex;
            for (std::size_t k = 0; k < 3; ++k) all.push_back(at(v[(k + 1) % 3]) - at(v[k]));
        }
        return all;
    }

private:
    [[nodiscard]] const mesh::Mesh& mesh() const {
        return body_.baked.ordered;
    }
    [[nodiscard]] Double3 at(std::uint32_t vertex) const {
        const Double3& p = mesh().positions[vertex];
        return pose_ == nullptr ? p : transform_point(*pose_, p);
    }
    [[nodiscard]] Double3 normal(std::uint32_t triangle) const {
        const auto& v = mesh().triangles[triangle].vertex;
        return cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0]));
    }

    const Body& body_;
    const Pose* pose_;
    std::vector<std::uint32_t> triangles_;
    std::vector<std::uint32_t> vertices_;
    std::vector<Double3> points_;  ///< of vertices_, as moved
};

/// Unit vectors, evenly spread: a spiral by the golden angle.
std::vector<Double3> spread_directions(int count) {
    std::vector<Double3> all;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, around = i * 2.399963229728653;
        const double r = std::sqrt(1 - z * z);
        all.push_back({r * std::cos(around), r * std::sin(around), z});
    }
    return all;
}

struct Truth {
    double shortest = std::numeric_limits<double>::infinity();  ///< of any direction
    double local = std::numeric_limits<double>::infinity();     ///< that ends at both surfaces
};

Truth truth_of(const Side& a, const Side& b) {
    constexpr std::size_t kMostEdges = 60;  // of each; larger pieces go without products
    static const std::vector<Double3> kSpread = spread_directions(2000);
    std::vector<Double3> directions = kSpread;
    a.add_normals(1, directions);
    b.add_normals(-1, directions);
    const std::vector<Double3> of_a = a.edges(), of_b = b.edges();
    if (of_a.size() <= kMostEdges && of_b.size() <= kMostEdges) {
        for (const Double3& p : of_a) {
            for (const Double3& q : of_b) {
                directions.push_back(cross(p, q));
                directions.push_back(-1 * directions.back());
            }
        }
    }
    Truth truth;
    for (Double3 d : directions) {
        if (!make_unit(d)) continue;
        const double way = a.highest(d) + b.highest(-1 * d);
        truth.shortest = std::min(truth.shortest, way);
        if (way < truth.local && a.ends_along(d) && b.ends_along(-1 * d)) truth.local = way;
    }
    return truth;
}

class Histogram {
public:
    void add(double ratio) {
        std::size_t i = 0;
        while (i < kBorders.size() && ratio > kBorders[i]) ++i;
        ++count_[i];
        ++all_;
        most_ = std::max(most_, ratio);
    }
    void print(const char* title) const {
        std::printf("%s: %zu, at most %.4g times the truth\n", title, all_, most_);
        for (std::size_t i = 0; i < count_.size(); ++i) {
            const std::string border =
                i < kBorders.size() ? "<= " + number(kBorders[i]) : "> " + number(kBorders.back());
            std::printf("  %-10s %8zu  %5.1f %%\n", border.c_str(), count_[i],
                        100.0 * static_cast<double>(count_[i]) / static_cast<double>(all_));
        }
    }
    [[nodiscard]] std::size_t beyond() const {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < count_.size(); ++i) {
            if (i >= kBorders.size() || kBorders[i] > kMostRatio) sum += count_[i];
        }
        return sum;
    }

private:
    static constexpr std::array kBorders = {1.000001, 1.1, 1.25, 1.5, kMostRatio, 4.0, 16.0, 256.0};
    static std::string number(double x) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%g", x);
        return text.data();
    }
    std::array<std::size_t, kBorders.size() + 1> count_{};
    std::size_t all_ = 0;
    double most_ = 0;
};

struct Totals {
    Histogram shallow;
    double deepest = 0;  ///< of those without truth, of the size of B
    std::size_t poses = 0, apart = 0, behind = 0, without_truth = 0, wrong = 0;
};

void check(const Body& a, const Body& b, const Pose& pose, Workspace& workspace, Totals& totals) {
    const auto visit = [&](const Contact& contact) {
        if ((contact.flags & contact_from_behind) != 0) return ++totals.behind > 0;
        if ((contact.flags & contact_overlap) == 0) return ++totals.apart > 0;
        const Truth truth =
            truth_of(Side(a, nullptr, contact.piece_a), Side(b, &pose, contact.piece_b));
        const double rounding = 1e-12 * (a.size + b.size);
        const bool is_wrong = -contact.upper > truth.shortest + rounding ||
                              std::fabs(dot(contact.normal, contact.normal) - 1) > 1e-9 ||
                              contact.lower > contact.upper;
        if (is_wrong) {
            ++totals.wrong;
            std::printf("WRONG %s-%s pieces %u %u: %.17g to %.17g, shortest %.17g\n",
                        a.name.c_str(), b.name.c_str(), contact.piece_a, contact.piece_b,
                        contact.lower, contact.upper, truth.shortest);
        }
        if (truth.local == std::numeric_limits<double>::infinity()) {
            ++totals.without_truth;
            totals.deepest = std::max(totals.deepest, -contact.lower / b.size);
            return true;
        }
        const double ratio = (-contact.lower + rounding) / (std::max(0.0, truth.local) + rounding);
        totals.shallow.add(ratio);
        if (ratio > kMostRatio && std::getenv("CDPREP_DEPTHS_VERBOSE") != nullptr) {
            std::printf("beyond %s-%s pieces %u %u: lower %.6g upper %.6g truth %.6g flags %u\n",
                        a.name.c_str(), b.name.c_str(), contact.piece_a, contact.piece_b,
                        contact.lower, contact.upper, truth.local, contact.flags);
        }
        return true;
    };
    ++totals.poses;
    visit_contacts({a.model(), b.model(), Placement::b_moves(pose)}, workspace, visit,
                   {.tolerance = 0.001 * b.size, .manifold = Manifold::four});
}

Pose random_turn(std::mt19937& random) {
    std::normal_distribution<double> number;
    const std::array<double, 4> q = {number(random), number(random), number(random),
                                     number(random)};
    return Pose::from_quaternion(q[0], q[1], q[2], q[3], {}).value();
}
Pose turned_to(const Pose& turn, const Double3& at) {
    const auto& r = turn.rotation();
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], at.x, at.y, at.z})
        .value();
}

/// On the top of a box around the origin, sunk in by `depth`.
Pose on_box(const Body& body, std::mt19937& random, double depth) {
    const Pose turn = random_turn(random);
    double lowest = std::numeric_limits<double>::infinity();
    for (const Double3& p : body.baked.ordered.positions) {
        lowest = std::min(lowest, transform_point(turn, p).z);
    }
    return turned_to(turn, {0.1 * body.size, 0.07 * body.size, -lowest - depth});
}

/// Beside A in a random direction, sunk in by about `depth`: B comes nearer until they touch.
Pose on_body(const Body& a, const Body& b, std::mt19937& random, double depth,
             Workspace& workspace) {
    const Pose turn = random_turn(random);
    const Pose way = random_turn(random);
    const Double3 d = transform_point(way, {0, 0, 1});
    double away = a.size + b.size;
    for (int step = 0; step < 200; ++step) {
        const Pose pose = turned_to(turn, away * d);
        const double gap = distance({a.model(), b.model(), Placement::b_moves(pose)}, workspace,
                                    {.relative_error = 0.01})
                               ->lower;
        away -= gap;
        if (gap < 1e-9 * a.size) break;
    }
    return turned_to(turn, (away - depth) * d);
}

mesh::Mesh box(double size) {
    mesh::Mesh mesh;
    const double w = 20 * size, h = size;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back(
            {(i & 1) != 0 ? w : -w, (i & 2) != 0 ? w : -w, (i & 4) != 0 ? 0 : -h});
        mesh.source_vertex.push_back(static_cast<std::uint32_t>(i));
    }
    for (const auto& t : {std::array{0U, 2U, 1U},
                          {1U, 2U, 3U},
                          {4U, 5U, 6U},
                          {5U, 7U, 6U},
                          {0U, 1U, 4U},
                          {1U, 5U, 4U},
                          {2U, 6U, 3U},
                          {3U, 6U, 7U},
                          {0U, 4U, 2U},
                          {2U, 4U, 6U},
                          {1U, 3U, 5U},
                          {3U, 7U, 5U}}) {
        mesh.triangles.push_back({t});
    }
    return mesh;
}

/// A model as bake --normalize has it.
Body load(const std::filesystem::path& folder, const std::string& name) {
    auto soup = import::import_file(folder / (name + ".ply"));
    if (!soup) {
        std::fprintf(stderr, "contact_depths: %s\n", soup.error().message.c_str());
        std::exit(3);
    }
    mesh::normalize(soup.value());
    return {name, mesh::weld(soup.value()).mesh};
}

int run(const std::filesystem::path& folder, int poses) {
    constexpr std::array kDepths = {0.0, 1e-4, 1e-3, 5e-3};  // of the size of B
    std::vector<Body> bodies;
    for (const char* name : {"horse", "skull", "bunny"}) bodies.push_back(load(folder, name));
    std::mt19937 random(20261124);
    Workspace workspace;
    Totals on_boxes, on_bodies;
    for (int i = 0; i < poses; ++i) {
        const Body& b = bodies[static_cast<std::size_t>(i) % bodies.size()];
        const double depth = kDepths[static_cast<std::size_t>(i / 3) % kDepths.size()] * b.size;
        const Body floor("box", box(b.size));
        check(floor, b, on_box(b, random, depth), workspace, on_boxes);
        const Body& a = bodies[static_cast<std::size_t>(i / 5) % bodies.size()];
        check(a, b, on_body(a, b, random, depth, workspace), workspace, on_bodies);
    }
    bool fails = false;
    for (const auto& [title, totals] :
         {std::pair{"on a box", &on_boxes}, std::pair{"on each other", &on_bodies}}) {
        totals->shallow.print(title);
        std::printf(
            "  poses %zu, contacts apart %zu, from behind %zu, without truth %zu (at "
            "most %.4g of the size deep), wrong %zu\n",
            totals->poses, totals->apart, totals->behind, totals->without_truth, totals->deepest,
            totals->wrong);
        fails = fails || totals->shallow.beyond() > 0 || totals->wrong > 0;
    }
    return fails ? 1 : 0;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const auto folder = cdprep::test::shared_models("seed");
    if (!folder) {
        std::printf("skipped: no test models beside the checkout (set CDPREP_SHARED)\n");
        return 77;
    }
    return cdprep::run(*folder / "seed",
                       count > 1 ? std::atoi(arguments[1]) : cdprep::test::rounds(1000, 16));
}
