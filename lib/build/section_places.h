// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>

#include "cdprep/format/file_header.h"

namespace cdprep::build {

/// The places of the sections of an image, one after the other by rising id.
///
/// A larger section, or one more, never makes the image smaller. aligned() never falls when its
/// argument rises, and a multiple of a page is a multiple of any smaller alignment.
class SectionPlaces {
public:
    explicit SectionPlaces(std::uint64_t alignment) noexcept : alignment_(alignment) {
        assert(std::has_single_bit(alignment));
    }

    /// Returns the place where a section of `size` bytes begins; 0 if it has none.
    std::uint64_t next(std::uint64_t size) noexcept {
        if (size == 0) return 0;
        const bool is_large = size >= format::kPageThreshold;
        const std::uint64_t begin =
            aligned(end_, is_large ? std::max(alignment_, format::kPageAlignment) : alignment_);
        end_ = begin + size;
        return begin;
    }

    /// Returns the number of bytes of the image.
    [[nodiscard]] std::uint64_t end() const noexcept {
        return aligned(end_, alignment_);
    }

private:
    static std::uint64_t aligned(std::uint64_t at, std::uint64_t alignment) noexcept {
        return (at + alignment - 1) / alignment * alignment;
    }

    std::uint64_t alignment_;
    /// An image has no HDF5 superblock, but room for the part of it that the header keeps.
    std::uint64_t end_ = format::kUserBlockSize + format::kSectionAlignment;
};

}  // namespace cdprep::build
