// SPDX-License-Identifier: MIT
#include "c/pair_cache_words.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace cdprep::c {
namespace {

constexpr std::size_t kWords = sizeof(PairCache) / sizeof(std::uint64_t);
constexpr std::size_t kSeal = sizeof(cdprep_cache) / sizeof(std::uint64_t) - 1;
static_assert(sizeof(PairCache) % sizeof(std::uint64_t) == 0 && kWords <= kSeal);
static_assert(std::is_trivially_copyable_v<PairCache>);

/// Returns a checksum of the words, computed side by side so that it costs a few steps. It detects
/// words that no query wrote, such as those of another program, version or moment. It is no defence
/// against forgery.
std::uint64_t seal_of(const cdprep_cache& words) noexcept {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;
    std::array<std::uint64_t, 4> mixed = {kOdd, ~kOdd, kOdd << 1, 0x63647072U};
    for (std::size_t i = 0; i < kWords; ++i) {
        std::uint64_t& lane = mixed[i % mixed.size()];
        lane = std::rotl((lane ^ words.words[i]) * kOdd, 29);
    }
    std::uint64_t seal = 0;
    for (const std::uint64_t lane : mixed) seal = std::rotl((seal ^ lane) * kOdd, 31);
    return seal;
}

}  // namespace

PairCacheWords::PairCacheWords(cdprep_cache* words) noexcept : words_(words) {
    if (words == nullptr) return;
    cdprep_cache copy;  // the verified copy is used, even if another thread writes meanwhile
    std::memcpy(&copy, words, sizeof copy);
    if (copy.words[kSeal] != seal_of(copy)) return;
    std::memcpy(static_cast<void*>(&cache_), &copy, sizeof cache_);
}

PairCacheWords::~PairCacheWords() {
    if (words_ == nullptr) return;
    cdprep_cache copy{};
    std::memcpy(&copy, &cache_, sizeof cache_);
    copy.words[kSeal] = seal_of(copy);
    std::memcpy(words_, &copy, sizeof copy);
}

}  // namespace cdprep::c
