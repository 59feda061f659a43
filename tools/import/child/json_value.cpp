// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_value.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "import/parse_number.h"

namespace cdprep::import {

/// Reads one value after another.
class JsonReader {
public:
    explicit JsonReader(std::string_view text)
        : begin_(text.data()), at_(begin_), end_(begin_ + text.size()) {}

    JsonValue read_document() {
        if (std::string_view(at_, left()).starts_with("\xef\xbb\xbf")) at_ += 3;
        JsonValue value = read_value(0);
        skip_space();
        while (at_ < end_ && *at_ == '\0') ++at_;  // some writers pad with zeros
        if (at_ < end_) fail();
        return value;
    }

private:
    using Kind = JsonValue::Kind;

    [[nodiscard]] std::size_t left() const {
        return static_cast<std::size_t>(end_ - at_);
    }

    [[noreturn]] void fail() const {
        throw std::runtime_error("byte " + std::to_string(at_ - begin_) + " of its JSON is wrong");
    }

    void skip_space() {
        while (at_ < end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
    }

    bool take(char c) {
        skip_space();
        if (at_ == end_ || *at_ != c) return false;
        ++at_;
        return true;
    }

    void expect(char c) {
        if (!take(c)) fail();
    }

    bool take_word(std::string_view word) {
        if (!std::string_view(at_, left()).starts_with(word)) return false;
        at_ += word.size();
        return true;
    }

    JsonValue read_value(int depth) {
        constexpr int kMaxDepth = 100;
        if (depth > kMaxDepth) fail();
        skip_space();
        JsonValue value;
        if (take('{')) {
            value.kind_ = Kind::object;
            read_members(value, depth);
        } else if (take('[')) {
            value.kind_ = Kind::array;
            read_items(value, depth);
        } else if (at_ < end_ && *at_ == '"') {
            value.kind_ = Kind::text;
            value.text_ = read_text();
        } else if (take_word("null")) {
            value.kind_ = Kind::null;
        } else if (take_word("true")) {
            value.kind_ = Kind::boolean;
            value.number_ = 1;
        } else if (take_word("false")) {
            value.kind_ = Kind::boolean;
        } else {
            value.kind_ = Kind::number;
            value.number_ = read_number();
        }
        return value;
    }

    void read_members(JsonValue& object, int depth) {
        if (take('}')) return;
        do {
            skip_space();
            object.names_.push_back(read_text());
            expect(':');
            object.items_.push_back(read_value(depth + 1));
        } while (take(','));
        expect('}');
    }

    void read_items(JsonValue& array, int depth) {
        if (take(']')) return;
        do array.items_.push_back(read_value(depth + 1));
        while (take(','));
        expect(']');
    }

    double read_number() {
        const char* last = at_;
        while (last < end_ && (detail::is_digit(*last) || *last == '-' || *last == '+' ||
                               *last == '.' || *last == 'e' || *last == 'E')) {
            ++last;
        }
        const Number number = parse_number(at_, last);
        if (number.next != last || last == at_) fail();
        at_ = last;
        return number.value;
    }

    std::string read_text() {
        if (at_ == end_ || *at_ != '"') fail();
        ++at_;
        std::string text;
        while (at_ < end_ && *at_ != '"') {
            if (*at_ == '\\') {
                ++at_;
                read_escape(text);
            } else {
                text += *at_++;
            }
        }
        if (at_ == end_) fail();
        ++at_;
        return text;
    }

    void read_escape(std::string& text) {
        if (at_ == end_) fail();
        const char c = *at_++;
        constexpr std::string_view kEscapes = "\"\\/bfnrt";
        constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
        if (c == 'u') {
            std::uint32_t code = read_hex();
            const bool high = code >= 0xd800 && code < 0xdc00;
            if (high && take_word("\\u")) {
                code = 0x10000 + ((code - 0xd800) << 10) + ((read_hex() - 0xdc00) & 0x3ff);
            }
            add_utf8(code, text);
            return;
        }
        const std::size_t which = kEscapes.find(c);
        if (which == std::string_view::npos) fail();
        text += kMeanings[which];
    }

    std::uint32_t read_hex() {
        std::uint32_t code = 0;
        for (int i = 0; i < 4; ++i, ++at_) {
            if (at_ == end_) fail();
            const char c = *at_;
            const char lower = static_cast<char>(c | 0x20);
            if (!detail::is_digit(c) && (lower < 'a' || lower > 'f')) fail();
            code = code * 16 +
                   static_cast<std::uint32_t>(detail::is_digit(c) ? c - '0' : lower - 'a' + 10);
        }
        return code;
    }

    static void add_utf8(std::uint32_t code, std::string& text) {
        const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
        if (code < 0x80) return add(code);
        if (code < 0x800) {
            add(0xc0 | code >> 6);
        } else {
            if (code < 0x10000) {
                add(0xe0 | code >> 12);
            } else {
                add(0xf0 | code >> 18);
                add(0x80 | (code >> 12 & 0x3f));
            }
            add(0x80 | (code >> 6 & 0x3f));
        }
        add(0x80 | (code & 0x3f));
    }

    const char* begin_;
    const char* at_;
    const char* end_;
};

namespace {
const JsonValue kNone;
}  // namespace

JsonValue JsonValue::parse(std::string_view text) {
    return JsonReader(text).read_document();
}

const JsonValue& JsonValue::operator[](std::string_view name) const noexcept {
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (names_[i] == name) return items_[i];
    }
    return kNone;
}

const JsonValue& JsonValue::operator[](std::size_t i) const noexcept {
    return kind_ == Kind::array && i < items_.size() ? items_[i] : kNone;
}

double JsonValue::number(double otherwise) const noexcept {
    return kind_ == Kind::number ? number_ : otherwise;
}

std::uint64_t JsonValue::count(std::string_view name, std::uint64_t otherwise) const {
    constexpr double kMax = 0x1p53;
    if (kind_ == Kind::none) return otherwise;
    if (kind_ != Kind::number || !(number_ >= 0) || number_ > kMax ||
        number_ != std::floor(number_)) {
        throw std::runtime_error("'" + std::string(name) + "' is no whole number");
    }
    return static_cast<std::uint64_t>(number_);
}

}  // namespace cdprep::import
