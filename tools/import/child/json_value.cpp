// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_value.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace cdprep::import {

using nlohmann::json;

JsonValue JsonValue::operator[](std::string_view name) const {
    if (!exists() || !value_->is_object()) return {};
    const auto member = value_->find(name);
    return member == value_->end() ? JsonValue() : JsonValue(*member);
}

JsonValue JsonValue::operator[](std::size_t i) const noexcept {
    return exists() && value_->is_array() && i < value_->size() ? JsonValue((*value_)[i])
                                                                : JsonValue();
}

std::vector<JsonValue> JsonValue::items() const {
    std::vector<JsonValue> elements;
    if (!exists() || !value_->is_array()) return elements;
    elements.reserve(value_->size());
    for (const json& element : *value_) elements.emplace_back(element);
    return elements;
}

bool JsonValue::is_true() const noexcept {
    return exists() && *value_ == true;
}

const std::string& JsonValue::text() const {
    static const std::string kNone;
    return exists() && value_->is_string() ? value_->get_ref<const std::string&>() : kNone;
}

double JsonValue::number(double otherwise) const {
    return exists() && value_->is_number() ? value_->get<double>() : otherwise;
}

std::uint64_t JsonValue::count(std::string_view name, std::uint64_t otherwise) const {
    constexpr double kMost = 0x1p53;
    if (!exists()) return otherwise;
    const double value = number(-1);
    if (!(value >= 0) || value > kMost || value != std::floor(value)) {
        throw std::runtime_error("'" + std::string(name) + "' is not a whole number");
    }
    return static_cast<std::uint64_t>(value);
}

namespace {

json parse_utf8(std::string_view text) {
    constexpr int kMostLevels = 100;
    const auto check_depth = [](int depth, json::parse_event_t /*event*/, json& /*value*/) {
        if (depth > kMostLevels) {
            throw std::runtime_error("its JSON is nested deeper than " +
                                     std::to_string(kMostLevels) + " levels");
        }
        return true;
    };
    try {
        return json::parse(text, check_depth);
    } catch (const json::parse_error& error) {
        throw std::runtime_error("its JSON is invalid at byte " + std::to_string(error.byte));
    }
}

/// Returns the text with U+FFFD for every byte that is not UTF-8.
std::string replace_other_bytes(std::string_view text) {
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace

json parse_json(std::string_view text) {
    text = text.substr(0, text.find_last_not_of('\0') + 1);
    try {
        return parse_utf8(text);
    } catch (const std::runtime_error&) {
        // Some writers store names in another encoding.
        const std::string replaced = replace_other_bytes(text);
        if (replaced == text) throw;
        return parse_utf8(replaced);
    }
}

}  // namespace cdprep::import
