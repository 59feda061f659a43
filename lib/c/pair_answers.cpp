// SPDX-License-Identifier: MIT
#include "c/pair_answers.h"

#include <algorithm>
#include <cassert>

#include "c/pair_cache_words.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"

namespace cdprep::c {
namespace {

/// Returns the number of words with a bit for each triangle.
std::size_t words_for(const Model& model) noexcept {
    return (std::size_t{model.triangle_number_bound()} + 63) / 64;
}

int check_words(Call& call, const Name& bits_name, const Name& words_name,
                const std::uint64_t* bits, std::size_t words, const Model& model) noexcept {
    if (words == 0) return CDPREP_OK;
    if (const int code = call.need(bits, bits_name)) return code;
    if (words >= words_for(model)) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_TOO_SMALL, words_name, "is %zu; %zu words are needed.", words,
                       words_for(model));
}

static_assert(CDPREP_IMPACT_NONE == static_cast<int>(ImpactKind::none) &&
              CDPREP_IMPACT_TOUCHING == static_cast<int>(ImpactKind::touching) &&
              CDPREP_IMPACT_NEAR == static_cast<int>(ImpactKind::near) &&
              CDPREP_IMPACT_UNFINISHED == static_cast<int>(ImpactKind::unfinished));

}  // namespace

cdprep_collision in_c(bool hit, const Containment& containment) noexcept {
    const std::uint32_t answer = word(containment.answer);
    const bool a_inside_b = containment.answer != Answer::no && containment.a_inside_b;
    return {hit ? word(true) : answer, answer, word(a_inside_b), 0, containment.winding};
}

cdprep_nearest in_c(const std::optional<Distance>& found) noexcept {
    cdprep_nearest to{};
    if (!found) return to;
    assert(found->lower <= found->upper);
    to.found = CDPREP_YES;
    to.triangle_a = found->triangle_a;
    to.triangle_b = found->triangle_b;
    to.lower = found->lower;
    to.upper = found->upper;
    store(found->witness_a, to.on_a);
    store(found->witness_b, to.on_b);
    return to;
}

cdprep_bounded in_c(const BoundedDistance& found) noexcept {
    const format::FloatEnvironment environment;
    const double lower = std::min(found.lower, format::kMaxCoordinate);
    return {word(found.is_complete), 0, found.work, lower, in_c(found.nearest)};
}

cdprep_impact in_c(const Impact& impact) noexcept {
    return {static_cast<std::uint32_t>(impact.kind), impact.steps, impact.lower, impact.upper,
            in_c(impact.nearest)};
}

DistanceOptions in_cpp(const cdprep_distance_options& options) noexcept {
    return {options.relative_error, options.absolute_error, options.max_distance};
}

cdprep_collision collision_of(const AskedPair& asked, Workspace& workspace) noexcept {
    PairCacheWords cache(asked.cache);
    const Collision found = collide(asked.with(cache), workspace);
    return in_c(found.hit == Answer::yes, found.containment);
}

std::size_t list_overlaps(const AskedPair& asked, Workspace& workspace,
                          std::span<TrianglePair> room) noexcept {
    PairCacheWords cache(asked.cache);
    return overlaps(asked.with(cache), workspace, room);
}

std::size_t mark_overlaps(const AskedPair& asked, Workspace& workspace,
                          const cdprep_marks& marks) noexcept {
    PairCacheWords cache(asked.cache);
    return mark_overlaps(asked.with(cache), workspace, {marks.bits_a, marks.words_a},
                         {marks.bits_b, marks.words_b});
}

cdprep_nearest nearest_of(const AskedPair& asked, const cdprep_distance_options& options,
                          Workspace& workspace) noexcept {
    PairCacheWords cache(asked.cache);
    PairFrontWords front(asked.front);
    return in_c(distance(asked.with(cache, front), workspace, in_cpp(options)));
}

bool is_pair_within(const AskedPair& asked, double tolerance, Workspace& workspace) noexcept {
    PairCacheWords cache(asked.cache);
    PairFrontWords front(asked.front);
    return within(asked.with(cache, front), tolerance, workspace);
}

std::size_t list_pairs_within(const AskedPair& asked, double tolerance, Workspace& workspace,
                              std::span<TrianglePair> room) noexcept {
    return pairs_within(asked.pair(), tolerance, workspace, room);
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
