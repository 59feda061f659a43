// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_parts.h"

#include <algorithm>

namespace cdprep::report {

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char letter : text) {
        switch (letter) {
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '&':
                safe += "&amp;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += letter;
        }
    }
    return safe;
}

std::string script_json(std::string_view json) {
    std::string safe;
    safe.reserve(json.size());
    for (const char letter : json) {
        if (letter == '<') {
            safe += "\\u003c";
        } else if (letter == '>') {
            safe += "\\u003e";
        } else if (letter == '&') {
            safe += "\\u0026";
        } else {
            safe += letter;
        }
    }
    return safe;
}

std::string script_element(const std::string& id, const char* type, const std::string& content) {
    return "<script type=\"" + std::string(type) + "\" id=\"" + id + "\">" + content +
           "</script>\n";
}

std::string filled(std::string_view frame,
                   std::span<const std::pair<std::string_view, std::string>> parts) {
    std::string page;
    while (!frame.empty()) {
        const auto starts = [&](const auto& part) { return frame.starts_with(part.first); };
        const auto part = frame.front() == '@' ? std::ranges::find_if(parts, starts) : parts.end();
        if (part == parts.end()) {
            page += frame.front();
            frame.remove_prefix(1);
        } else {
            page += part->second;
            frame.remove_prefix(part->first.size());
        }
    }
    return page;
}

}  // namespace cdprep::report
