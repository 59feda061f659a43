// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/clash_search.h"

namespace cdprep::cli {

std::optional<ClashAnswer> ClashAsker::ask(const Pair& pair, const LayerPair& asked) {
    Pair with_options = pair;
    with_options.options.body = asked.body;
    with_options.options.overlap = asked.overlap;
    with_options.options.degenerate = question_.degenerate;
    switch (question_.effect) {
        case Ask::within:
            return within(with_options, asked.tolerance);
        case Ask::distance:
            return distance(with_options, asked.max_distance);
        default:
            return overlap(with_options);
    }
}

std::optional<ClashAnswer> ClashAsker::overlap(const Pair& pair) {
    report::PairAnswer answer;
    if (question_.lists_segments) {
        answer.crossings = lists_.crossings(pair, workspace_);
        answer.count = answer.crossings->size();
    } else if (question_.lists_pairs) {
        answer.pairs = lists_.pairs(
            [&](std::span<TrianglePair> room) { return overlaps(pair, workspace_, room); });
        answer.count = answer.pairs->size();
    } else {
        answer.count = overlaps(pair, workspace_, {});
    }
    answer.hit = *answer.count > 0;
    if (pair.options.body == Body::surface) {
        return answer.hit ? std::optional<ClashAnswer>(answer) : std::nullopt;
    }
    const Collision collision = collide(pair, workspace_);
    answer.hit = collision.hit == Answer::yes;
    answer.containment = collision.containment;
    if (collision.hit == Answer::no) return std::nullopt;
    return answer;
}

std::optional<ClashAnswer> ClashAsker::within(const Pair& pair, double tolerance) {
    report::WithinAnswer answer;
    if (question_.lists_pairs) {
        answer.pairs = lists_.pairs([&](std::span<TrianglePair> room) {
            return pairs_within(pair, tolerance, workspace_, room);
        });
        answer.count = answer.pairs->size();
    } else if (question_.counts_pairs) {
        answer.count = pairs_within(pair, tolerance, workspace_, {});
    }
    answer.within = answer.count ? *answer.count > 0 : cdprep::within(pair, tolerance, workspace_);
    if (!answer.within) return std::nullopt;
    return answer;
}

std::optional<ClashAnswer> ClashAsker::distance(const Pair& pair, double max_distance) {
    report::DistanceAnswer answer;
    answer.distance = cdprep::distance(pair, workspace_,
                                       {.relative_error = question_.relative_error,
                                        .absolute_error = question_.absolute_error,
                                        .max_distance = max_distance});
    if (!answer.distance) return std::nullopt;
    return answer;
}

}  // namespace cdprep::cli
