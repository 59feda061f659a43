// SPDX-License-Identifier: MIT
#include "scene_file/changing_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/run_threads.h"
#include "support/scratch_folder.h"

#include "cdprep/workspace.h"

namespace cdprep::scenes {
namespace {

using test::TestMesh;

const Shear kShear = {.of = 0, .along = 2, .amplitude = 0.5, .period_s = 4};
const Twist kTwist = {.axis = 2, .angle_rad = 1, .period_s = 4};
const Tear kTear = {.point = {0.1, 0, 0}, .normal = {1, 0.5, 0}, .time_s = 1, .opening = 0.5};

/// A ball that changes, and its triangles as they should be.
class Ball {
public:
    explicit Ball(const Change& change, bool has_doubles = true, int level = 2)
        : mesh_(has_doubles ? test::icosphere(level) : test::in_floats(test::icosphere(level))),
          base_(test::open_tiny(mesh_, {.double_precision = has_doubles})),
          made_(ChangingModel::make(base_.model, change, "ball.obj")) {
        EXPECT_TRUE(made_);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            triangles_[i] = mesh_.triangles[i];
        }
    }

    [[nodiscard]] ChangingModel& model() {
        return *made_;
    }
    [[nodiscard]] const TestMesh& mesh() const {
        return mesh_;
    }

    void tear() {
        const Cut& cut = made_->cut();
        auto next = static_cast<std::uint32_t>(triangles_.size());
        for (const std::uint32_t number : cut.removed) triangles_.erase(number);
        for (const format::Triangle& added : cut.appended) triangles_[next++] = added;
    }

    /// Expects that the model answers as a new one of the mesh with these positions, and that its
    /// triangles are those expected. Returns the number of pairs.
    std::size_t expect_shape(const std::vector<Double3>& positions) {
        TestMesh now = {positions, {}};
        std::vector<std::uint32_t> numbers;
        for (const auto& [number, triangle] : triangles_) {
            numbers.push_back(number);
            now.triangles.push_back(triangle);
        }
        const TestMesh fixed = test::moved_by(test::icosphere(1), 0.8, {0.7, 0.2, 0.1});
        const test::OpenModel other = test::open_tiny(fixed, {.double_precision = true});
        std::vector<TrianglePair> expected =
            test::brute_force_pairs(now, fixed, Placement::b_moves({}));
        for (TrianglePair& pair : expected) pair.a = numbers[pair.a];
        std::vector<TrianglePair> found(expected.size() + 100);
        found.resize(std::min(
            found.size(),
            overlaps({made_->model(), other.model, Placement::b_moves({})}, workspace_, found)));
        EXPECT_EQ(found, expected);
        return expected.size();
    }

