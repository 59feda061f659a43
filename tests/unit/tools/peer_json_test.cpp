// SPDX-License-Identifier: MIT
#include "report/peer_json.h"

#include <gtest/gtest.h>

namespace cdprep::report {
namespace {

using study::Asked;

constexpr const char* kGood = R"({"peers": [{"name": "X 1", "note": "n", "build_s": 0.5,
 "collide": {"seconds": [1e-3, 2], "answers": [1, 0]}, "reasons": {"overlap": "cannot"}}],
 "absent": [{"name": "Y", "reason": "no package"}]})";

TEST(ReadPeers, TakesAnswersAndReasons) {
    const auto run = read_peers(kGood);
    ASSERT_TRUE(run) << run.error().message;
    ASSERT_EQ(run.value().peers.size(), 1U);
    const study::PeerAnswers& peer = run.value().peers[0];
    EXPECT_EQ(peer.name, "X 1");
    EXPECT_EQ(peer.asked[0].seconds, (std::vector<double>{1e-3, 2}));
    EXPECT_EQ(peer.asked[0].answers, (std::vector<std::size_t>{1, 0}));
    EXPECT_EQ(peer.reasons[static_cast<std::size_t>(Asked::overlap)], "cannot");
    EXPECT_FALSE(peer.reasons[static_cast<std::size_t>(Asked::distance)].empty());
    EXPECT_EQ(run.value().absent.at(0), "Y was not asked: no package.");
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
         {"[]", "{}", "{\"peers\": 1, \"absent\": []}", "{\"peers\": [{}], \"absent\": []}",
          "{\"peers\": [], \"absent\": [1]}"}) {
        EXPECT_FALSE(read_peers(text)) << text;
    }
}

}  // namespace
}  // namespace cdprep::report
