// SPDX-License-Identifier: MIT
#include "c/c_contacts.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "c/c_pairs.h"
#include "cdprep/format/float_environment.h"
#include "pieces/list_contacts.h"

namespace cdprep::c {
namespace {

static_assert(CDPREP_VERTEX == static_cast<int>(FeatureKind::vertex) &&
              CDPREP_EDGE == static_cast<int>(FeatureKind::edge) &&
              CDPREP_FACE == static_cast<int>(FeatureKind::face));
static_assert(CDPREP_CONTACT_OVERLAP == static_cast<int>(contact_overlap) &&
              CDPREP_CONTACT_INTERNAL_EDGE == static_cast<int>(contact_internal_edge) &&
              CDPREP_CONTACT_FROM_BEHIND == static_cast<int>(contact_from_behind) &&
              CDPREP_CONTACT_DEEP == static_cast<int>(contact_deep));

constexpr std::uint32_t kManifold = kMostManifoldPoints;
static_assert(sizeof(cdprep_contact::points) / sizeof(cdprep_contact_point) == kManifold);

constexpr std::array kFields = {
    Field{"manifold", offsetof(cdprep_contact_options, manifold), Holds::choice, kManifold},
    Field{"tolerance", offsetof(cdprep_contact_options, tolerance), Holds::length},
    Field{"cluster_angle", offsetof(cdprep_contact_options, cluster_angle), Holds::length},
};

cdprep_feature as_c(const ContactFeature& feature) noexcept {
    return {static_cast<std::uint32_t>(feature.kind),
            feature.edge,
            feature.triangle,
            {feature.vertex, CDPREP_NONE, CDPREP_NONE}};
}

/// Refuses options that a visitor does not use.
int refuse_unused(Call& call, const cdprep_contact_options& options) noexcept {
    const Name name = {"options"};
    if (options.most != Input<cdprep_contact_options>::defaults().most) {
        return call.refuse(CDPREP_WHY_NO_MEANING, name.of("most"),
                           "is %u, but the visitor ends the search; leave it at its default.",
                           options.most);
    }
    if (options.cluster_angle != 0) {
        return call.refuse(CDPREP_WHY_NO_MEANING, name.of("cluster_angle"),
                           "is %g, but a visitor gets each contact; leave it at its default.",
                           options.cluster_angle);
    }
    return CDPREP_OK;
}

void answer(const ListedContacts& listed, cdprep_contact_list& list) noexcept {
    const ContactsVerdict& verdict = listed.verdict;
    list.count = listed.contacts.size();
    list.complete = word(verdict.complete);
    list.searched = word(verdict.searched);
    list.found = verdict.found;
    list.computed = verdict.computed;
    list.work = verdict.work;
    const std::size_t stored = std::min(list.count, list.room);
    for (std::size_t i = 0; i < stored; ++i) list.items[i] = in_c(listed.contacts[i]);
}

}  // namespace

cdprep_contact_options Input<cdprep_contact_options>::defaults() noexcept {
    cdprep_contact_options options{};
    options.most = kMostListedContacts;
    return options;
}

int read_contact_options(Call& call, const Name& name, const cdprep_contact_options* given,
                         cdprep_contact_options& options) noexcept {
    if (const int code = read_options(call, name, given, options)) return code;
    if (options.manifold != 0 && options.manifold != kManifold) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("manifold"),
                           "is %u; it must be 0 or %u.", options.manifold, kManifold);
    }
    if (options.most == 0 || options.most > kMostListedContacts) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("most"), "is %u; it must be 1 to %u.",
                           options.most, kMostListedContacts);
    }
    return CDPREP_OK;
}

ContactOptions in_cpp(const cdprep_contact_options& options) noexcept {
    return {options.tolerance, options.manifold == 0 ? Manifold::none : Manifold::four,
            options.most, options.work, options.cluster_angle};
}

cdprep_contact in_c(const Contact& contact) noexcept {
    assert(contact.point_count <= kManifold && contact.lower <= contact.upper);
    cdprep_contact to{};
    to.piece_a = contact.piece_a;
    to.piece_b = contact.piece_b;
    to.id = contact.id;
    to.members = contact.members;
    to.feature_a = as_c(contact.feature_a);
    to.feature_b = as_c(contact.feature_b);
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
        to.points[i].id = contact.points[i].id;
    }
    return to;
}

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
        list->complete = list->searched = CDPREP_NO;
        list->found = list->computed = list->work = 0;
    }
    return ask_pair(
        cdprep::c::kContacts, pair, workspace, list, "list", error,
        [&](Call& call) {
            if (const int code = check_list(call, {"list"}, *list)) return code;
            return read_contact_options(call, {"options"}, options, given);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            const cdprep::format::FloatEnvironment environment;
            cdprep::c::answer(
                cdprep::list_contacts(asked.pair(), scratch, cdprep::c::in_cpp(given)), *list);
        });
}

int cdprep_contacts_visit(const cdprep_pair* pair, const cdprep_contact_options* options,
                          cdprep_workspace* workspace, cdprep_contact_visitor visit, void* context,
                          cdprep_error* error) {
    cdprep_contact_options given{};
    return ask_pair(
        cdprep::c::kContacts, pair, workspace, visit, "visit", error,
        [&](Call& call) -> int {
            if (const int code = read_contact_options(call, {"options"}, options, given))
                return code;
            return cdprep::c::refuse_unused(call, given);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            const auto take = [&](const cdprep::Contact& contact) {
                const cdprep_contact told = cdprep::c::in_c(contact);
                return visit(context, &told) != 0;
            };
            cdprep::visit_contacts(asked.pair(), scratch, take, cdprep::c::in_cpp(given));
        });
}
