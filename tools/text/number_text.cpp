// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/number_text.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace cdprep::report {

std::string number_text(double number) {
    constexpr std::size_t kLongest = 32;
    std::array<char, kLongest> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    return {digits.data(), end};
}

std::string fixed(double value, int digits) {
    // The largest double has 309 digits before the point.
    std::array<char, 384> text{};
    const int size = std::snprintf(text.data(), text.size(), "%.*f", digits, value);
    return {text.data(), static_cast<std::size_t>(size)};
}

std::string in_six_digits(double value) {
    std::array<char, 32> text{};
    const int size = std::snprintf(text.data(), text.size(), "%.6g", value);
    return {text.data(), static_cast<std::size_t>(size)};
}

std::string at_most_in_six_digits(double bound) {
    std::string nearest = in_six_digits(bound);
    if (!(std::strtod(nearest.data(), nullptr) < bound)) return nearest;
    // The next number of six digits, from a text such as "1.23456e-07". Towards 0, a power of ten
    // has a neighbour with one digit more.
    std::string text = printed(bound, "%.5e");
    const std::size_t e = text.find('e');
    const int exponent = std::atoi(text.data() + e + 1) - 5;
    text.erase(e).erase(text.find('.'), 1);
    const int digits = std::atoi(text.data());
    const std::string next = digits == -100000
                                 ? "-999999e" + std::to_string(exponent - 1)
                                 : std::to_string(digits + 1) + "e" + std::to_string(exponent);
    return in_six_digits(std::strtod(next.data(), nullptr));
}

std::string at_least_in_six_digits(double bound) {
    const std::string mirrored = at_most_in_six_digits(-bound);
    return mirrored.front() == '-' ? mirrored.substr(1) : "-" + mirrored;
}

std::string printed(double value, const char* pattern) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), pattern, value);
    return text.data();
}

std::string size_text(const std::array<double, 3>& size, double metres_per_unit) {
    const double scale = metres_per_unit > 0 ? metres_per_unit : 1;
    std::string text;
    for (const double length : size) {
        text += (text.empty() ? "" : " x ") + in_six_digits(length * scale);
    }
    return text + " m";
}

std::string counted(std::uint64_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string hexadecimal(std::uint64_t value) {
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

}  // namespace cdprep::report
