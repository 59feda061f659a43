// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/json_file.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

namespace cdprep::scenes {
namespace {

using Json = nlohmann::json;

/// Deeper values are refused, so that pointers stay short.
constexpr std::size_t kMostLevels = 128;

/// The reason that the parser gives, without its own numbers of lines and columns.
std::string reason_of(const std::string& what) {
    const std::size_t at = what.find("syntax error");
    if (at != std::string::npos) return what.substr(at);
    const std::size_t end = what.find("] ");
    return end == std::string::npos ? what : what.substr(end + 2);
}

/// Builds the values as the parser meets them, and notes their lines.
class Builder : public nlohmann::json_sax<Json> {
public:
    Builder(JsonFile& file, const std::string& text, std::streambuf& input)
        : file_(file), text_(text), input_(input) {}

    [[nodiscard]] std::string error() const {
        return error_;
    }

    bool null() override {
        return add(nullptr);
    }
    bool boolean(bool value) override {
        return add(value);
    }
    bool number_integer(number_integer_t value) override {
        return add(value);
    }
    bool number_unsigned(number_unsigned_t value) override {
        return add(value);
    }
    bool number_float(number_float_t value, const string_t& /*text*/) override {
        return add(value);
    }
    bool string(string_t& value) override {
        return add(value);
    }
    bool binary(binary_t& /*value*/) override {
        return false;  // JSON text has none
    }
    bool start_object(std::size_t /*count*/) override {
        return open(Json::object());
    }
    bool key(string_t& key) override {
        key_ = key;
        if (!open_.back().value->contains(key)) return true;
        return refuse("the key '" + key + "' occurs twice in one object.");
    }
    bool end_object() override {
        return close();
    }
    bool start_array(std::size_t /*count*/) override {
        return open(Json::array());
    }
    bool end_array() override {
        return close();
    }
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                     const Json::exception& error) override {
        return refuse("this is not JSON: " + reason_of(error.what()) + ".");
    }

private:
    /// An array or object that has not ended.
    struct Open {
        Json* value;
        std::string pointer;
    };

    bool refuse(const std::string& what) {
        error_ = file_.name + ": line " + std::to_string(line()) + ": " + what;
        return false;
    }

    /// Returns the line of the token that the parser has just read. After a number the parser has
    /// also read the next character, which may end the line and does not count.
    std::size_t line() {
        const auto read = input_.pubseekoff(0, std::ios::cur, std::ios::in);
        const std::size_t end = read < 1 ? text_.size() : static_cast<std::size_t>(read) - 1;
        if (end > counted_) {
            line_ += static_cast<std::size_t>(
                std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                           text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            counted_ = end;
        }
        return line_;
    }

    /// Adds a value to the innermost array or object. Returns its place.
    Open place(Json value) {
        if (open_.empty()) {
            file_.root = std::move(value);
            return {&file_.root, ""};
        }
        const Open& parent = open_.back();
        if (parent.value->is_object()) {
            Json& at = (*parent.value)[key_];
            at = std::move(value);
            return {&at, pointer_below(parent.pointer, key_)};
        }
        const std::size_t index = parent.value->size();
        parent.value->push_back(std::move(value));
        return {&parent.value->back(), pointer_below(parent.pointer, std::to_string(index))};
    }

    bool add(Json value) {
        file_.lines.emplace(place(std::move(value)).pointer, line());
        return true;
    }
    bool open(Json value) {
        if (open_.size() == kMostLevels) {
            return refuse("values are nested deeper than " + std::to_string(kMostLevels) +
                          " levels.");
        }
        open_.push_back(place(std::move(value)));
        file_.lines.emplace(open_.back().pointer, line());
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    JsonFile& file_;
    const std::string& text_;
    std::streambuf& input_;
    std::size_t counted_ = 0;  ///< bytes whose line ends are in line_
    std::size_t line_ = 1;
    std::vector<Open> open_;
    std::string key_;
    std::string error_;
};

}  // namespace

std::string pointer_below(const std::string& pointer, std::string_view key) {
    std::string text = pointer + "/";
    for (const char letter : key) {
        if (letter == '~') {
            text += "~0";
        } else if (letter == '/') {
            text += "~1";
        } else {
            text += letter;
        }
    }
    return text;
}

Result<JsonFile> parse_json_file(const std::string& name, const std::string& text) {
    JsonFile file;
    file.name = name;
    std::istringstream input(text);
    Builder builder(file, text, *input.rdbuf());
    if (!Json::sax_parse(input, &builder)) return Error{ErrorCode::unreadable, builder.error()};
    return file;
}

}  // namespace cdprep::scenes
