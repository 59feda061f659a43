// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace cdprep::write {

/// The bytes of a file that is mostly unwritten: only touched pages take room,
/// all others read as zeros.
class SparseMemory {
public:
    [[nodiscard]] std::uint64_t size() const noexcept {
        return size_;
    }
    /// What lies beyond is forgotten.
    void resize(std::uint64_t size);

    /// Grows as far as needed.
    void write(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Zeros beyond the end.
    void read(std::uint64_t offset, std::span<std::byte> bytes) const;

private:
    static constexpr std::uint64_t kPageSize = 4096;
    using Page = std::array<std::byte, kPageSize>;

    std::map<std::uint64_t, Page> pages_;  ///< by number; those that were written
    std::uint64_t size_ = 0;
};

}  // namespace cdprep::write
