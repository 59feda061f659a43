// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "cdprep/precondition.h"

namespace cdprep {

/// The kind of a failure, for programs. The values are exit codes of the `cdprep` command. They are
/// also codes of the C API, except 4 and 130, which it never returns. Numbers are never reused.
enum class ErrorCode : std::uint32_t {
    bad_argument = 2,   ///< an invalid argument: an option, a pose, an effect that is not baked
    unreadable = 3,     ///< input that cannot be read: missing, malformed, damaged
    unwritable = 4,     ///< output that cannot be written
    over_budget = 5,    ///< a valid input that needs more time or memory than allowed
    internal = 6,       ///< an internal error: a bug of cdprep
    interrupted = 130,  ///< interrupted by the user
};

/// The reason why an operation failed. `message` is one or more whole sentences that can be shown
/// to a person unchanged; programs switch on `code`.
struct Error {
    ErrorCode code;
    std::string message;
};

/// Either a value or an Error: never both, never neither. If the program uses the value where there
/// is an error, it stops with the error's message (precondition.h).
///
///     auto opened = cdprep::Model::open("bracket.cdp.h5");
///     if (!opened) return fail(opened.error().message);
///     use(opened.value());
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value)
        : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit on purpose
    Result(Error error)
        : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit on purpose

    [[nodiscard]] bool ok() const noexcept {
        return state_.index() == 0;
    }
    explicit operator bool() const noexcept {
        return ok();
    }

    /// Requires ok().
    [[nodiscard]] T& value() & {
        require_value();
        return *std::get_if<0>(&state_);
    }
    /// Requires ok().
    [[nodiscard]] const T& value() const& {
        require_value();
        return *std::get_if<0>(&state_);
    }
    /// Requires ok().
    [[nodiscard]] T value() && {
        require_value();
        return std::move(*std::get_if<0>(&state_));
    }

    /// The same as value(). Requires ok().
    [[nodiscard]] T& operator*() & {
        return value();
    }
    /// Requires ok().
    [[nodiscard]] const T& operator*() const& {
        return value();
    }
    /// Requires ok().
    [[nodiscard]] T operator*() && {
        return std::move(*this).value();
    }
    /// Requires ok().
    [[nodiscard]] T* operator->() {
        return &value();
    }
    /// Requires ok().
    [[nodiscard]] const T* operator->() const {
        return &value();
    }

    /// Requires !ok().
    [[nodiscard]] const Error& error() const {
        if (ok()) [[unlikely]]
            stop_with("The Result holds a value, so it has no error.");
        return *std::get_if<1>(&state_);
    }

private:
    void require_value() const {
        if (!ok()) [[unlikely]]
            stop_with(std::get_if<1>(&state_)->message.c_str());
    }

    std::variant<T, Error> state_;
};

/// The value of a Result of an operation that returns nothing.
struct Done {};

}  // namespace cdprep
