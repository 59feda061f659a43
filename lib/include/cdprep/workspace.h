// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace cdprep {

/// Scratch memory for queries, owned by the caller: queries never allocate.
///
/// One workspace serves any number of queries, models and questions, one at a
/// time; threads need one each. Allocates once, when made; about 100 KiB.
class Workspace {
public:
    Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

    struct Storage;  ///< private to the library
    [[nodiscard]] Storage& storage() noexcept {
        return *storage_;
    }

private:
    std::unique_ptr<Storage> storage_;
};

}  // namespace cdprep
