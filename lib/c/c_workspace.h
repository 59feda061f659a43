// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <span>

#include "c/input.h"
#include "c/memory.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/ask.h"
#include "cdprep/workspace.h"

/// A workspace of one or more lanes. The object, the lanes' objects, their counts and their scratch
/// memory lie one after another in one block.
struct cdprep_workspace {
    std::span<cdprep::Workspace> lanes;
    std::span<cdprep::QueryCounts> counts;  ///< of each lane; empty without counting
    void (*run)(void*, std::size_t, cdprep_task, const void*);
    void* context;
    cdprep::c::Memory memory;  ///< none if it is the caller's
    bool has_cells;
    std::atomic<bool> in_use = false;
};

namespace cdprep::c {

/// The maximum number of lanes of a workspace.
inline constexpr std::uint32_t kMostLanes = 256;

template <>
struct Input<cdprep_workspace_options> {
    static const InputType type;
    static cdprep_workspace_options defaults() noexcept;
};

/// Refuses an object that a call is using.
int check_free(Call& call, const Name& name, const std::atomic<bool>& in_use) noexcept;

/// The use of a workspace, or of another object that serves one call at a time. No other call may
/// begin until it ends.
class InUse {
public:
    InUse() noexcept = default;
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;
    ~InUse() {
        if (in_use_ != nullptr) in_use_->store(false, std::memory_order_release);
    }
    /// Refuses an object that is in use.
    int begin(Call& call, const Name& name, std::atomic<bool>& in_use) noexcept;
    int begin(Call& call, cdprep_workspace& workspace) noexcept;

private:
    std::atomic<bool>* in_use_ = nullptr;
};

/// Refuses a workspace without searches through octrees and tetra-trees if `needs` has such a
/// structure.
int check_cells(Call& call, const cdprep_workspace& workspace, Ask needs) noexcept;

/// The caller's threads for any number of tasks, which must not throw. The caller's `run` gets at
/// most one task for each lane.
class LanesThreads {
public:
    explicit LanesThreads(const cdprep_workspace& workspace) noexcept : workspace_(workspace) {}
    void operator()(std::size_t count, Task task) const;

private:
    const cdprep_workspace& workspace_;
};

/// The caller's threads, as queries use them. Each task runs once, whatever `run` does. More than
/// kMostLanes tasks are shared out as LanesThreads does, so none of them may throw.
class CallersThreads {
public:
    explicit CallersThreads(const cdprep_workspace& workspace) noexcept : workspace_(workspace) {}
    void operator()(std::size_t count, Task task) const;

private:
    const cdprep_workspace& workspace_;
};

}  // namespace cdprep::c
