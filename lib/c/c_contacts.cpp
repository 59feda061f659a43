// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cassert>
#include <tuple>

#include "c/c_pairs.h"
#include "cdprep/contacts.h"
#include "cdprep/format/float_environment.h"

namespace cdprep::c {

template <>
struct Input<cdprep_contact_options> {
    static const InputType type;
    static cdprep_contact_options defaults() noexcept {
        cdprep_contact_options options{};
        options.most = kDefaultMost;
        return options;
    }
    static constexpr std::uint32_t kDefaultMost = 256;
};

namespace {

static_assert(CDPREP_VERTEX == static_cast<int>(FeatureKind::vertex) &&
              CDPREP_EDGE == static_cast<int>(FeatureKind::edge) &&
              CDPREP_FACE == static_cast<int>(FeatureKind::face));
static_assert(CDPREP_CONTACT_OVERLAP == static_cast<int>(contact_overlap) &&
              CDPREP_CONTACT_INTERNAL_EDGE == static_cast<int>(contact_internal_edge) &&
              CDPREP_CONTACT_FROM_BEHIND == static_cast<int>(contact_from_behind));

constexpr std::uint32_t kManifold = kMostManifoldPoints;
static_assert(sizeof(cdprep_contact::points) / sizeof(cdprep_contact_point) == kManifold);

constexpr std::array kFields = {
    Field{"manifold", offsetof(cdprep_contact_options, manifold), Holds::choice, kManifold},
    Field{"tolerance", offsetof(cdprep_contact_options, tolerance), Holds::length},
};

cdprep_feature in_c(const ContactFeature& feature) noexcept {
    return {static_cast<std::uint32_t>(feature.kind),
            feature.edge,
            feature.triangle,
            {feature.vertex, CDPREP_NONE, CDPREP_NONE}};
}

cdprep_contact in_c(const Contact& contact) noexcept {
    assert(contact.point_count <= kManifold && contact.lower <= contact.upper);
    cdprep_contact to{};
    to.piece_a = contact.piece_a;
    to.piece_b = contact.piece_b;
    to.feature_a = in_c(contact.feature_a);
    to.feature_b = in_c(contact.feature_b);
    to.flags = contact.flags;
    to.point_count = contact.point_count;
    store(contact.point_a, to.on_a);
    store(contact.point_b, to.on_b);
    store(contact.normal, to.normal);
    to.lower = contact.lower;
    to.upper = contact.upper;
    for (std::uint32_t i = 0; i < contact.point_count; ++i) {
        store(contact.points[i].on_a, to.points[i].on_a);
        store(contact.points[i].on_b, to.points[i].on_b);
        to.points[i].distance = contact.points[i].distance;
    }
    return to;
}

int read(Call& call, const cdprep_contact_options* given,
         cdprep_contact_options& options) noexcept {
    const Name name = {"options"};
    if (const int code = read_options(call, name, given, options)) return code;
    if (options.manifold == 0 || options.manifold == kManifold) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("manifold"), "is %u; it must be 0 or %u.",
                       options.manifold, kManifold);
}

/// Calls `take(contact)` for contacts in order, until it returns false or the work limit is
/// reached. Returns whether all contacts were visited.
template <class Take>
bool visit_all(const AskedPair& asked, const cdprep_contact_options& options, Workspace& scratch,
               Take&& take) noexcept {
    const ContactOptions wanted = {options.tolerance,
                                   options.manifold == 0 ? Manifold::none : Manifold::four};
    std::uint64_t seen = 0;
    const auto visit = [&](const Contact& contact) {
        if (options.work != 0 && seen == options.work) return false;
        ++seen;
        return take(in_c(contact));
    };
    return visit_contacts(asked.pair(), scratch, visit, wanted);
}

/// Compares by depth, then by pieces. Visitors call it in the caller's floating-point environment.
bool is_deeper(const cdprep_contact& x, const cdprep_contact& y) noexcept {
    const format::FloatEnvironment environment;
    return std::tie(x.lower, x.piece_a, x.piece_b) < std::tie(y.lower, y.piece_a, y.piece_b);
}

/// The deepest contacts that there is room for: a heap with the shallowest contact first.
class Deepest {
public:
    explicit Deepest(std::span<cdprep_contact> room) noexcept : room_(room) {}

    void add(const cdprep_contact& contact) noexcept {
        assert(kept_ <= room_.size() && kept_ <= count_);
        ++count_;
        if (kept_ < room_.size()) {
            room_[kept_++] = contact;
            std::push_heap(begin(), end(), is_deeper);
        } else if (kept_ > 0 && is_deeper(contact, room_[0])) {
            std::pop_heap(begin(), end(), is_deeper);
            room_[kept_ - 1] = contact;
            std::push_heap(begin(), end(), is_deeper);
        }
    }
    void sort() noexcept {
        std::sort_heap(begin(), end(), is_deeper);
    }
    [[nodiscard]] std::size_t count() const noexcept {
        return count_;
    }

private:
    cdprep_contact* begin() noexcept {
        return room_.data();
    }
    cdprep_contact* end() noexcept {
        return room_.data() + kept_;
    }
    std::span<cdprep_contact> room_;
    std::size_t kept_ = 0;
    std::size_t count_ = 0;  ///< that were added
};

}  // namespace

const InputType Input<cdprep_contact_options>::type = {"cdprep_contact_options", 0xcd500005U,
                                                       sizeof(cdprep_contact_options),
                                                       sizeof(cdprep_contact_options), kFields};

}  // namespace cdprep::c

using cdprep::Workspace;
using cdprep::c::ask_pair;
using cdprep::c::AskedPair;
using cdprep::c::Call;

void cdprep_contact_options_init(cdprep_contact_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_contacts(const cdprep_pair* pair, const cdprep_contact_options* options,
                    cdprep_workspace* workspace, cdprep_contact_list* list, cdprep_error* error) {
    cdprep_contact_options given{};
    if (list != nullptr) {
        list->complete = CDPREP_NO;
        list->reserved = 0;
    }
    return ask_pair(
        cdprep::c::kContacts, pair, workspace, list, "list", error,
        [&](Call& call) {
            if (const int code = check_list(call, {"list"}, *list)) return code;
            return cdprep::c::read(call, options, given);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            const size_t room = std::min<size_t>(list->room, given.most);
            cdprep::c::Deepest deepest({list->items, room});
            const bool all =
                cdprep::c::visit_all(asked, given, scratch, [&](const cdprep_contact& contact) {
                    deepest.add(contact);
                    return true;
                });
            deepest.sort();
            list->count = std::min<size_t>(deepest.count(), given.most);
            list->complete = cdprep::c::word(all && deepest.count() <= given.most);
        });
}

int cdprep_contacts_visit(const cdprep_pair* pair, const cdprep_contact_options* options,
                          cdprep_workspace* workspace, cdprep_contact_visitor visit, void* context,
                          cdprep_error* error) {
    cdprep_contact_options given{};
    return ask_pair(
        cdprep::c::kContacts, pair, workspace, visit, "visit", error,
        [&](Call& call) -> int {
            if (const int code = cdprep::c::read(call, options, given)) return code;
            using Options = cdprep::c::Input<cdprep_contact_options>;
            if (given.most == Options::kDefaultMost) return CDPREP_OK;
            return call.refuse(CDPREP_WHY_NO_MEANING, cdprep::c::Name{"options"}.of("most"),
                               "is %u, but the visitor ends the search; leave it at its default.",
                               given.most);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            cdprep::c::visit_all(asked, given, scratch, [&](const cdprep_contact& contact) {
                return visit(context, &contact) != 0;
            });
        });
}
