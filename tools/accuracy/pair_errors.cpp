// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/pair_errors.h"

#include <vector>

#include "study/seeded_random.h"
#include "study/timing.h"

namespace cdprep::study {
namespace {

constexpr std::size_t kResamples = 1000;
constexpr std::uint64_t kSeed = 0x9a175;

double share_of(std::size_t part, std::size_t whole, double without) {
    return whole == 0 ? without : static_cast<double>(part) / static_cast<double>(whole);
}

double recall_of(const PairCounts& counts) {
    return share_of(counts.both, counts.wanted, 1);
}

double precision_of(const PairCounts& counts) {
    return share_of(counts.both, counts.found, 1);
}

double wrong_of(const PairCounts& counts) {
    const std::size_t either = counts.wanted + counts.found - counts.both;
    return share_of(either - counts.both, either, 0);
}

void add(const PairCounts& counts, PairCounts& sum) {
    sum.wanted += counts.wanted;
    sum.found += counts.found;
    sum.both += counts.both;
}

ShareBand band_of(double share, const std::vector<double>& drawn) {
    return {share, quantile(drawn, 0.025), quantile(drawn, 0.975)};
}

}  // namespace

PairErrors pair_errors(std::span<const PairCounts> by_pose) {
    PairErrors errors;
    for (const PairCounts& counts : by_pose) add(counts, errors.all);
    SeededRandom random(kSeed);
    std::vector<double> recalls;
    std::vector<double> precisions;
    std::vector<double> wrongs;
    for (std::size_t i = 0; i < kResamples; ++i) {
        PairCounts drawn;
        for (std::size_t k = 0; k < by_pose.size(); ++k) {
            add(by_pose[random.below(by_pose.size())], drawn);
        }
        recalls.push_back(recall_of(drawn));
        precisions.push_back(precision_of(drawn));
        wrongs.push_back(wrong_of(drawn));
    }
    errors.recall = band_of(recall_of(errors.all), recalls);
    errors.precision = band_of(precision_of(errors.all), precisions);
    errors.wrong = band_of(wrong_of(errors.all), wrongs);
    return errors;
}

}  // namespace cdprep::study
