// SPDX-License-Identifier: MIT
#include "c/pair_answers.h"

#include "c/pair_cache_words.h"
#include "cdprep/distance_through.h"
#include "cdprep/overlap_through.h"
#include "cdprep/triangles_within.h"

namespace cdprep::c {
namespace {

/// Words that a bit for each triangle takes.
std::size_t words_for(const Model& model) noexcept {
    return (std::size_t{model.triangle_count()} + 63) / 64;
}

int check_words(Call& call, const Name& bits_name, const Name& words_name,
                const std::uint64_t* bits, std::size_t words, const Model& model) noexcept {
    if (words == 0) return CDPREP_OK;
    if (const int code = call.need(bits, bits_name)) return code;
    if (words >= words_for(model)) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_TOO_SMALL, words_name, "is %zu; %zu words are needed.", words,
                       words_for(model));
}

}  // namespace

cdprep_collision in_c(bool hit, const Containment& containment) noexcept {
    const std::uint32_t answer = word(containment.answer);
    const bool a_inside_b = containment.answer != Answer::no && containment.a_inside_b;
    return {hit ? word(true) : answer, answer, word(a_inside_b), 0, containment.winding};
}

cdprep_nearest in_c(const std::optional<Distance>& found) noexcept {
    cdprep_nearest to{};
    if (!found) return to;
    to.found = CDPREP_YES;
    to.triangle_a = found->triangle_a;
    to.triangle_b = found->triangle_b;
    to.lower = found->lower;
    to.upper = found->upper;
    store(found->witness_a, to.on_a);
    store(found->witness_b, to.on_b);
    return to;
}

cdprep_collision collision_of(const AskedPair& asked, Workspace& workspace) noexcept {
    if (asked.is_through_bvh()) {
        PairCacheWords cache(asked.cache);
        const Collision found =
            collide(*asked.a, *asked.b, asked.placement, workspace, asked.options, cache.get());
        return in_c(found.hit, found.containment);
    }
    const bool surfaces_touch = any_overlap_through(asked.through, *asked.a, *asked.b,
                                                    asked.placement, workspace, asked.overlap());
    if (surfaces_touch || asked.options.body == Body::surface) return in_c(surfaces_touch, {});
    return in_c(false, find_containment(*asked.a, *asked.b, asked.placement, workspace));
}

std::size_t list_overlaps(const AskedPair& asked, Workspace& workspace,
                          std::span<TrianglePair> room) noexcept {
    if (!asked.is_through_bvh()) {
        return overlapping_triangles_through(asked.through, *asked.a, *asked.b, asked.placement,
                                             workspace, room, asked.overlap());
    }
    PairCacheWords cache(asked.cache);
    return overlapping_triangles(*asked.a, *asked.b, asked.placement, workspace, room,
                                 asked.overlap(), cache.get());
}

std::size_t mark_overlaps(const AskedPair& asked, Workspace& workspace,
                          const cdprep_marks& marks) noexcept {
    PairCacheWords cache(asked.cache);
    return mark_overlapping_triangles(*asked.a, *asked.b, asked.placement, workspace,
                                      {marks.bits_a, marks.words_a}, {marks.bits_b, marks.words_b},
                                      asked.overlap(), cache.get());
}

cdprep_nearest nearest_of(const AskedPair& asked, const cdprep_distance_options& options,
                          Workspace& workspace) noexcept {
    const DistanceOptions wanted = {options.relative_error, options.absolute_error,
                                    options.max_distance, asked.options.body};
    if (!asked.is_through_bvh()) {
        return in_c(distance_through(asked.through, *asked.a, *asked.b, asked.placement, workspace,
                                     wanted));
    }
    PairCacheWords cache(asked.cache);
    return in_c(distance(*asked.a, *asked.b, asked.placement, workspace, wanted, cache.get()));
}

bool is_pair_within(const AskedPair& asked, double tolerance, Workspace& workspace) noexcept {
    if (!asked.is_through_bvh()) {
        return is_within_through(asked.through, *asked.a, *asked.b, asked.placement, tolerance,
                                 workspace);
    }
    PairCacheWords cache(asked.cache);
    return is_within(*asked.a, *asked.b, asked.placement, tolerance, workspace, cache.get());
}

std::size_t list_pairs_within(const AskedPair& asked, double tolerance, Workspace& workspace,
                              std::span<TrianglePair> room) noexcept {
    const WithinOptions options = {asked.options.degenerate};
    if (!asked.is_through_bvh()) {
        return triangles_within_through(asked.through, *asked.a, *asked.b, asked.placement,
                                        tolerance, workspace, room, options);
    }
    return triangles_within(*asked.a, *asked.b, asked.placement, tolerance, workspace, room,
                            options);
}

int check_marks(Call& call, const Name& name, const cdprep_marks& marks,
                const AskedPair& asked) noexcept {
    if (const int code = check_words(call, name.of("bits_a"), name.of("words_a"), marks.bits_a,
                                     marks.words_a, *asked.a)) {
        return code;
    }
    return check_words(call, name.of("bits_b"), name.of("words_b"), marks.bits_b, marks.words_b,
                       *asked.b);
}

}  // namespace cdprep::c
