// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/copies.h"

#include <algorithm>
#include <queue>
#include <tuple>
#include <utility>

namespace cdprep::mesh {
namespace {

bool meeting_comes_before(const TriangleMeeting& x, const TriangleMeeting& y) {
    return std::tie(x.a, x.b) < std::tie(y.a, y.b);
}

/// The pairs of one meeting, in order of (a, b). Merges both lists of copies: the rest of one
/// list lies above the next element of the other.
class PairStream {
public:
    PairStream(const TriangleMeeting& meeting, const Copies& copies)
        : left_(copies.of(meeting.a)), right_(copies.of(meeting.b)), meeting_(meeting.meeting) {}

    [[nodiscard]] TriangleMeeting pair() const {
        return {left_[next_left_], right_[partner_], meeting_};
    }

    /// Goes to the next pair; returns false after the last.
    bool advance() {
        if (++partner_ < right_.size()) return true;
        if (++next_left_ == left_.size()) return false;
        if (left_[next_left_] > right_[next_right_]) {
            std::swap(left_, right_);
            std::swap(next_left_, next_right_);
        }
        partner_ = next_right_;
        return true;
    }

private:
    CopyList left_;  ///< the list of the pair's lower triangle
    CopyList right_;
    Meeting meeting_;
    std::size_t next_left_ = 0;
    std::size_t next_right_ = 0;
    std::size_t partner_ = 0;
};

}  // namespace

Copies::Copies(std::vector<RepeatedTriangle> repeated) : repeated_(std::move(repeated)) {
    std::sort(repeated_.begin(), repeated_.end(),
              [](const RepeatedTriangle& a, const RepeatedTriangle& b) {
                  return std::tie(a.first, a.triangle) < std::tie(b.first, b.triangle);
              });
}

CopyList Copies::of(std::uint32_t lowest) const {
    const auto begin = std::partition_point(
        repeated_.begin(), repeated_.end(),
        [lowest](const RepeatedTriangle& copy) { return copy.first < lowest; });
    const auto end = std::partition_point(
        begin, repeated_.end(),
        [lowest](const RepeatedTriangle& copy) { return copy.first == lowest; });
    return {lowest, {begin, end}};
}

std::vector<std::uint32_t> Copies::left_of(std::size_t triangles) const {
    std::vector<bool> is_copy(triangles);
    for (const RepeatedTriangle& copy : repeated_) is_copy[copy.triangle] = true;
    std::vector<std::uint32_t> left;
    left.reserve(triangles - repeated_.size());
    for (std::uint32_t i = 0; i < triangles; ++i) {
        if (!is_copy[i]) left.push_back(i);
    }
    return left;
}

bool search_distinct_meetings(const Mesh& mesh, const Copies& copies, const SearchOptions& options,
                              const TakeMeetings& take) {
    if (copies.empty()) return search_self_intersections(mesh, options, take);
    const std::vector<std::uint32_t> left = copies.left_of(mesh.triangles.size());
    Mesh distinct;
    distinct.positions = mesh.positions;
    distinct.triangles.reserve(left.size());
    for (const std::uint32_t triangle : left) {
        distinct.triangles.push_back(mesh.triangles[triangle]);
    }
    std::vector<TriangleMeeting> renumbered;
    const auto renumber = [&](std::span<const TriangleMeeting> some) {
        renumbered.clear();
        // The numbers ascend, so a < b still holds.
        for (const TriangleMeeting& meeting : some) {
            renumbered.push_back({left[meeting.a], left[meeting.b], meeting.meeting});
        }
        take(renumbered);
    };
    return search_self_intersections(distinct, options, renumber);
}

std::vector<TriangleMeeting> first_pairs(std::span<const TriangleMeeting> distinct,
                                         const Copies& copies, std::size_t most) {
    const auto later = [](const PairStream& x, const PairStream& y) {
        return meeting_comes_before(y.pair(), x.pair());
    };
    std::priority_queue<PairStream, std::vector<PairStream>, decltype(later)> open(later);
    std::vector<TriangleMeeting> pairs;
    // A meeting's own pair is its lowest. So a stream opens only when that pair is the next.
    std::size_t next = 0;
    while (pairs.size() < most && (next < distinct.size() || !open.empty())) {
        if (next < distinct.size() &&
            (open.empty() || meeting_comes_before(distinct[next], open.top().pair()))) {
            open.emplace(distinct[next++], copies);
        }
        PairStream stream = open.top();
        open.pop();
        pairs.push_back(stream.pair());
        if (stream.advance()) open.push(stream);
    }
    return pairs;
}

}  // namespace cdprep::mesh
