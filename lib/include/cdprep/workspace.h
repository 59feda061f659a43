// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "cdprep/format/api.h"

namespace cdprep {

struct CellSearches;
struct QueryCounts;

/// Scratch memory for queries, owned by the caller: queries never allocate.
///
/// One workspace serves any number of models and queries, one at a time; each thread needs its own.
/// It allocates about 820 KiB once, on construction.
class Workspace {
public:
    /// Makes a workspace for every query except those through octrees and tetra-trees.
    CDPREP_API Workspace();

    /// Makes a workspace that also serves queries through octrees and tetra-trees. This workspace
    /// takes 360 KiB more. `cells` is cells() of <cdprep/cells.h>.
    ///
    ///     cdprep::Workspace workspace(cdprep::cells());
    CDPREP_API explicit Workspace(const CellSearches& cells);

    /// Makes a workspace in the caller's memory, which must outlive it. Allocates nothing. Returns
    /// nothing if the memory is smaller than size(cells) or not aligned to alignment(). With null
    /// `cells`, the workspace serves the same queries as Workspace().
    [[nodiscard]] CDPREP_API static std::optional<Workspace> in_memory(
        std::span<std::byte> memory, const CellSearches* cells = nullptr) noexcept;
    /// Returns the least size of the memory for in_memory(), in bytes.
    [[nodiscard]] CDPREP_API static std::size_t size(const CellSearches* cells = nullptr) noexcept;
    [[nodiscard]] CDPREP_API static std::size_t alignment() noexcept;  ///< bytes, a power of two

    CDPREP_API Workspace(Workspace&&) noexcept;
    CDPREP_API Workspace& operator=(Workspace&&) noexcept;
    CDPREP_API ~Workspace();

    /// Adds the work of later queries with this workspace to `*counts` (query_counts.h); null turns
    /// counting off. Even while it is off, counting costs 0.2 % of a query's instructions.
    CDPREP_API void count_into(QueryCounts* counts) noexcept;

    struct Storage;  ///< private to the library
    [[nodiscard]] Storage& storage() noexcept {
        return *storage_;
    }

private:
    /// Frees memory that the workspace allocated, never the caller's memory.
    struct Release {
        bool owns;
        void operator()(Storage* storage) const noexcept;
    };
    explicit Workspace(std::unique_ptr<Storage, Release> storage) noexcept;

    std::unique_ptr<Storage, Release> storage_;
};

}  // namespace cdprep
