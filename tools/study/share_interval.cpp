// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/share_interval.h"

#include <cmath>

namespace cdprep::study {
namespace {

/// Returns the probability of `count` or more successes in `of` cases with this share.
double at_least(std::size_t count, std::size_t of, double share) {
    const auto n = static_cast<double>(of);
    double sum = 0;
    for (std::size_t i = count; i <= of; ++i) {
        const auto k = static_cast<double>(i);
        sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) +
                        k * std::log(share) + (n - k) * std::log1p(-share));
    }
    return sum;
}

/// Returns the share at which `count` or more successes have this probability. The probability
/// increases with the share.
double share_for(std::size_t count, std::size_t of, double probability) {
    double low = 0;
    double high = 1;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (at_least(count, of, middle) < probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

ShareInterval clopper_pearson(std::size_t count, std::size_t of, double confidence) {
    const double tail = 0.5 * (1 - confidence);
    ShareInterval interval{count, of, 0, 1};
    if (count > 0) interval.low = share_for(count, of, tail);
    // P(at most count) = 1 - P(at least count + 1).
    if (count < of) interval.high = share_for(count + 1, of, 1 - tail);
    return interval;
}

}  // namespace cdprep::study
