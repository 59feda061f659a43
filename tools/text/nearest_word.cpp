// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/nearest_word.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cdprep::report {
namespace {

/// Returns the optimal string alignment distance: the Damerau-Levenshtein distance in which no
/// part is edited twice.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(last);
        last.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t wrong = a[i - 1] == b[j - 1] ? 0 : 1;
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + wrong});
            const bool is_exchange = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (is_exchange) row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

}  // namespace

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
    constexpr std::size_t kShortest = 3;  // every word is near one of one or two letters
    if (word.size() < kShortest) return "";
    std::size_t nearest = std::max<std::size_t>(word.size() / 3, 1) + 1;
    std::string_view best;
    for (const std::string& candidate : candidates) {
        const std::size_t mistakes = distance(word, candidate);
        if (mistakes >= nearest) continue;
        nearest = mistakes;
        best = candidate;
    }
    return best.empty() ? "" : " Did you mean '" + std::string(best) + "'?";
}

}  // namespace cdprep::report
