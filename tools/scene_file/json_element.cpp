// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/json_element.h"

#include <algorithm>
#include <utility>

#include "text/json_layout.h"
#include "text/nearest_word.h"

namespace cdprep::scenes {
namespace {

std::string listed(std::span<const std::string> words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
        text += words[i];
    }
    return text;
}

bool is_in(Range range, double number) {
    switch (range) {
        case Range::any:
            return true;
        case Range::zero_or_more:
            return number >= 0;
        case Range::above_zero:
            return number > 0;
        default:
            return number >= 0 && number <= 1;
    }
}

const char* words_for(Range range) {
    switch (range) {
        case Range::any:
            return "a number";
        case Range::zero_or_more:
            return "a number, 0 or more";
        case Range::above_zero:
            return "a number above 0";
        default:
            return "a number from 0 to 1";
    }
}

}  // namespace

JsonElement::JsonElement(const JsonFile& file, std::vector<std::string>& errors)
    : file_(&file), errors_(&errors), value_(&file.root) {}

JsonElement::JsonElement(const JsonElement& parent, const nlohmann::json& value,
                         std::string pointer)
    : file_(parent.file_), errors_(parent.errors_), value_(&value), pointer_(std::move(pointer)) {}

void JsonElement::refuse(const std::string& what) const {
    const std::string place = pointer_.empty() ? "" : pointer_ + ": ";
    errors_->push_back(file_->name + ": line " + std::to_string(line()) + ": " + place + what);
}

std::size_t JsonElement::line() const {
    return file_->lines.at(pointer_);
}

void JsonElement::refuse_value(const std::string& expected) const {
    refuse("found " + value_text() + "; expected " + expected + ".");
}

std::string JsonElement::value_text() const {
    if (value_->is_object()) return value_->empty() ? "an empty object" : "an object";
    constexpr std::size_t kLongest = 60;
    std::string text = value_->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
    return text;
}

bool JsonElement::is_object_of(std::initializer_list<std::string_view> keys) const {
    if (!value_->is_object()) {
        refuse_value("an object");
        return false;
    }
    const std::vector<std::string> known(keys.begin(), keys.end());
    bool is_known = true;
    for (const auto& [key, value] : value_->items()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        JsonElement(*this, value, pointer_below(pointer_, key))
            .refuse("unknown key '" + key + "'. Choose from " + listed(known) + "." +
                    report::suggestion(key, known));
        is_known = false;
    }
    return is_known;
}

std::optional<JsonElement> JsonElement::find(std::string_view key) const {
    const auto at = value_->find(std::string(key));
    if (at == value_->end()) return std::nullopt;
    return JsonElement(*this, *at, pointer_below(pointer_, key));
}

std::optional<JsonElement> JsonElement::require(std::string_view key) const {
    std::optional<JsonElement> member = find(key);
    if (!member) refuse("the key '" + std::string(key) + "' is missing.");
    return member;
}

std::optional<std::vector<JsonElement>> JsonElement::items() const {
    if (!value_->is_array()) {
        refuse_value("an array");
        return std::nullopt;
    }
    std::vector<JsonElement> elements;
    elements.reserve(value_->size());
    for (const nlohmann::json& value : *value_) {
        elements.push_back(
            JsonElement(*this, value, pointer_below(pointer_, std::to_string(elements.size()))));
    }
    return elements;
}

std::optional<std::vector<std::string>> JsonElement::keys() const {
    if (!value_->is_object()) {
        refuse_value("an object");
        return std::nullopt;
    }
    std::vector<std::string> keys;
    for (const auto& [key, value] : value_->items()) keys.push_back(key);
    return keys;
}

std::optional<std::string> JsonElement::text() const {
    if (value_->is_string() && !value_->get_ref<const std::string&>().empty()) {
        return value_->get<std::string>();
    }
    refuse_value("a non-empty string");
    return std::nullopt;
}

std::optional<double> JsonElement::number(Range range) const {
    if (value_->is_number()) {
        const auto found = value_->get<double>();
        if (is_in(range, found)) return found;
    }
    refuse_value(words_for(range));
    return std::nullopt;
}

std::optional<bool> JsonElement::boolean() const {
    if (value_->is_boolean()) return value_->get<bool>();
    refuse_value("true or false");
    return std::nullopt;
}

std::optional<std::uint32_t> JsonElement::whole(std::uint32_t least, std::uint32_t most) const {
    if (value_->is_number_unsigned()) {
        const auto found = value_->get<std::uint64_t>();
        if (found >= least && found <= most) return static_cast<std::uint32_t>(found);
    }
    refuse_value("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return std::nullopt;
}

std::optional<std::vector<double>> JsonElement::numbers(std::size_t count) const {
    std::vector<double> found;
    if (value_->is_array() && value_->size() == count) {
        for (const nlohmann::json& value : *value_) {
            if (value.is_number()) found.push_back(value.get<double>());
        }
        if (found.size() == count) return found;
    }
    refuse_value("an array of " + std::to_string(count) + " numbers");
    return std::nullopt;
}

std::optional<Double3> JsonElement::vector() const {
    const auto found = numbers(3);
    if (!found) return std::nullopt;
    return Double3{(*found)[0], (*found)[1], (*found)[2]};
}

std::optional<std::size_t> JsonElement::one_of(std::span<const std::string> words,
                                               const char* kind) const {
    if (!value_->is_string()) {
        refuse_value(std::string(kind) + ": " + listed(words));
        return std::nullopt;
    }
    const auto& word = value_->get_ref<const std::string&>();
    const auto at = std::find(words.begin(), words.end(), word);
    if (at != words.end()) return static_cast<std::size_t>(at - words.begin());
    refuse("'" + word + "' is not " + kind + ". Choose from " + listed(words) + "." +
           report::suggestion(word, words));
    return std::nullopt;
}

}  // namespace cdprep::scenes
