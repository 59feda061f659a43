// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace cdprep::study {

/// So many of so many, and between which shares the true share lies.
struct ShareInterval {
    std::size_t count = 0;
    std::size_t of = 0;
    double low = 0;   ///< 0 to 1
    double high = 1;  ///< 0 to 1

    [[nodiscard]] double share() const noexcept {
        return of == 0 ? 0 : static_cast<double>(count) / static_cast<double>(of);
    }
};

/// The interval of Clopper and Pearson (1934): with at least this confidence the share, of
/// which `count` of `of` independent cases are a sample, lies between `low` and `high`, ends
/// included. From the binomial distribution itself, so right for few cases and for none at
/// all of them; somewhat wide. Of no cases: 0 to 1. `count` is at most `of`, and the
/// confidence in (0, 1). Within 1e-9 of the exact ends.
[[nodiscard]] ShareInterval clopper_pearson(std::size_t count, std::size_t of,
                                            double confidence = 0.95);

}  // namespace cdprep::study
