// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/json_layout.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLineLength = 100;

/// Returns the items in brackets: on one line if they fit, else one per line.
std::string bracketed(const char* brackets, const std::vector<std::string>& items, int depth) {
    std::size_t size = 1 + items.size();
    bool is_broken = false;
    for (const std::string& item : items) {
        size += item.size();
        is_broken = is_broken || item.find('\n') != std::string::npos;
    }
    const bool fits = size <= kLineLength && !is_broken;
    std::string indent;
    if (!fits) {
        indent += '\n';
        indent.append(static_cast<std::size_t>(depth), ' ');
    }
    std::string text(1, brackets[0]);
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i > 0) text += ',';
        if (!fits) text += indent + ' ';
        text += items[i];
    }
    return text + indent + brackets[1];
}

}  // namespace

std::string compact(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string indented(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string valid_utf8(std::string_view text) {
    return Json::parse(compact(Json(text))).get<std::string>();
}

std::string laid_out(const Json& json, int depth) {
    if (!json.is_structured()) return compact(json);
    std::vector<std::string> items;
    if (json.is_array()) {
        for (const Json& item : json) items.push_back(laid_out(item, depth + 1));
        return bracketed("[]", items, depth);
    }
    for (const auto& [key, value] : json.items()) {
        items.push_back(compact(key) + ":" + laid_out(value, depth + 1));
    }
    return bracketed("{}", items, depth);
}

Json position_json(const format::Double3& position) {
    return Json::array({position.x, position.y, position.z});
}

}  // namespace cdprep::report
