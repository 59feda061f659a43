// SPDX-License-Identifier: MIT
#include "c/call.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace cdprep::c {
namespace {

using Argument = std::array<char, sizeof(cdprep_error::argument)>;

/// Writes text, cut off where the room ends.
class Writer {
public:
    explicit Writer(Argument& text) noexcept : text_(text) {
        text_[0] = 0;
    }
    void add(const char* word) noexcept {
        print("%s", word);
    }
    void add(std::size_t number) noexcept {
        print("[%zu]", number);
    }

private:
    template <class Value>
    void print(const char* format, Value value) noexcept {
        assert(at_ < text_.size());
        const int length = std::snprintf(text_.data() + at_, text_.size() - at_, format, value);
        if (length > 0) at_ = std::min(text_.size() - 1, at_ + static_cast<std::size_t>(length));
    }
    Argument& text_;
    std::size_t at_ = 0;
};

void copy_text(std::string_view from, char* to, std::size_t room) noexcept {
    assert(room > 0);
    const std::size_t length = std::min(from.size(), room - 1);
    std::memcpy(to, from.data(), length);
    to[length] = 0;
}

}  // namespace

Argument spelt(const Name& name) noexcept {
    Argument text{};
    Writer writer(text);
    writer.add(name.argument);
    if (name.index != Name::kNone) writer.add(name.index);
    if (name.field != nullptr) {
        writer.add(".");
        writer.add(name.field);
    }
    if (name.place != Name::kNone) writer.add(name.place);
    return text;
}

Call::Call(cdprep_error* error) noexcept : error_(error) {
    if (error == nullptr) return;
    error->code = CDPREP_OK;
    error->why = 0;
    error->argument[0] = 0;
    error->message[0] = 0;
}

int Call::refuse(std::int32_t why, const Name& name, const char* message, ...) noexcept {
    if (error_ == nullptr) return CDPREP_BAD_ARGUMENT;
    std::array<char, sizeof error_->message> sentence{};
    const int length = std::snprintf(sentence.data(), sentence.size(), "%s ", spelt(name).data());
    const std::size_t begin = length > 0 ? static_cast<std::size_t>(length) : 0;
    assert(begin < sentence.size());  // a name is shorter than a message
    std::va_list values;
    va_start(values, message);
    std::vsnprintf(sentence.data() + begin, sentence.size() - begin, message, values);
    va_end(values);
    return refuse_with(why, name, sentence.data());
}

int Call::refuse_with(std::int32_t why, const Name& name, std::string_view sentence) noexcept {
    if (error_ == nullptr) return CDPREP_BAD_ARGUMENT;
    fail(CDPREP_BAD_ARGUMENT, sentence);
    error_->why = why;
    copy_text(spelt(name).data(), error_->argument, sizeof error_->argument);
    return CDPREP_BAD_ARGUMENT;
}

int Call::fail(int code, std::string_view sentence) noexcept {
    assert(code != CDPREP_OK);
    if (error_ == nullptr) return code;
    error_->code = code;
    error_->why = 0;
    error_->argument[0] = 0;
    copy_text(sentence, error_->message, sizeof error_->message);
    return code;
}

void Call::refuse_null(const Name& name) noexcept {
    (void)refuse(CDPREP_WHY_NULL, name, "is null.");
}

}  // namespace cdprep::c
