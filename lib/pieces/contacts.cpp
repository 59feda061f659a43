// SPDX-License-Identifier: MIT
#include "cdprep/contacts.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "pieces/contact_steps.h"
#include "walk/contact_pairs.h"
#include "walk/near_triangles.h"

// Pairs of triangles within the tolerance show which pieces are within it. A pair of pieces occurs
// once for each such pair of triangles. A walk keeps the smallest pairs of pieces, each once, as
// many as there is room for. With each it keeps the first pair of triangles, a touching one if
// there is any. If there are more pairs of pieces, another walk takes the next ones. So the answers
// come in order, and memory does not grow with their number.

namespace cdprep {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The smallest pairs of pieces above those that were answered before.
class Gathered {
public:
    explicit Gathered(std::span<NearPieces> room) noexcept : room_(room) {}

    /// Forgets all, and from now on takes only keys after `last`.
    void begin_after(const std::optional<std::uint64_t>& last) noexcept {
        count_ = 0;
        limit_ = kNoLimit;
        least_ = last ? *last + 1 : 0;
    }
    [[nodiscard]] bool takes(std::uint64_t key) const noexcept {
        return key >= least_ && key <= limit_;
    }
    void add(const NearPieces& near) noexcept {
        room_[count_++] = near;
        if (count_ == room_.size()) reduce(room_.size() / 2);
    }
    /// Returns all that were taken, in order, each once.
    [[nodiscard]] std::span<const NearPieces> all() noexcept {
        reduce(room_.size());
        return room_.first(count_);
    }
    /// Returns whether greater keys were left out.
    [[nodiscard]] bool is_limited() const noexcept {
        return limit_ != kNoLimit;
    }

private:
    void reduce(std::size_t most) noexcept {
        const auto begin = room_.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(count_);
        std::sort(begin, end, [](const NearPieces& x, const NearPieces& y) {
            if (x.key != y.key) return x.key < y.key;
            if (x.touch != y.touch) return x.touch;
            return x.a != y.a ? x.a < y.a : x.b < y.b;
        });
        const auto last = std::unique(
            begin, end, [](const NearPieces& x, const NearPieces& y) { return x.key == y.key; });
        count_ = static_cast<std::size_t>(last - begin);
        if (count_ <= most) return;
        count_ = most;
        limit_ = room_[count_ - 1].key;
    }

    std::span<NearPieces> room_;
    std::size_t count_ = 0;
    std::uint64_t limit_ = kNoLimit;  ///< greater ones are not taken
    std::uint64_t least_ = 0;
};

class ContactSearch {
public:
    ContactSearch(const Pair& pair, Workspace& workspace, const ContactOptions& options) noexcept
        : pair_(pair),
          moved_a_(moved_a(pair.a, pair.placement)),
          moved_b_(moved_b(pair.b, pair.placement)),
          options_(options),
          workspace_(workspace),
          gathered_(workspace.storage().near_pieces) {}

    /// Calls `found` for each contact in order until it returns false; returns false when it did.
    template <class Found>
    bool run(Found&& found) noexcept {
        const ContactQuestion question = {&pair_.placement, options_, pair_.options.degenerate,
                                          workspace_.storage().counts};
        std::optional<ContactSide> a;
        std::optional<std::uint64_t> last;
        do {
            gather(last);
            for (const NearPieces& near : gathered_.all()) {
                const auto piece_a = static_cast<std::uint32_t>(near.key >> 32);
                if (!a || !last || *last >> 32 != piece_a) a.emplace(moved_a_, piece_a);
                const ContactSide b(moved_b_, static_cast<std::uint32_t>(near.key));
                if (!found(contact_of_pieces(*a, b, near, question))) return false;
                last = near.key;
            }
        } while (gathered_.is_limited());
        return true;
    }

private:
    void gather(const std::optional<std::uint64_t>& last) noexcept {
        gathered_.begin_after(last);
        const std::span<const std::uint32_t> piece_a = moved_a_.model->pieces().of_triangle;
        const std::span<const std::uint32_t> piece_b = moved_b_.model->pieces().of_triangle;
        const auto visit = [&](const NearTriangles& near) {
            const std::uint64_t key = std::uint64_t{piece_a[near.a]} << 32 | piece_b[near.b];
            if (gathered_.takes(key)) gathered_.add({key, near.a, near.b, touch(near)});
            return true;
        };
        visit_near_triangles(pair_.options.through, pair_.a, pair_.b, pair_.placement,
                             options_.tolerance, workspace_, visit, pair_.options);
    }
    [[nodiscard]] bool touch(const NearTriangles& near) const noexcept {
        if (near.touch != Touch::unknown) return near.touch == Touch::yes;
        return in_contact(moved_a_.corners(near.a), moved_b_.corners(near.b), Overlap::closed,
                          workspace_.storage().counts);
    }

    const Pair& pair_;
    MovedModel moved_a_;
    MovedModel moved_b_;
    ContactOptions options_;
    Workspace& workspace_;
    Gathered gathered_;
};

}  // namespace

std::size_t contacts(const Pair& pair, Workspace& workspace, std::span<Contact> room,
                     const ContactOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(pair.a, pair.b, Ask::contacts | ask_of(pair.options.through));
    std::size_t count = 0;
    ContactSearch(pair, workspace, options).run([&](const Contact& contact) {
        if (count < room.size()) room[count] = contact;
        ++count;
        return true;
    });
    return count;
}

bool visit_contacts(const Pair& pair, Workspace& workspace, ContactVisitor visit,
                    const ContactOptions& options) noexcept {
    format::FloatEnvironment environment;
    require(pair.a, pair.b, Ask::contacts | ask_of(pair.options.through));
    return ContactSearch(pair, workspace, options).run([&](const Contact& contact) {
        return environment.outside([&] { return visit(contact); });
    });
}

}  // namespace cdprep