    /// Returns the vertices at rest, those of the cut at the end.
    [[nodiscard]] std::vector<Double3> rest() const {
        std::vector<Double3> rest = mesh_.positions;
        for (const CutVertex& vertex : made_->cut().vertices) rest.push_back(between(rest, vertex));
        return rest;
    }
    [[nodiscard]] static Double3 between(const std::vector<Double3>& at, const CutVertex& vertex) {
        const Double3 &a = at[vertex.a], &b = at[vertex.b];
        return {std::lerp(a.x, b.x, vertex.share), std::lerp(a.y, b.y, vertex.share),
                std::lerp(a.z, b.z, vertex.share)};
    }

private:
    TestMesh mesh_;
    test::OpenModel base_;
    Result<ChangingModel> made_;
    std::map<std::uint32_t, format::Triangle> triangles_;
    Workspace workspace_;
};

std::vector<Double3> sheared(const std::vector<Double3>& rest, double factor) {
    std::vector<Double3> moved = rest;  // the middle of the ball is 0
    for (Double3& p : moved) p.x += factor * p.z;
    return moved;
}

void expect_work(const Result<ChangeWork>& work, std::uint64_t refits, std::uint64_t torn = 0) {
    ASSERT_TRUE(work) << work.error().message;
    EXPECT_EQ(work->refits, refits);
    EXPECT_EQ(work->torn, torn);
}

// The oracle tests all pairs of triangles of the mesh that the closed form gives.
TEST(ChangingModel, AnswersAsANewModel) {
    Ball ball({.deform = kShear});
    std::size_t pairs = 0;
    for (const double time : {0.0, 0.4, 1.0, 3.3, 100.7}) {
        expect_work(ball.model().set_time(time, serial_for), 1);
        pairs += ball.expect_shape(sheared(ball.rest(), kShear.factor(time)));
    }
    EXPECT_GT(pairs, 100u);
}

// A strong twist makes boxes large. They are built anew as far as a frame allows, and answers stay.
TEST(ChangingModel, RebuildsWhereBoxesGrow) {
    constexpr Twist kStrong = {.axis = 2, .angle_rad = 12, .period_s = 4};
    Ball ball({.deform = kStrong});
    const auto work = ball.model().set_time(1, serial_for);
    expect_work(work, 1);
    EXPECT_EQ(work->rebuilt, ball.mesh().triangles.size());
    std::vector<Double3> twisted(ball.rest().size());
    twist(kStrong, kStrong.angle(1), ball.model().rest_box(), ball.rest(), twisted);
    EXPECT_GT(ball.expect_shape(twisted), 20u);
    EXPECT_EQ(ball.model().set_time(1.01, serial_for)->rebuilt, 0u);

    Ball large({.deform = kStrong}, true, 5);
    for (const double time : {1.0, 1.01}) {
        const std::uint64_t rebuilt = large.model().set_time(time, serial_for)->rebuilt;
        EXPECT_GT(rebuilt, 0u);
        EXPECT_LE(rebuilt, 4096u);
    }
}

// Equal shapes need no refit.
TEST(ChangingModel, StaysAsItIs) {
    Ball ball({.deform = kShear});
    expect_work(ball.model().set_time(0.5, serial_for), 1);
    expect_work(ball.model().set_time(0.5, serial_for), 0);
    Ball torn({.tear = kTear});
    expect_work(torn.model().set_time(0, serial_for), 1);
    expect_work(torn.model().set_time(0.5, serial_for), 0);
    expect_work(torn.model().set_time(1, serial_for), 1, torn.model().cut().removed.size());
    expect_work(torn.model().set_time(5, serial_for), 0);
}

// New vertices are deformed like all others, from their places at rest. Then the sides part.
TEST(ChangingModel, TearsWhileItDeforms) {
    for (const bool has_doubles : {true, false}) {
        Ball ball({.deform = kShear, .tear = kTear}, has_doubles);
        const Cut& cut = ball.model().cut();
        EXPECT_GT(cut.removed.size(), 20u);
        const auto shape = [&](double time) {
            std::vector<Double3> positions = sheared(ball.rest(), kShear.factor(time));
            const Double3 half = half_opening(kTear);
            for (std::size_t i = 0; i < positions.size() && time >= kTear.time_s; ++i) {
                const double sign = cut.is_far[i] != 0 ? 1 : -1;
                positions[i].x += sign * half.x;
                positions[i].y += sign * half.y;
                positions[i].z += sign * half.z;
            }
            if (has_doubles) return positions;
            return test::in_floats({positions, {}}).positions;
        };
        expect_work(ball.model().set_time(0.75, serial_for), 1);
        std::size_t pairs = ball.expect_shape(shape(0.75));
        expect_work(ball.model().set_time(1.25, serial_for), 1, cut.removed.size());
        ball.tear();
        pairs += ball.expect_shape(shape(1.25));
        expect_work(ball.model().set_time(2.5, serial_for), 1);
        pairs += ball.expect_shape(shape(2.5));
        EXPECT_GT(pairs, 50u);
        EXPECT_TRUE(ball.model().model().is_torn());
    }
}

// The live model holds the triangles of the cut, under the numbers that follow.
TEST(ChangingModel, KeepsNumbersAndVertices) {
    Ball ball({.tear = kTear});
    ASSERT_TRUE(ball.model().set_time(2, serial_for));
    const Cut& cut = ball.model().cut();
    std::vector<LiveTriangle> found(ball.model().live().triangle_count());
    ASSERT_EQ(ball.model().live().triangles(found), found.size());
    std::vector<LiveTriangle> expected;
    const std::vector<format::Triangle>& triangles = ball.mesh().triangles;
    for (std::uint32_t i = 0; i < triangles.size() + cut.appended.size(); ++i) {
        if (std::ranges::binary_search(cut.removed, i)) continue;
        expected.push_back({i, i < triangles.size() ? triangles[i].vertex
                                                    : cut.appended[i - triangles.size()].vertex});
    }
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].number, expected[i].number);
        EXPECT_EQ(found[i].vertex, expected[i].vertex);
    }
}

// A frame that is computed again begins before the tear.
TEST(ChangingModel, RunsBackwards) {
    Ball ball({.deform = kShear, .tear = kTear}), fresh({.deform = kShear, .tear = kTear});
    ASSERT_TRUE(ball.model().set_time(2.25, serial_for));
    expect_work(ball.model().set_time(0.5, serial_for), 1);
    EXPECT_FALSE(ball.model().model().is_torn());
    EXPECT_GT(ball.expect_shape(sheared(ball.rest(), kShear.factor(0.5))), 0u);
    expect_work(ball.model().set_time(2.25, serial_for), 1, ball.model().cut().removed.size());
    ASSERT_TRUE(fresh.model().set_time(2.25, serial_for));
    EXPECT_TRUE(std::ranges::equal(ball.model().model().mesh().positions_f64,
                                   fresh.model().model().mesh().positions_f64));
}

// A tear before time 0 and one at 0 hold in the first frame.
TEST(ChangingModel, TearsInTheFirstFrame) {
    for (const double time : {-1.0, 0.0}) {
        Tear early = kTear;
        early.time_s = time;
        Ball ball({.tear = early});
        EXPECT_FALSE(ball.model().model().is_torn());
        expect_work(ball.model().set_time(0, serial_for), 1, ball.model().cut().removed.size());
        EXPECT_TRUE(ball.model().model().is_torn());
    }
}

