// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cdprep::import {

/// A JSON value. Asking a value for what it is not gives an empty value, so that
/// a path into a hostile document never fails half way.
class JsonValue {
public:
    /// Throws std::runtime_error with the byte where `text` is no JSON, or nested
    /// deeper than 100.
    [[nodiscard]] static JsonValue parse(std::string_view text);

    /// The member of an object; of several with one name, the first.
    [[nodiscard]] const JsonValue& operator[](std::string_view name) const noexcept;
    /// The element of an array.
    [[nodiscard]] const JsonValue& operator[](std::size_t i) const noexcept;
    [[nodiscard]] const std::vector<JsonValue>& items() const noexcept {
        return items_;
    }

    [[nodiscard]] bool exists() const noexcept {
        return kind_ != Kind::none;
    }
    [[nodiscard]] bool is_true() const noexcept {
        return kind_ == Kind::boolean && number_ != 0;
    }
    [[nodiscard]] const std::string& text() const noexcept {
        return text_;
    }
    [[nodiscard]] double number(double otherwise) const noexcept;
    /// A whole number from 0 to 2^53, or `otherwise` where there is none. Throws
    /// std::runtime_error for any other value, with `name` in its text.
    [[nodiscard]] std::uint64_t count(std::string_view name, std::uint64_t otherwise) const;

private:
    friend class JsonReader;
    enum class Kind : std::uint8_t { none, null, boolean, number, text, array, object };

    Kind kind_ = Kind::none;
    double number_ = 0;  ///< 1 for true
    std::string text_;
    std::vector<std::string> names_;  ///< of items_, in objects
    std::vector<JsonValue> items_;
};

}  // namespace cdprep::import
