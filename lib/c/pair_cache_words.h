// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/pair_cache.h"
#include "cdprep/advanced/pair_front.h"
#include "cdprep/c/pairs.h"

namespace cdprep::c {

/// The C++ cache during one query. It is read from the words of a C program and written back. Any
/// words that were not written here give a new cache.
class PairCacheWords {
public:
    /// `words` may be null.
    explicit PairCacheWords(cdprep_cache* words) noexcept;
    PairCacheWords(const PairCacheWords&) = delete;
    PairCacheWords& operator=(const PairCacheWords&) = delete;
    ~PairCacheWords();

    [[nodiscard]] PairCache* get() noexcept {
        return words_ == nullptr ? nullptr : &cache_;
    }

private:
    cdprep_cache* words_;
    PairCache cache_;
};

/// The same for a front. Only the planes that are in use are read and written.
class PairFrontWords {
public:
    /// `words` may be null.
    explicit PairFrontWords(cdprep_front* words) noexcept;
    PairFrontWords(const PairFrontWords&) = delete;
    PairFrontWords& operator=(const PairFrontWords&) = delete;
    ~PairFrontWords();

    [[nodiscard]] PairFront* get() noexcept {
        return front_ ? &*front_ : nullptr;
    }

private:
    cdprep_front* words_;
    std::optional<PairFront> front_;
};

}  // namespace cdprep::c
