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
/// One workspace serves any number of models and questions, one at a time; each thread needs its
/// own. It allocates about 880 KiB once, when it is made. Half of that is for octrees and
/// tetra-trees alone.
class Workspace {
public:
    Workspace();

    /// Makes a workspace in the caller's memory, which outlives it. Allocates nothing. Returns
    /// nothing if the memory is smaller than size() or not aligned to alignment().
    [[nodiscard]] static std::optional<Workspace> in_memory(std::span<std::byte> memory) noexcept;
    [[nodiscard]] static std::size_t size() noexcept;       ///< bytes
    [[nodiscard]] static std::size_t alignment() noexcept;  ///< bytes, a power of two

    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

    /// Adds the work of the following queries with this workspace to `*counts` (query_counts.h);
    /// null stops that. Costs 0.2 % of the instructions of a query when it is off.
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
