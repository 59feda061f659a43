// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace cdprep::study {

/// A count of cases, and a confidence interval for the true share.
struct ShareInterval {
    std::size_t count = 0;
    std::size_t of = 0;
    double low = 0;   ///< 0 to 1
    double high = 1;  ///< 0 to 1

    [[nodiscard]] double share() const noexcept {
        return of == 0 ? 0 : static_cast<double>(count) / static_cast<double>(of);
    }
};

/// Returns the interval of Clopper and Pearson (1934) for `count` of `of` independent cases. With
/// at least this confidence, the true share lies in [low, high]. The interval comes from the exact
/// binomial distribution. So it is valid for few cases and for counts of 0 or `of`, but somewhat
/// wide. No cases give 0 to 1. `count` must be at most `of`, and the confidence must be in (0, 1).
/// The ends are within 1e-9 of the exact ones.
[[nodiscard]] ShareInterval clopper_pearson(std::size_t count, std::size_t of,
                                            double confidence = 0.95);

}  // namespace cdprep::study