TEST(ChangingModel, StaysWholeWhereThePlaneMisses) {
    Tear far = kTear;
    far.point = {10, 0, 0};
    Ball ball({.tear = far});
    EXPECT_TRUE(ball.model().cut().misses);
    expect_work(ball.model().set_time(5, serial_for), 1);
    EXPECT_FALSE(ball.model().model().is_torn());
    EXPECT_GT(ball.expect_shape(ball.mesh().positions), 0u);
    EXPECT_EQ(ball.model().live().triangle_count(), ball.mesh().triangles.size());
}

/// Writes a stream of this many samples: sample i is the points, moved by i along x.
std::filesystem::path write_stream(const test::ScratchFolder& folder,
                                   const std::vector<Double3>& points, std::uint32_t samples) {
    std::string bytes("POINTCACHE2\0", 12);
    const auto word = [&](std::uint32_t value) {
        for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 255U));
    };
    for (const std::uint32_t value :
         {1U, static_cast<std::uint32_t>(points.size()), 0U, 0U, samples}) {
        word(value);
    }
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
        for (const Double3& p : points) {
            for (const double x : {p.x + sample, p.y, p.z}) {
                word(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
            }
        }
    }
    return folder.write("s.pc2", std::string_view(bytes));
}

// By hand: half way between two samples. New vertices stay on the edges of the samples.
TEST(ChangingModel, FollowsAStream) {
    const test::ScratchFolder folder;
    const TestMesh mesh = test::in_floats(test::icosphere(2));
    const Stream stream = {.file = write_stream(folder, mesh.positions, 3), .step_s = 2};
    Ball ball({.deform = stream, .tear = kTear}, false);
    const auto shape = [&](double shift) {
        std::vector<Double3> positions = mesh.positions;
        // In the order of the reader: samples are floats, and linear between them in double.
        for (Double3& p : positions) {
            const auto from = static_cast<double>(static_cast<float>(p.x + std::floor(shift)));
            const auto to = static_cast<double>(static_cast<float>(p.x + std::floor(shift) + 1));
            p.x = from + (shift - std::floor(shift)) * (to - from);
        }
        return positions;
    };
    expect_work(ball.model().set_time(0.5, serial_for), 1);
    EXPECT_GT(ball.expect_shape(test::in_floats({shape(0.25), {}}).positions), 0u);
    expect_work(ball.model().set_time(2.5, serial_for), 1, ball.model().cut().removed.size());
    ball.tear();
    std::vector<Double3> positions = shape(1.25);
    for (const CutVertex& vertex : ball.model().cut().vertices) {
        positions.push_back(Ball::between(positions, vertex));
    }
    const Double3 half = half_opening(kTear);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double sign = ball.model().cut().is_far[i] != 0 ? 1 : -1;
        positions[i].x += sign * half.x;
        positions[i].y += sign * half.y;
    }
    ball.expect_shape(test::in_floats({positions, {}}).positions);
    // After the last sample nothing changes.
    expect_work(ball.model().set_time(4, serial_for), 1);
    expect_work(ball.model().set_time(7, serial_for), 0);
}

TEST(ChangingModel, RefusesAStreamOfTooFewPoints) {
    const test::ScratchFolder folder;
    const TestMesh mesh = test::icosphere(2);
    std::vector<Double3> fewer = mesh.positions;
    fewer.pop_back();
    const Stream stream = {.file = write_stream(folder, fewer, 1), .step_s = 1};
    const test::OpenModel base = test::open_tiny(mesh);
    const auto made = ChangingModel::make(base.model, {.deform = stream}, "ball.obj");
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::unreadable);
    EXPECT_EQ(made.error().message,
              stream.file.string() +
                  ": byte 16: found 161 points; expected at least 162, the vertices of ball.obj.");
}

TEST(ChangingModel, RefusesPositionsBeyondTheRange) {
    Ball ball({.deform = Shear{.of = 0, .along = 2, .rate_per_s = 1e301}});
    expect_work(ball.model().set_time(0, serial_for), 1);
    const auto work = ball.model().set_time(10, serial_for);
    ASSERT_FALSE(work);
    EXPECT_EQ(work.error().code, ErrorCode::bad_argument);
    EXPECT_GT(ball.expect_shape(ball.mesh().positions), 0u) << "nothing has changed";
}

// Threads change no byte.
TEST(ChangingModel, IsTheSameOnAnyNumberOfThreads) {
    Ball one({.deform = kTwist, .tear = kTear}), many({.deform = kTwist, .tear = kTear});
    for (const double time : {0.0, 0.7, 1.4, 2.3}) {
        ASSERT_TRUE(one.model().set_time(time, serial_for));
        ASSERT_TRUE(many.model().set_time(time, test::run_threads));
        EXPECT_TRUE(std::ranges::equal(one.model().model().bytes(), many.model().model().bytes()));
    }
}

}  // namespace
}  // namespace cdprep::scenes
