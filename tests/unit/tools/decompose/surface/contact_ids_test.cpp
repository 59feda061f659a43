// SPDX-License-Identifier: MIT
// Ids of contacts from frame to frame. A contact persists if the next frame has one at nearly the
// same place with nearly the same normal; only then a solver can use its impulse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "cdprep/contacts.h"
#include "support/concave_solids.h"
#include "unit/tools/with_pieces.h"

namespace cdprep::test {
namespace {

constexpr int kFrames = 200;
constexpr double kStep = 0.0005;      // a frame; an edge of the rings is about 0.1 long
constexpr double kSamePlace = 0.002;  // four steps
constexpr double kSameNormal = 0.99;  // cosine: 8 degrees

/// Something that a solver finds again: a contact, or a point of a manifold.
struct Mark {
    std::pair<std::uint64_t, std::uint64_t> id;  ///< of the contact, and of the point
    Double3 place, normal;
};

bool persists(const Mark& mark, const std::vector<Mark>& next) {
    return std::any_of(next.begin(), next.end(), [&](const Mark& other) {
        const Double3 &p = mark.place, &q = other.place, &n = mark.normal, &m = other.normal;
        return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z) <= kSamePlace &&
               n.x * m.x + n.y * m.y + n.z * m.z >= kSameNormal;
    });
}

struct Frame {
    std::vector<Mark> contacts, points;
};

Frame frame_of(const Pair& pair, const ContactOptions& options, Workspace& workspace) {
    std::vector<Contact> room(2000);
    room.resize(contacts(pair, workspace, room, options).count);
    Frame frame;
    for (const Contact& c : room) {
        frame.contacts.push_back({{c.id, 0}, c.point_a, c.normal});
        for (std::uint32_t i = 0; i < c.point_count; ++i) {
            frame.points.push_back({{c.id, c.points[i].id}, c.points[i].on_a, c.normal});
        }
    }
    return frame;
}

struct Kept {
    int persisted = 0, kept = 0;
    void add(const std::vector<Mark>& last, const std::vector<Mark>& next) {
        for (const Mark& mark : last) {
            if (!persists(mark, next)) continue;
            ++persisted;
            kept += std::any_of(next.begin(), next.end(),
                                [&](const Mark& other) { return other.id == mark.id; });
        }
    }
    [[nodiscard]] double share() const {
        return static_cast<double>(kept) / persisted;
    }
};

/// A ring slides over another, slowly, and turns by as much.
std::pair<Kept, Kept> slide(const ContactOptions& options) {
    const OpenModel ring = open_with_pieces(torus(1, 0.4, 40, 24));
    Workspace workspace;
    std::pair<Kept, Kept> kept;
    Frame last;
    for (int i = 0; i < kFrames; ++i) {
        const double way = i * kStep;
        const Pose pose = Pose::from_quaternion(1, 0.01, 0, way, {0.3 + way, 0.1, 0.775}).value();
        const Pair pair = {ring.model, ring.model, Placement::b_moves(pose)};
        Frame next = frame_of(pair, options, workspace);
        kept.first.add(last.contacts, next.contacts);
        kept.second.add(last.points, next.points);
        last = std::move(next);
    }
    return kept;
}

TEST(ContactIds, NineOfTenStayWhileBodiesSlide) {
    const ContactOptions all = {.tolerance = 0.02, .manifold = Manifold::four};
    ContactOptions listed = all, clustered = all;
    listed.most = 16;
    clustered.most = 64;
    clustered.cluster_angle = 0.26;
    for (const auto& [name, options] : {std::pair{"all", all}, std::pair{"the 16 deepest", listed},
                                        std::pair{"clusters", clustered}}) {
        SCOPED_TRACE(name);
        const auto [contacts, points] = slide(options);
        ASSERT_GT(contacts.persisted, kFrames);
        ASSERT_GT(points.persisted, kFrames);
        EXPECT_GE(contacts.share(), 0.9);
        EXPECT_GE(points.share(), 0.9);
    }
}

}  // namespace
}  // namespace cdprep::test
