// SPDX-License-Identifier: MIT
#include "accuracy/ladder.h"

#include <gtest/gtest.h>

namespace cdprep::study {
namespace {

StudyPose pose_of(Stratum stratum, bool hit, double depth_or_gap, Answer solid) {
    StudyPose pose;
    pose.stratum = stratum;
    pose.hit = hit;
    pose.solid = solid;
    (hit ? pose.depth : pose.gap_upper) = depth_or_gap;
    return pose;
}

/// Two that touch, deep and shallow; two that do not, near and far; one inside the other.
PoseSet five_poses() {
    PoseSet set;
    set.diagonal = 1;
    set.poses = {pose_of(Stratum::deep, true, 0.1, Answer::yes),
                 pose_of(Stratum::shallow, true, 0.005, Answer::yes),
                 pose_of(Stratum::near, false, 0.02, Answer::no),
                 pose_of(Stratum::far, false, 0.5, Answer::no),
                 pose_of(Stratum::far, false, 0.3, Answer::yes)};
    return set;
}

Rung judged(Promise promise, std::vector<Answer> answers, Broken& broken) {
    Rung rung;
    rung.name = "rung";
    rung.promise = promise;
    rung.answers = std::move(answers);
    judge_answers("ladder", five_poses(), rung, broken);
    return rung;
}

constexpr Answer kYes = Answer::yes;
constexpr Answer kNo = Answer::no;
constexpr Answer kUnknown = Answer::unknown;

// By hand: of three poses apart two are called hits, the farther one is the worst.
TEST(JudgeAnswers, ShapesThatEncloseErrByFalseHits) {
    Broken broken;
    const Rung rung = judged(Promise::no_misses, {kYes, kYes, kYes, kYes, kNo}, broken);
    EXPECT_TRUE(broken.empty());
    EXPECT_DOUBLE_EQ(*rung.error, 2.0 / 3);
    EXPECT_LT(rung.error_low, 2.0 / 3);
    EXPECT_GT(rung.error_high, 2.0 / 3);
    EXPECT_EQ(rung.worst_pose, 3U);
    const StratumErrors& far = rung.strata[static_cast<std::size_t>(Stratum::far)];
    EXPECT_EQ(far.false_hits.count, 1U);
    EXPECT_EQ(far.false_hits.of, 2U);
    EXPECT_EQ(far.misses.of, 0U);
}

// By hand: the second pose, which is missed, and the fourth, a false hit, are not proved.
TEST(JudgeAnswers, ErrorsOfTheExactRotationAreThoseOfProvedPoses) {
    PoseSet set = five_poses();
    for (const std::size_t i : {0U, 2U, 4U}) set.poses[i].is_rigid = true;
    Rung rung;
    rung.answers = {kYes, kNo, kYes, kYes, kNo};
    Broken broken;
    judge_answers("ladder", set, rung, broken);
    ASSERT_TRUE(rung.rigid);
    EXPECT_EQ(rung.rigid->undecided, 2U);
    EXPECT_EQ(rung.rigid->misses.count, 0U);
    EXPECT_EQ(rung.rigid->misses.of, 1U);
    EXPECT_EQ(rung.rigid->false_hits.count, 1U);
    EXPECT_EQ(rung.rigid->false_hits.of, 2U);
}

TEST(JudgeAnswers, AMissBreaksThePromiseToMissNothing) {
    Broken broken;
    const Rung rung = judged(Promise::no_misses, {kYes, kNo, kNo, kNo, kNo}, broken);
    ASSERT_EQ(broken.size(), 1U);
    EXPECT_NE(broken[0].find("shallow pose 1"), std::string::npos) << broken[0];
    EXPECT_EQ(rung.worst_pose, 1U);
    broken.clear();
    static_cast<void>(judged(Promise::none, {kNo, kNo, kNo, kNo, kNo}, broken));
    EXPECT_TRUE(broken.empty());
}

TEST(JudgeAnswers, ExactMeansBothWays) {
    Broken broken;
    static_cast<void>(judged(Promise::exact, {kYes, kYes, kNo, kNo, kNo}, broken));
    EXPECT_TRUE(broken.empty());
    static_cast<void>(judged(Promise::exact, {kYes, kNo, kYes, kNo, kNo}, broken));
    EXPECT_EQ(broken.size(), 2U);
}

// One solid inside the other is a hit of solids, though surfaces are apart.
TEST(JudgeAnswers, AYesAboutSolidsMayBeRightWhereSurfacesAreApart) {
    Broken broken;
    const Rung rung = judged(Promise::both_sides, {kYes, kUnknown, kUnknown, kNo, kYes}, broken);
    EXPECT_TRUE(broken.empty());
    EXPECT_DOUBLE_EQ(*rung.error, 2.0 / 3);
    EXPECT_EQ(rung.strata[static_cast<std::size_t>(Stratum::near)].unknown, 1U);
    static_cast<void>(judged(Promise::both_sides, {kYes, kYes, kYes, kNo, kNo}, broken));
    EXPECT_EQ(broken.size(), 1U);
}

std::size_t broken_by(Promise promise, const PairCounts& counts) {
    Rung rung;
    rung.promise = promise;
    rung.pairs = PairErrors{counts, {}, {}, {}};
    Broken broken;
    judge_pairs("ladder", rung, broken);
    return broken.size();
}

// By hand: two of nine pairs are missing, one of eight is too many.
TEST(JudgePairs, EveryPromiseIsHeldToWhatItSays) {
    constexpr PairCounts kBothWays = {9, 8, 7};
    EXPECT_EQ(broken_by(Promise::exact, kBothWays), 2U);
    EXPECT_EQ(broken_by(Promise::no_misses, kBothWays), 1U);
    EXPECT_EQ(broken_by(Promise::no_false_hits, kBothWays), 1U);
    EXPECT_EQ(broken_by(Promise::none, kBothWays), 0U);
    EXPECT_EQ(broken_by(Promise::no_misses, {7, 8, 7}), 0U);
    EXPECT_EQ(broken_by(Promise::no_false_hits, {9, 7, 7}), 0U);
    EXPECT_EQ(broken_by(Promise::exact, {7, 7, 7}), 0U);
}

Rung at(double time, std::optional<double> error) {
    Rung rung;
    rung.time.median_s = time;
    rung.error = error;
    return rung;
}

// By hand: the third is slower and worse than the second, the fourth ties in error alone.
TEST(Dominated, IsWhatAnotherBeatsInTimeAndError) {
    const std::vector<bool> beaten =
        dominated({at(1, 0.5), at(2, 0.1), at(3, 0.2), at(4, 0.1), at(5, 0), at(1, {})});
    EXPECT_EQ(beaten, (std::vector<bool>{false, false, true, true, false, false}));
}

TEST(Dominated, RungsOfAnotherQuestionAreNotCompared) {
    Rung distance = at(9, 0);
    distance.question = "how far apart";
    EXPECT_EQ(dominated({at(1, 0), distance}), (std::vector<bool>{false, false}));
}

// Of two that are alike neither beats the other.
TEST(Dominated, EqualsAreBothOnTheFront) {
    EXPECT_EQ(dominated({at(1, 0.5), at(1, 0.5)}), (std::vector<bool>{false, false}));
}

}  // namespace
}  // namespace cdprep::study
