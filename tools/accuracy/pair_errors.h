// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

namespace cdprep::study {

/// A share, 0 to 1, and between which it lies with 95 % confidence.
struct ShareBand {
    double share = 0;
    double low = 0;
    double high = 0;
};

/// Two sets of pairs of triangles against each other: what is wanted and what was found.
struct PairCounts {
    std::size_t wanted = 0;  ///< pairs of the exact set
    std::size_t found = 0;
    std::size_t both = 0;

    friend bool operator==(const PairCounts&, const PairCounts&) = default;
};

/// The same over many poses.
struct PairErrors {
    PairCounts all;       ///< the sums
    ShareBand recall;     ///< of the wanted pairs those that were found; 1 where none is wanted
    ShareBand precision;  ///< of the found pairs those that are wanted; 1 where none was found
    ShareBand wrong;      ///< missing or too many, of the pairs in either set; 0 without any
};

/// The errors of all poses together. Pairs of one pose are right or wrong together, so poses
/// are what is drawn again: a bootstrap of a thousand, by percentiles, from a fixed seed. Where
/// all poses err alike, and so where none errs, the band is a point; no more is known of poses
/// that were not asked.
[[nodiscard]] PairErrors pair_errors(std::span<const PairCounts> by_pose);

}  // namespace cdprep::study
