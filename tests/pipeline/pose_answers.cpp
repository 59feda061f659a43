// SPDX-License-Identifier: MIT
// Asks about two baked models at poses, in every floating-point environment that a caller may
// have, and fails when the bytes of an answer are not those of the default environment.
//
// Usage: pose_answers A B POSES MOST
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

#include "support/float_modes.h"

#include "cdprep/pairs.h"

namespace cdprep::test {
namespace {

Model open(const char* path) {
    Result<Model> opened = Model::open(path);
    if (opened) return std::move(opened).value();
    std::fprintf(stderr, "pose_answers: %s\n", opened.error().message.c_str());
    std::exit(2);
}

std::vector<Pose> read_poses(const char* path, std::size_t most) {
    std::ifstream file(path);
    std::vector<Pose> poses;
    std::array<double, 12> rows{};
    while (poses.size() < most) {
        for (double& number : rows) file >> number;
        if (!file) break;
        poses.push_back(Pose::from_rows(rows).value());
    }
    return poses;
}

/// All that is answered at one pose.
struct Answers {
    std::vector<TrianglePair> pairs;
    std::vector<TrianglePair> near;
    std::vector<std::uint64_t> numbers;  ///< the others, bit for bit

    void add(double number) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &number, sizeof bits);
        numbers.push_back(bits);
    }
    void add(const Double3& p) {
        add(p.x);
        add(p.y);
        add(p.z);
    }
    friend bool operator==(const Answers&, const Answers&) = default;
};

class Asker {
public:
    Asker(const Model& a, const Model& b) : a_(a), b_(b) {}

    [[nodiscard]] Answers ask(const Placement& placement, double tolerance) {
        Answers answers;
        answers.pairs.resize(overlaps({a_, b_, placement}, workspace_, pairs_));
        std::copy_n(pairs_.begin(), answers.pairs.size(), answers.pairs.begin());
        answers.near.resize(pairs_within({a_, b_, placement}, tolerance, workspace_, pairs_));
        std::copy_n(pairs_.begin(), answers.near.size(), answers.near.begin());
        const Collision solid = collide({a_, b_, placement, {.body = Body::solid}}, workspace_);
        answers.numbers.push_back(solid.hit == Answer::yes ? 1 : 0);
        answers.add(solid.containment.winding);
        answers.numbers.push_back(within({a_, b_, placement}, tolerance, workspace_) ? 1 : 0);
        if (const auto found = distance({a_, b_, placement}, workspace_)) {
            answers.add(found->lower);
            answers.add(found->upper);
            answers.add(found->witness_a);
            answers.add(found->witness_b);
            answers.numbers.push_back(found->triangle_a);
            answers.numbers.push_back(found->triangle_b);
        }
        return answers;
    }

private:
    const Model& a_;
    const Model& b_;
    Workspace workspace_;
    std::vector<TrianglePair> pairs_ = std::vector<TrianglePair>(std::size_t{1} << 20);
};

int run(const char* path_a, const char* path_b, const char* poses_file, std::size_t most) {
    const Model a = open(path_a), b = open(path_b);
    const std::vector<Pose> poses = read_poses(poses_file, most);
    Asker asker(a, b);
    const double tolerance = std::ldexp(0x1p-8, -a.header().frame_exponent);
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Placement placement = Placement::b_moves(poses[i]);
        const Answers expected = asker.ask(placement, tolerance);
        pairs += expected.pairs.size();
        for (const FloatMode& mode : float_modes()) {
            Answers answers;
            const std::uint64_t left =
                run_in(mode, [&] { answers = asker.ask(placement, tolerance); });
            if (answers == expected && left == control_bits(mode.control)) continue;
            std::printf("pose %zu, %s: other answers than by default\n", i, mode.name);
            return 1;
        }
    }
    std::printf("%zu poses, %zu pairs\n", poses.size(), pairs);
    return poses.empty() ? 2 : 0;
}

}  // namespace
}  // namespace cdprep::test

int main(int count, char** values) {
    if (count != 5) {
        std::fprintf(stderr, "usage: pose_answers A B POSES MOST\n");
        return 2;
    }
    return cdprep::test::run(values[1], values[2], values[3],
                             std::strtoull(values[4], nullptr, 10));
}
