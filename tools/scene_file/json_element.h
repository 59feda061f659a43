// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/format/geometry.h"
#include "scene_file/json_file.h"

namespace cdprep::scenes {

using format::Double3;

/// The numbers that a value may be. A share is from 0 to 1.
enum class Range : std::uint8_t { any, zero_or_more, above_zero, share };

/// A value of a JSON file that is read and checked. Every function that returns nothing has added
/// an error: file, line, JSON pointer, the value found and what is allowed.
class JsonElement {
public:
    /// The root of a file. `file` and `errors` must outlive it.
    JsonElement(const JsonFile& file, std::vector<std::string>& errors);

    /// Adds the error "FILE: line 3: /pairs/0: WHAT".
    void refuse(const std::string& what) const;
    /// Adds the error "found VALUE; expected WHAT."
    void refuse_value(const std::string& expected) const;

    /// Returns whether this is an object that has no key but the given ones.
    [[nodiscard]] bool is_object_of(std::initializer_list<std::string_view> keys) const;
    /// Returns the member with this key, or nothing without an error.
    [[nodiscard]] std::optional<JsonElement> find(std::string_view key) const;
    [[nodiscard]] std::optional<JsonElement> require(std::string_view key) const;
    /// Returns the elements of an array.
    [[nodiscard]] std::optional<std::vector<JsonElement>> items() const;
    /// Returns the keys of an object.
    [[nodiscard]] std::optional<std::vector<std::string>> keys() const;
    /// Returns the value on one line, shortened for a message.
    [[nodiscard]] std::string value_text() const;
    /// The place of the value, as a JSON pointer.
    [[nodiscard]] const std::string& pointer() const noexcept {
        return pointer_;
    }

    /// The line on which the value begins, from 1.
    [[nodiscard]] std::size_t line() const;

    [[nodiscard]] std::optional<std::string> text() const;  ///< not empty
    [[nodiscard]] std::optional<double> number(Range range) const;
    [[nodiscard]] std::optional<bool> boolean() const;
    /// Limits are inclusive.
    [[nodiscard]] std::optional<std::uint32_t> whole(std::uint32_t least,
                                                     std::uint32_t most = 1U << 31) const;
    [[nodiscard]] std::optional<std::vector<double>> numbers(std::size_t count) const;
    [[nodiscard]] std::optional<Double3> vector() const;  ///< an array of three numbers
    /// Returns the number of a text among `words`. `kind` names the words: "a layer".
    [[nodiscard]] std::optional<std::size_t> one_of(std::span<const std::string> words,
                                                    const char* kind) const;

    [[nodiscard]] bool is_text() const {
        return value_->is_string();
    }
    [[nodiscard]] bool is_word(std::string_view word) const {
        return *value_ == word;
    }

private:
    JsonElement(const JsonElement& parent, const nlohmann::json& value, std::string pointer);

    const JsonFile* file_;
    std::vector<std::string>* errors_;
    const nlohmann::json* value_;
    std::string pointer_;
};

}  // namespace cdprep::scenes
