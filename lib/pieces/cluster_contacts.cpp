// SPDX-License-Identifier: MIT
#include "pieces/cluster_contacts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "pieces/choose_four.h"

namespace cdprep {
namespace {

class Clusters {
public:
    Clusters(std::span<Contact> contacts, double angle) noexcept
        : contacts_(contacts), least_(std::cos(std::min(angle, std::numbers::pi))) {
        assert(contacts.size() <= kMostListedContacts);
    }

    [[nodiscard]] std::size_t join() noexcept {
        std::size_t kept = 0;
        for (std::size_t first = 0; first < contacts_.size(); ++first) {
            if (is_taken_[first]) continue;
            gather(first);
            Contact cluster = contacts_[first];
            cluster.members = static_cast<std::uint32_t>(members_);
            // Which member is the deepest may change from frame to frame: the smallest id does not.
            for (std::size_t m = 0; m < members_; ++m) {
                cluster.id = std::min(cluster.id, contacts_[member_[m]].id);
            }
            choose_four(points_of_members(), cluster);
            contacts_[kept++] = cluster;
        }
        return kept;
    }

private:
    /// Sets member_ to the contacts that belong to the cluster of `first`. Each shares a piece with
    /// one before it.
    void gather(std::size_t first) noexcept {
        members_ = 0;
        take(first);
        for (std::size_t next = 0; next < members_; ++next) {
            const Contact& near = contacts_[member_[next]];
            for (std::size_t i = first + 1; i < contacts_.size(); ++i) {
                const Contact& other = contacts_[i];
                const bool share = other.piece_a == near.piece_a || other.piece_b == near.piece_b;
                if (is_taken_[i] || !share || kind(other) != kind(near)) continue;
                if (dot(other.normal, contacts_[first].normal) >= least_) take(i);
            }
        }
    }
    static std::uint32_t kind(const Contact& contact) noexcept {
        return contact.flags & (contact_from_behind | contact_deep);
    }
    void take(std::size_t i) noexcept {
        is_taken_[i] = true;
        member_[members_++] = i;
    }

    std::span<const ManifoldPoint> points_of_members() noexcept {
        std::size_t count = 0;
        for (std::size_t m = 0; m < members_; ++m) {
            const Contact& contact = contacts_[member_[m]];
            const auto add = [&](ManifoldPoint point) {
                point.id = mixed_ids(contact.id, point.id);
                points_[count++] = point;
            };
            if (contact.point_count == 0) add(only_point(contact));
            for (std::uint32_t i = 0; i < contact.point_count; ++i) add(contact.points[i]);
        }
        return std::span(points_).first(count);
    }

    std::span<Contact> contacts_;
    double least_;  ///< the cosine of the largest angle between two normals
    std::size_t members_ = 0;
    std::array<bool, kMostListedContacts> is_taken_{};
    std::array<std::size_t, kMostListedContacts> member_;
    std::array<ManifoldPoint, kMostManifoldPoints * kMostListedContacts> points_;
};

}  // namespace

std::size_t cluster_contacts(std::span<Contact> contacts, double angle) noexcept {
    return Clusters(contacts, angle).join();
}

}  // namespace cdprep
