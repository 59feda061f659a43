// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <string_view>

#include "cdprep/c/base.h"
#include "cdprep/format/api.h"
#include "cdprep/result.h"

namespace cdprep::c {

/// The name of an argument in an error: "pairs[3].pose_b", "query.points[5]".
struct Name {
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    const char* argument;
    std::size_t index = kNone;
    const char* field = nullptr;
    std::size_t place = kNone;  ///< in the field

    [[nodiscard]] Name of(const char* its_field, std::size_t its_place = kNone) const noexcept {
        return {argument, index, its_field, its_place};
    }
};

/// Returns the text of a name, cut off where the room for it in an error ends.
[[nodiscard]] std::array<char, sizeof(cdprep_error::argument)> spelt(const Name& name) noexcept;

/// One call of the C API, with the place for its error. Every function returns the code that it
/// fills in.
class Call {
public:
    /// Sets the error to OK. `error` may be null.
    CDPREP_API explicit Call(cdprep_error* error) noexcept;

    /// Reports an invalid argument. The message is a format of std::snprintf; the name is put in
    /// front of it.
    [[gnu::format(printf, 4, 5)]] int refuse(std::int32_t why, const Name& name,
                                             const char* message, ...) noexcept;

    /// The same with a complete sentence.
    int refuse_with(std::int32_t why, const Name& name, std::string_view sentence) noexcept;

    /// Reports any other failure.
    CDPREP_API int fail(int code, std::string_view sentence) noexcept;

    /// Refuses a null pointer.
    int need(const void* pointer, const Name& name) noexcept {
        if (pointer != nullptr) return CDPREP_OK;
        refuse_null(name);
        return CDPREP_BAD_ARGUMENT;
    }

private:
    CDPREP_API void refuse_null(const Name& name) noexcept;

    cdprep_error* error_;
};

/// Runs `body(call)`, which returns a code, and lets no exception out.
template <class Body>
int guarded(cdprep_error* error, Body&& body) noexcept {
    Call call(error);
#if defined(__cpp_exceptions)
    try {
        return body(call);
    } catch (const std::bad_alloc&) {
        return call.fail(CDPREP_OVER_BUDGET, "There is not enough memory.");
    } catch (const std::exception& thrown) {
        return call.fail(CDPREP_INTERNAL, thrown.what());
    } catch (...) {
        return call.fail(CDPREP_INTERNAL, "An unknown exception was thrown.");
    }
#else  // without memory, the program ends
    return body(call);
#endif
}

}  // namespace cdprep::c
