// SPDX-License-Identifier: MIT
#include "compare/peers.h"

#include <gtest/gtest.h>

namespace cdprep::report {
namespace {

using study::Asked;

constexpr const char* kGood = R"({"peers": [{"key": "x", "name": "X 1", "note": "n",
 "collide": {"seconds": [[1e-3, 2e-3], [2]], "answers": [1, 0]}, "reasons": {"overlap": "cannot"}}],
 "absent": [{"key": "y", "name": "Y", "reason": "no package"}]})";

TEST(ReadPeers, TakesAnswersAndReasons) {
    const auto run = read_peers(kGood);
    ASSERT_TRUE(run) << run.error().message;
    ASSERT_EQ(run.value().peers.size(), 1U);
    const study::PeerAnswers& peer = run.value().peers[0];
    EXPECT_EQ(peer.name, "X 1");
    EXPECT_EQ(peer.key, "x");
    EXPECT_EQ(peer.asked[0].seconds, (std::vector<std::vector<double>>{{1e-3, 2e-3}, {2}}));
    EXPECT_EQ(peer.asked[0].answers, (std::vector<std::size_t>{1, 0}));
    EXPECT_EQ(peer.reasons[static_cast<std::size_t>(Asked::overlap)], "cannot");
    EXPECT_FALSE(peer.reasons[static_cast<std::size_t>(Asked::distance)].empty());
    EXPECT_EQ(run.value().absent.at(0).key, "y");
    EXPECT_EQ(run.value().absent.at(0).reason, "no package");
}

TEST(ReadPeers, TakesWhatWasBuilt) {
    const auto run = read_peers(R"({"builds": [{"key": "q", "name": "Q 2", "note": "n",
 "seconds": [1, 3], "vertices": 8, "facets": 12}], "absent": []})");
    ASSERT_TRUE(run) << run.error().message;
    const study::PeerBuild& build = run.value().builds.at(0);
    EXPECT_EQ(build.key, "q");
    EXPECT_EQ(build.seconds, (std::vector<double>{1, 3}));
    EXPECT_EQ(build.vertices, 8U);
    EXPECT_EQ(build.facets, 12U);
}

// Every beginning of it is no JSON.
TEST(ReadPeers, RefusesEveryTruncation) {
    const std::string good = kGood;
    for (std::size_t size = 0; size < good.size(); ++size) {
        EXPECT_FALSE(read_peers(good.substr(0, size))) << size;
    }
}

TEST(ReadPeers, RefusesOtherJson) {
    for (const char* text :
         {"[]", "{}", "{\"builds\": [{}], \"absent\": []}", "{\"peers\": 1, \"absent\": []}",
          "{\"peers\": [{}], \"absent\": []}", "{\"peers\": [], \"absent\": [1]}"}) {
        EXPECT_FALSE(read_peers(text)) << text;
    }
}

}  // namespace
}  // namespace cdprep::report
