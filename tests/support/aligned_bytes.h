// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "cdprep/format/file_header.h"

namespace cdprep::test {

/// Bytes at the start of a cache line, in an allocation of exactly their size. A
/// sanitizer therefore reports a read of one byte too many.
class AlignedBytes {
public:
    AlignedBytes() = default;
    explicit AlignedBytes(std::size_t size)
        : data_(static_cast<std::byte*>(::operator new[](size, kAlignment))), size_(size) {
        std::memset(data_.get(), 0, size);
    }
    explicit AlignedBytes(std::span<const std::byte> bytes) : AlignedBytes(bytes.size()) {
        if (!bytes.empty()) std::memcpy(data_.get(), bytes.data(), bytes.size());
    }

    [[nodiscard]] std::span<std::byte> span() noexcept {
        return {data_.get(), size_};
    }
    [[nodiscard]] std::span<const std::byte> span() const noexcept {
        return {data_.get(), size_};
    }
    [[nodiscard]] std::size_t size() const noexcept {
        return size_;
    }

private:
    static constexpr std::align_val_t kAlignment{format::kSectionAlignment};
    struct Free {
        void operator()(std::byte* p) const {
            ::operator delete[](p, kAlignment);
        }
    };
    std::unique_ptr<std::byte[], Free> data_;
    std::size_t size_ = 0;
};

inline std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace cdprep::test
