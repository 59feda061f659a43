// SPDX-License-Identifier: MIT
#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include "core/mapped_file.h"

namespace cdprep {
namespace {

Error unreadable(const std::filesystem::path& path, const std::string& why) {
    return {ErrorCode::unreadable, path_text(path) + ": " + why};
}

/// Names an error by its number. The system's own text has no fixed language.
Error failure(const std::filesystem::path& path, const std::string& what,
              DWORD error = ::GetLastError()) {
    return unreadable(path, what + ": error " + std::to_string(error) + " of Windows.");
}

/// A handle that closes itself.
class Handle {
public:
    explicit Handle(HANDLE handle) noexcept : handle_(handle) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (is_open()) ::CloseHandle(handle_);
    }
    [[nodiscard]] bool is_open() const noexcept {
        return handle_ != nullptr && handle_ != INVALID_HANDLE_VALUE;
    }
    [[nodiscard]] HANDLE get() const noexcept {
        return handle_;
    }

private:
    HANDLE handle_;
};

/// A regular file, open for reading, and its size. Others may read, rename or delete it meanwhile.
struct OpenFile {
    Handle handle;
    std::size_t size = 0;
    std::optional<Error> error;

    explicit OpenFile(const std::filesystem::path& path)
        : handle(::CreateFileW(path.c_str(), GENERIC_READ, FILE_SHARE_READ | FILE_SHARE_DELETE,
                               nullptr, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr)) {
        const DWORD reason = ::GetLastError();
        LARGE_INTEGER bytes{};
        std::error_code unknown;
        if (!handle.is_open()) {
            error = std::filesystem::is_directory(path, unknown)
                        ? unreadable(path, "is not a regular file.")
                        : failure(path, "cannot be opened", reason);
        } else if (::GetFileType(handle.get()) != FILE_TYPE_DISK) {
            error = unreadable(path, "is not a regular file.");
        } else if (::GetFileSizeEx(handle.get(), &bytes) == 0) {
            error = failure(path, "cannot be examined");
        } else {
            size = static_cast<std::size_t>(bytes.QuadPart);
        }
    }
};

/// Fills all of `bytes` from the start of the file. Returns how many were read, or nothing.
std::optional<std::size_t> read_whole(HANDLE file, std::span<std::byte> bytes) {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // of a call
    std::size_t done = 0;
    while (done < bytes.size()) {
        const auto wanted = static_cast<DWORD>(std::min(kMost, bytes.size() - done));
        DWORD got = 0;
        if (::ReadFile(file, bytes.data() + done, wanted, &got, nullptr) == 0) return std::nullopt;
        if (got == 0) break;
        done += got;
    }
    return done;
}

/// Releases a mapping or a copy.
void release(std::span<const std::byte> bytes) noexcept {
    if (bytes.empty()) return;
    auto* start = const_cast<std::byte*>(bytes.data());
    MEMORY_BASIC_INFORMATION pages{};
    ::VirtualQuery(start, &pages, sizeof pages);
    if (pages.Type == MEM_MAPPED) {
        ::UnmapViewOfFile(start);
    } else {
        ::VirtualFree(start, 0, MEM_RELEASE);
    }
}

}  // namespace

std::string path_text(const std::filesystem::path& path) {
    const std::wstring& wide = path.native();
    const auto size = static_cast<int>(std::min<std::size_t>(wide.size(), 1U << 20));
    const int bytes =
        ::WideCharToMultiByte(CP_UTF8, 0, wide.data(), size, nullptr, 0, nullptr, nullptr);
    std::string text(static_cast<std::size_t>(std::max(bytes, 0)), '\0');
    ::WideCharToMultiByte(CP_UTF8, 0, wide.data(), size, text.data(), bytes, nullptr, nullptr);
    return text;
}

std::optional<std::filesystem::path> path_from_utf8(const char* text) {
    const int size = ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, nullptr, 0);
    if (size <= 0) return std::nullopt;
    std::wstring wide(static_cast<std::size_t>(size), L'\0');
    ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, wide.data(), size);
    wide.pop_back();  // the zero at the end
    return std::filesystem::path(wide);
}

std::FILE* open_to_read(const std::filesystem::path& path) {
    return ::_wfopen(path.c_str(), L"rb");
}

Result<MappedFile> MappedFile::map(const std::filesystem::path& path) {
    const OpenFile file(path);
    if (file.error) return *file.error;
    MappedFile mapped;
    if (file.size == 0) return mapped;
    const Handle mapping(
        ::CreateFileMappingW(file.handle.get(), nullptr, PAGE_READONLY, 0, 0, nullptr));
    const void* start =
        mapping.is_open() ? ::MapViewOfFile(mapping.get(), FILE_MAP_READ, 0, 0, 0) : nullptr;
    if (start == nullptr) return failure(path, "cannot be mapped");
    mapped.bytes_ = {static_cast<const std::byte*>(start), file.size};
    return mapped;
}

Result<MappedFile> MappedFile::copy(const std::filesystem::path& path) {
    const OpenFile file(path);
    if (file.error) return *file.error;
    MappedFile copied;
    if (file.size == 0) return copied;
    void* start = ::VirtualAlloc(nullptr, file.size, MEM_COMMIT | MEM_RESERVE, PAGE_READWRITE);
    if (start == nullptr) return failure(path, "cannot be copied");
    copied.bytes_ = {static_cast<const std::byte*>(start), file.size};
    const std::optional<std::size_t> read =
        read_whole(file.handle.get(), {static_cast<std::byte*>(start), file.size});
    if (!read) return failure(path, "cannot be read");
    if (*read < file.size) {
        return unreadable(path, "had " + std::to_string(file.size) +
                                    " bytes when it was opened, but only " + std::to_string(*read) +
                                    " could be read. Copy the file again, or bake it again.");
    }
    DWORD before = 0;
    ::VirtualProtect(start, file.size, PAGE_READONLY, &before);  // as in a mapping
    return copied;
}

MappedFile::~MappedFile() {
    release(bytes_);
}

}  // namespace cdprep
