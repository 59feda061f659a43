// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/pair_cache.h"
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

}  // namespace cdprep::c
