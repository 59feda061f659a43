// SPDX-License-Identifier: MIT
#include "c_face.h"

#include "cdprep/contacts.h"
#include "cdprep/model_pieces.h"

namespace cdprep {
namespace {

static_assert(CDPREP_VERTEX == static_cast<int>(FeatureKind::vertex) &&
              CDPREP_EDGE == static_cast<int>(FeatureKind::edge) &&
              CDPREP_FACE == static_cast<int>(FeatureKind::face));
static_assert(CDPREP_CONTACT_OVERLAP == static_cast<int>(contact_overlap) &&
              CDPREP_CONTACT_INTERNAL_EDGE == static_cast<int>(contact_internal_edge) &&
              CDPREP_CONTACT_FROM_BEHIND == static_cast<int>(contact_from_behind));
static_assert(CDPREP_MOST_MANIFOLD_POINTS == kMostManifoldPoints);

std::uint32_t word(FeatureKind kind) noexcept {
    return static_cast<std::uint32_t>(kind);
}

cdprep_contact_feature feature_of(const ContactFeature& feature) noexcept {
    return {word(feature.kind), feature.edge, feature.triangle, feature.vertex};
}

cdprep_piece_contact contact_of(const PieceContact& contact) noexcept {
    cdprep_piece_contact to{};
    to.piece_a = contact.piece_a;
    to.piece_b = contact.piece_b;
    to.feature_a = feature_of(contact.feature_a);
    to.feature_b = feature_of(contact.feature_b);
    store(contact.point_a, to.point_a);
    store(contact.point_b, to.point_b);
    store(contact.normal, to.normal);
    to.lower = contact.lower;
    to.upper = contact.upper;
    to.flags = contact.flags;
    to.point_count = contact.point_count;
    for (std::uint32_t i = 0; i < contact.point_count; ++i) {
        store(contact.points[i].on_a, to.points[i].on_a);
        store(contact.points[i].on_b, to.points[i].on_b);
        to.points[i].distance = contact.points[i].distance;
    }
    return to;
}

ContactOptions options_of(const cdprep_piece_contact_options& given) noexcept {
    ContactOptions options;
    if (given.manifold == CDPREP_FOUR_POINTS) options.manifold = Manifold::four;
    if (given.degenerate == CDPREP_SKIP_DEGENERATE) options.degenerate = Degenerate::skip;
    return options;
}

/// Calls `take(contact)` with every contact until it returns false.
template <class Take>
int ask_contacts(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
                 cdprep_workspace* workspace, double tolerance,
                 const cdprep_piece_contact_options* options, cdprep_error* error,
                 Take take) noexcept {
    cdprep_piece_contact_options given{};
    if (!read_sized(options, given)) return bad_size(error);
    return ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            const auto visit = [&](const PieceContact& contact) { return take(contact); };
            visit_contacts(ma, mb, placed, tolerance, scratch, visit, options_of(given));
            return CDPREP_OK;
        });
}

/// Whether it is one of its model's, which has what is asked of it.
bool is_piece(const cdprep_piece& piece) noexcept {
    if (piece.model == nullptr) return false;
    const Model& model = piece.model->model;
    return piece.number < model.pieces().size() &&
           model.piece_adjacency().size() == model.piece_facets().size();
}

/// The vertices that a feature of a piece's hull is made of, in the imported mesh.
cdprep_hull_feature feature_of(const cdprep_piece& piece, const FeatureHull& hull,
                               const HullFeature& feature) noexcept {
    cdprep_hull_feature to = {word(feature.kind), {UINT32_MAX, UINT32_MAX, UINT32_MAX}};
    const auto source = piece.model->model.source_vertex();
    const auto vertex_of = [&](std::uint32_t corner) {
        const std::uint32_t vertex = hull.points.corners[corner];
        return source.empty() ? vertex : source[vertex];
    };
    const bool is_edge = feature.kind == FeatureKind::edge;
    if (feature.kind == FeatureKind::vertex) {
        to.vertex[0] = vertex_of(feature.number);
    } else if (hull.facets.empty()) {
        for (std::uint32_t i = 0; i < hull.points.count; ++i) to.vertex[i] = vertex_of(i);
    } else {
        const std::uint32_t first = is_edge ? feature.number % 3 : 0;
        const auto& corner = hull.facets[is_edge ? feature.number / 3 : feature.number].corner;
        for (std::uint32_t i = 0; i < (is_edge ? 2U : 3U); ++i) {
            to.vertex[i] = vertex_of(corner[(first + i) % 3]);
        }
    }
    return to;
}

