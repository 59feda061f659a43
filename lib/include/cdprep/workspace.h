// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace cdprep {

struct QueryCounts;

/// Scratch memory for queries, owned by the caller: queries never allocate.
///
/// One workspace serves any number of queries, models and questions, one at a
/// time; threads need one each. Allocates once, when made; about 880 KiB, of which
/// questions through octrees and tetra-trees alone touch the half.
class Workspace {
public:
    Workspace();

    /// A workspace in the caller's memory, which outlives it; allocates nothing.
    /// Nothing when the memory is smaller than size() or not aligned to alignment().
    [[nodiscard]] static std::optional<Workspace> in_memory(std::span<std::byte> memory) noexcept;
    [[nodiscard]] static std::size_t size() noexcept;       ///< bytes
    [[nodiscard]] static std::size_t alignment() noexcept;  ///< bytes, a power of two

    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

    /// From now on, adds to `*counts` what queries that count (query_counts.h)
    /// do with this workspace; null ends that. Where it is off it costs 0.2 % of a
    /// query (instructions counted by callgrind).
    void count_into(QueryCounts* counts) noexcept;

    struct Storage;  ///< private to the library
    [[nodiscard]] Storage& storage() noexcept {
        return *storage_;
    }

private:
    /// Frees what was allocated and leaves the caller's memory alone.
    struct Release {
        bool owns;
        void operator()(Storage* storage) const noexcept;
    };
    explicit Workspace(std::unique_ptr<Storage, Release> storage) noexcept;

    std::unique_ptr<Storage, Release> storage_;
};

}  // namespace cdprep
