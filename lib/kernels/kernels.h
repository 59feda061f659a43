// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

/// The innermost loops, once per instruction set.
///
/// A kernel sees raw arrays and returns plain numbers. It knows nothing of
/// Model, allocates nothing and fails at nothing. This header is the only one
/// that a kernel source may include besides the vendor's intrinsics: an inline
/// function shared with the rest of the library could be emitted there with
/// AVX2 inside, and then be the copy the linker keeps for everyone.
namespace cdprep::kernels {

/// How the boxes of two hierarchies stand to each other: a box centre c of B
/// lies at rotation * (scale_b c) + shift in the frame of A's boxes, scaled by
/// scale_a. One scale is 1, the other at most 1.
struct BoxPlacement {
    float rotation[9];      ///< a_from_b, row by row
    float abs_rotation[9];  ///< its absolute values
    float shift[3];         ///< of B's frame origin, along A's axes
    float shift_in_b[3];    ///< the same vector along B's axes
    float scale_a;
    float scale_b;
    float slack;  ///< added to every sum of half extents; covers all rounding
};

/// One instruction set's kernels.
struct Table {
    const char* name;  ///< "scalar", "avx2": shown in tests and benchmarks

    /// Tests boxes of a node of B against the eight of a node of A: sets bit i
    /// of masks[j] unless one of the six face directions separates box i of A
    /// from box j of B, for each j in [first_b, last_b). Nodes are 48 floats:
    /// lower x, y, z, then upper x, y, z, eight each. Unused boxes give any bits.
    void (*overlap_masks)(const BoxPlacement& placement, const float* a, const float* b,
                          std::size_t first_b, std::size_t last_b, std::uint8_t* masks) noexcept;
};

extern const Table kScalar;  ///< the reference: every other table agrees with it, bit for bit
#ifdef CDPREP_HAVE_AVX2
extern const Table kAvx2;  ///< call through it only if available() lists it
#endif

/// The tables that this processor can run, the reference first.
struct Available {
    const Table* table[2];
    std::size_t count;
};
[[nodiscard]] Available available() noexcept;

/// The table that queries use: the last available one, or the one that the
/// environment variable CDPREP_KERNELS names when the process first asks.
[[nodiscard]] const Table& active() noexcept;

}  // namespace cdprep::kernels
