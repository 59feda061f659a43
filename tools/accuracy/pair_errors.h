// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

namespace cdprep::study {

/// A share, 0 to 1, and its interval with 95 % confidence.
struct ShareBand {
    double share = 0;
    double low = 0;
    double high = 0;
};

/// The comparison of two sets of triangle pairs: the wanted pairs and the found pairs.
struct PairCounts {
    std::size_t wanted = 0;  ///< pairs of the exact set
    std::size_t found = 0;
    std::size_t both = 0;

    friend bool operator==(const PairCounts&, const PairCounts&) = default;
};

/// The errors in the pairs of many poses.
struct PairErrors {
    PairCounts all;       ///< the sums
    ShareBand recall;     ///< the share of the wanted pairs that were found; 1 if none is wanted
    ShareBand precision;  ///< the share of the found pairs that are wanted; 1 if none was found
    ShareBand wrong;      ///< missing or extra pairs, of the pairs in either set; 0 without pairs
};

/// Returns the errors of all poses together. Errors of pairs in one pose are correlated, so the
/// bootstrap resamples poses: a thousand times, with percentiles, from a fixed seed. If all poses
/// err alike, and so if none errs, the band is a point. This proves nothing about other poses.
[[nodiscard]] PairErrors pair_errors(std::span<const PairCounts> by_pose);

}  // namespace cdprep::study
