// SPDX-License-Identifier: MIT
#include "c/pair_cache_words.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <type_traits>

namespace cdprep::c {
namespace {

constexpr std::size_t kWords = sizeof(PairCache) / sizeof(std::uint64_t);
constexpr std::size_t kSeal = sizeof(cdprep_cache) / sizeof(std::uint64_t) - 1;
static_assert(sizeof(PairCache) % sizeof(std::uint64_t) == 0 && kWords <= kSeal);
static_assert(std::is_trivially_copyable_v<PairCache>);

/// A checksum of words, computed side by side so that it costs a few steps. It detects words that
/// no query wrote, such as those of another program, version or moment. It is no defence against
/// forgery.
class Seal {
public:
    void add(const std::uint64_t* words, std::size_t count) noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            std::uint64_t& lane = mixed_[i % mixed_.size()];
            lane = std::rotl((lane ^ words[i]) * kOdd, 29);
        }
    }
    [[nodiscard]] std::uint64_t value() const noexcept {
        std::uint64_t seal = 0;
        for (const std::uint64_t lane : mixed_) seal = std::rotl((seal ^ lane) * kOdd, 31);
        return seal;
    }

private:
    static constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;
    std::array<std::uint64_t, 4> mixed_ = {kOdd, ~kOdd, kOdd << 1, 0x63647072U};
};

std::uint64_t seal_of(const cdprep_cache& words) noexcept {
    Seal seal;
    seal.add(words.words, kWords);
    return seal.value();
}

/// The words of a C front begin as a C++ one, and the last one is the seal.
constexpr std::size_t kFrontSeal = sizeof(cdprep_front) / sizeof(std::uint64_t) - 1;
static_assert(sizeof(PairFront) <= kFrontSeal * sizeof(std::uint64_t));
static_assert(std::is_trivially_copyable_v<PairFront>);
constexpr std::size_t kFrontHead = offsetof(PairFront, pair) / sizeof(std::uint64_t);
constexpr std::size_t kFrontRows = offsetof(PairFront, row) / sizeof(std::uint64_t);
static_assert(offsetof(PairFront, row) % sizeof(std::uint64_t) == 0 && kFrontRoom % 2 == 0);

/// Calls visit(first word, words) for the parts of a front that its number of planes uses.
template <class Visit>
void each_used(std::uint32_t count, Visit&& visit) noexcept {
    constexpr std::size_t kWordsOfRow = kFrontRoom / 2;  // two floats in each
    visit(std::size_t{0}, kFrontHead);
    visit(kFrontHead, std::size_t{count});
    for (std::size_t row = 0; row < std::tuple_size_v<decltype(PairFront::row)>; ++row) {
        visit(kFrontRows + row * kWordsOfRow, (std::size_t{count} + 1) / 2);
    }
}

std::uint64_t seal_of(const PairFront& front) noexcept {
    const auto* const bytes = reinterpret_cast<const char*>(&front);
    Seal seal;
    each_used(front.count, [&](std::size_t first, std::size_t words) {
        std::array<std::uint64_t, kFrontRoom> part;  // NOLINT(*-member-init): filled below
        std::memcpy(part.data(), bytes + first * sizeof(std::uint64_t),
                    words * sizeof(std::uint64_t));
        seal.add(part.data(), words);
    });
    return seal.value();
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

PairFrontWords::PairFrontWords(cdprep_front* words) noexcept : words_(words) {
    if (words == nullptr) return;
    PairFront& front = front_.emplace();
    std::memcpy(static_cast<void*>(&front), words, kFrontHead * sizeof(std::uint64_t));
    const bool is_possible = front.count <= kFrontRoom;
    if (is_possible) {
        // The copy is verified and used, even if another thread writes meanwhile.
        each_used(front.count, [&](std::size_t first, std::size_t used) {
            if (first == 0) return;
            std::memcpy(reinterpret_cast<char*>(&front) + first * sizeof(std::uint64_t),
                        words->words + first, used * sizeof(std::uint64_t));
        });
        if (words->words[kFrontSeal] == seal_of(front)) return;
    }
    front = {};
}

PairFrontWords::~PairFrontWords() {
    if (words_ == nullptr) return;
    assert(front_->count <= kFrontRoom);
    each_used(front_->count, [&](std::size_t first, std::size_t used) {
        std::memcpy(words_->words + first,
                    reinterpret_cast<const char*>(&*front_) + first * sizeof(std::uint64_t),
                    used * sizeof(std::uint64_t));
    });
    words_->words[kFrontSeal] = seal_of(*front_);
}

}  // namespace cdprep::c
