// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace cdprep::import {

/// A value in a JSON document, or none. A member or element that does not exist is none, and so
/// are its own members. A path into a hostile document therefore never fails half way. The
/// document must outlive the values.
class JsonValue {
public:
    explicit JsonValue(const nlohmann::json& value) noexcept : value_(&value) {}

    /// Returns the member of an object; the last if several have the name.
    [[nodiscard]] JsonValue operator[](std::string_view name) const;
    /// Returns the element of an array.
    [[nodiscard]] JsonValue operator[](std::size_t i) const noexcept;
    /// Returns the elements of an array; empty for other values.
    [[nodiscard]] std::vector<JsonValue> items() const;

    [[nodiscard]] bool exists() const noexcept {
        return value_ != nullptr;
    }
    [[nodiscard]] bool is_true() const noexcept;
    /// Returns the text of a string; empty for other values.
    [[nodiscard]] const std::string& text() const;
    [[nodiscard]] double number(double otherwise) const;
    /// Returns a whole number from 0 to 2^53, or `otherwise` if the value does not exist. Throws
    /// std::runtime_error with `name` in its text for any other value.
    [[nodiscard]] std::uint64_t count(std::string_view name, std::uint64_t otherwise) const;

private:
    JsonValue() = default;

    const nlohmann::json* value_ = nullptr;
};

/// Parses a document. Throws std::runtime_error if `text` is not JSON or nests deeper than 100;
/// the message gives the byte. Accepts zero bytes at the end, which some writers use as padding.
/// Replaces bytes that are not UTF-8 by U+FFFD.
[[nodiscard]] nlohmann::json parse_json(std::string_view text);

}  // namespace cdprep::import
