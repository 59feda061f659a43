// SPDX-License-Identifier: MIT
// How fast two models answer "which triangles overlap?" and "do they touch?", pose
// by pose, beside FCL (BVHModel<OBB>, all contacts) where it was found at
// configure time. Contenders take turns at every pose, in one run. Prints a CSV
// table: medians over the poses in microseconds, the quartiles, and the median of
// the ratios to cdprep at the same pose.
//
// Usage: overlapping_triangles_bench A.cdp.h5 B.cdp.h5 POSES [ROUNDS]
// POSES has 12 numbers a line, R row by row, then T; line i is of kind i mod 3:
// light, deep, near.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "cdprep/collide.h"
#include "cdprep/overlapping_triangles.h"

#ifdef CDPREP_HAVE_FCL
#include <fcl/fcl.h>
#endif

namespace cdprep {
namespace {

constexpr std::size_t kMostPairs = 1U << 22;
constexpr std::array<const char*, 3> kKinds = {"light", "deep", "near"};

Model open_or_exit(const char* path) {
    auto opened = Model::open(path);
    if (!opened) {
        std::fprintf(stderr, "%s\n", opened.error().message.c_str());
        std::exit(3);
    }
    return std::move(opened).value();
}

std::vector<Pose> read_poses(const char* path) {
    std::ifstream file(path);
    std::vector<Pose> poses;
    std::array<double, 12> rows{};
    for (std::size_t i = 0; file >> rows[i % 12]; ++i) {
        if (i % 12 != 11) continue;
        auto pose = Pose::from_rows(rows);
        if (!pose) {
            std::fprintf(stderr, "%s: %s\n", path, pose.error().message.c_str());
            std::exit(3);
        }
        poses.push_back(pose.value());
    }
    return poses;
}

/// Microseconds that `question` takes; its answer goes to `count`.
template <class Question>
double timed(std::size_t& count, Question&& question) {
    const auto begun = std::chrono::steady_clock::now();
    count = question();
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - begun;
    return taken.count();
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// What one contender took at each pose of one kind, for one question.
struct Column {
    std::vector<double> best_us;  ///< of the rounds
    std::size_t pairs = 0;        ///< of all poses
};

class Ours {
public:
    static constexpr const char* kName = "cdprep";
    Ours(const Model& a, const Model& b) : a_(a), b_(b), pairs_(kMostPairs) {}
    std::size_t overlap(const Pose& pose) {
        return overlapping_triangles(a_, b_, Placement::b_moves(pose), workspace_, pairs_);
    }
    std::size_t collides(const Pose& pose) {
        return collide(a_, b_, Placement::b_moves(pose), workspace_).hit ? 1 : 0;
    }

private:
    const Model& a_;
    const Model& b_;
    Workspace workspace_;
    std::vector<TrianglePair> pairs_;
};

#ifdef CDPREP_HAVE_FCL
using FclModel = fcl::BVHModel<fcl::OBBd>;

FclModel fcl_model(const Model& model) {
    std::vector<fcl::Vector3d> points;
    for (const Float3& p : model.positions_f32()) points.emplace_back(p.x, p.y, p.z);
    for (const Double3& p : model.positions_f64()) points.emplace_back(p.x, p.y, p.z);
    std::vector<fcl::Triangle> triangles;
    for (const format::Triangle& t : model.triangles()) {
        triangles.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
    }
    FclModel made;
    made.beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size()));
    made.addSubModel(points, triangles);
    made.endModel();
    return made;
}

class Fcl {
public:
    static constexpr const char* kName = "fcl_obb";
    Fcl(const Model& a, const Model& b) : a_(fcl_model(a)), b_(fcl_model(b)) {}
    std::size_t overlap(const Pose& pose) {
        return ask(pose, kMostPairs);
    }
    std::size_t collides(const Pose& pose) {
        return ask(pose, 1);
    }

private:
    std::size_t ask(const Pose& pose, std::size_t most) {
        fcl::Transform3d a_from_b = fcl::Transform3d::Identity();
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                a_from_b.linear()(row, column) =
                    pose.rotation()[static_cast<std::size_t>(3 * row + column)];
            }
        }
        const Double3& t = pose.translation();
        a_from_b.translation() = fcl::Vector3d(t.x, t.y, t.z);
        fcl::CollisionResultd result;
        fcl::collide(&a_, fcl::Transform3d::Identity(), &b_, a_from_b,
                     fcl::CollisionRequestd(most, false), result);
        return result.numContacts();
    }
    FclModel a_;
    FclModel b_;
};
#endif

/// Columns by question and kind.
using Table = std::map<std::string, std::array<Column, 3>>;

template <class Contender>
void ask_once(Contender& contender, const Pose& pose, std::size_t kind, bool is_first,
              Table& table) {
    const auto note = [&](const char* question, double us, std::size_t count) {
        Column& column = table[question][kind];
        if (is_first) {
            column.best_us.push_back(us);
            column.pairs += count;
        } else {
            column.best_us.back() = std::min(column.best_us.back(), us);
        }
    };
    std::size_t count = 0;
    const double overlap = timed(count, [&] { return contender.overlap(pose); });
    note("overlapping_triangles", overlap, count);
    const double collides = timed(count, [&] { return contender.collides(pose); });
    note("collide", collides, count);
}

void print(const char* name, const Table& table, const Table& reference) {
    for (const auto& [question, columns] : table) {
        for (std::size_t kind = 0; kind < columns.size(); ++kind) {
            const std::vector<double>& us = columns[kind].best_us;
            if (us.empty()) continue;
            std::vector<double> ratios;
            const std::vector<double>& ours = reference.at(question)[kind].best_us;
            for (std::size_t i = 0; i < us.size(); ++i) ratios.push_back(us[i] / ours[i]);
            std::printf("%s/%s,%s,%zu,%zu,%.2f,%.2f,%.2f,%.2f\n", question.c_str(), kKinds[kind],
                        name, us.size(), columns[kind].pairs, quantile(us, 0.5), quantile(us, 0.25),
                        quantile(us, 0.75), quantile(ratios, 0.5));
        }
    }
}

int run(const Model& a, const Model& b, const std::vector<Pose>& poses, int rounds) {
    Ours ours(a, b);
    Table our_table;
#ifdef CDPREP_HAVE_FCL
    Fcl fcl(a, b);
    Table fcl_table;
#endif
    for (std::size_t i = 0; i < poses.size(); ++i) {
        for (int round = 0; round < rounds; ++round) {
            ask_once(ours, poses[i], i % 3, round == 0, our_table);
#ifdef CDPREP_HAVE_FCL
            ask_once(fcl, poses[i], i % 3, round == 0, fcl_table);
#endif
        }
    }
    std::printf(
        "question,contender,poses,pairs,median_us,lower_quartile_us,upper_quartile_us,"
        "times_cdprep\n");
    print(Ours::kName, our_table, our_table);
#ifdef CDPREP_HAVE_FCL
    print(Fcl::kName, fcl_table, our_table);
#endif
    return 0;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 4) {
        std::fprintf(stderr, "usage: %s A.cdp.h5 B.cdp.h5 POSES [ROUNDS]\n", arguments[0]);
        return 2;
    }
    const cdprep::Model a = cdprep::open_or_exit(arguments[1]);
    const cdprep::Model b = cdprep::open_or_exit(arguments[2]);
    const int rounds = count > 4 ? std::max(1, std::atoi(arguments[4])) : 3;
    return cdprep::run(a, b, cdprep::read_poses(arguments[3]), rounds);
}