FeatureCache cache_of(const cdprep_feature_cache& from) noexcept {
    const auto kind = [](std::uint32_t word) { return static_cast<FeatureKind>(word % 3); };
    const auto& words = from.words;
    return {words[0] != 0, {kind(words[1]), kind(words[2])}, {words[3], words[4]}};
}

cdprep_feature_cache words_of(const FeatureCache& cache) noexcept {
    return {{cache.is_set ? 1U : 0U, word(cache.kind[0]), word(cache.kind[1]), cache.edge[0],
             cache.edge[1]}};
}

}  // namespace
}  // namespace cdprep

int cdprep_contacts(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
                    cdprep_workspace* workspace, double tolerance,
                    const cdprep_piece_contact_options* options, cdprep_piece_contact* contacts,
                    size_t room, size_t* count, cdprep_error* error) {
    if (count == nullptr || (contacts == nullptr && room > 0)) return cdprep::null_argument(error);
    std::size_t found = 0;
    const int code = cdprep::ask_contacts(a, b, placement, workspace, tolerance, options, error,
                                          [&](const cdprep::PieceContact& contact) {
                                              if (found++ < room)
                                                  contacts[found - 1] = cdprep::contact_of(contact);
                                              return true;
                                          });
    if (code == CDPREP_OK) *count = found;
    return code;
}

int cdprep_visit_contacts(const cdprep_model* a, const cdprep_model* b,
                          const cdprep_placement* placement, cdprep_workspace* workspace,
                          double tolerance, const cdprep_piece_contact_options* options,
                          cdprep_piece_contact_visitor visit, void* context, cdprep_error* error) {
    if (visit == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_contacts(a, b, placement, workspace, tolerance, options, error,
                                [&](const cdprep::PieceContact& contact) {
                                    const cdprep_piece_contact found = cdprep::contact_of(contact);
                                    return visit(context, &found) != 0;
                                });
}

size_t cdprep_piece_count(const cdprep_model* model) {
    return model == nullptr ? 0 : model->model.pieces().size();
}

int cdprep_find_closest_features(const cdprep_piece* a, const cdprep_piece* b,
                                 const cdprep_placement* placement, cdprep_feature_cache* cache,
                                 int* found, cdprep_closest_features* features,
                                 cdprep_error* error) {
    if (cdprep::any_null(a, b, placement, found, features)) return cdprep::null_argument(error);
    if (!cdprep::is_piece(*a) || !cdprep::is_piece(*b)) {
        return cdprep::fail(error, CDPREP_BAD_ARGUMENT,
                            "A piece is none of its model: take a number below "
                            "cdprep_piece_count() of one baked with the effect contacts.");
    }
    return cdprep::guarded(error, [&]() -> int {
        std::optional<cdprep::Placement> placed;
        if (const int code = cdprep::read_placement(*placement, placed, error)) return code;
        const cdprep::FeatureHull of_a = cdprep::feature_hull(a->model->model, a->number);
        const cdprep::FeatureHull of_b = cdprep::feature_hull(b->model->model, b->number);
        cdprep::FeatureCache used;
        if (cache != nullptr) used = cdprep::cache_of(*cache);
        const auto result =
            cdprep::closest_features(of_a, of_b, *placed, cache == nullptr ? nullptr : &used);
        if (cache != nullptr) *cache = cdprep::words_of(used);
        *found = result ? 1 : 0;
        *features = {};
        if (!result) return CDPREP_OK;
        features->a = cdprep::feature_of(*a, of_a, result->a);
        features->b = cdprep::feature_of(*b, of_b, result->b);
        features->lower = result->lower;
        features->upper = result->upper;
        cdprep::store(result->witness_a, features->witness_a);
        cdprep::store(result->witness_b, features->witness_b);
        features->parallel = result->parallel ? 1 : 0;
        return CDPREP_OK;
    });
}
