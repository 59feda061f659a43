// SPDX-License-Identifier: MIT
#include "core/sort_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace cdprep::test {
namespace {

// The oracle: std::sort. Sizes around the changes of method; many equal, few bits, all;
// scratch for all, some and none.
TEST(SortNumbers, DoesWhatComparingDoes) {
    std::mt19937 random(1);
    for (const std::size_t size : {0, 1, 2, 64, 65, 100, 101, 257, 8192, 8193, 1000, 70'000}) {
        for (const std::uint32_t mask : {0U, 1U, 0xffU, 0x1ffU, 0xfffU, 0x3ffffU, 0xffffffffU}) {
            std::vector<std::uint32_t> numbers(size);
            for (std::uint32_t& number : numbers) {
                number = static_cast<std::uint32_t>(random()) & mask;
            }
            std::vector<std::uint32_t> expected = numbers;
            std::sort(expected.begin(), expected.end());
            for (const std::size_t room : {0, 100, 8192}) {
                std::vector<std::uint32_t> sorted = numbers;
                std::vector<std::uint64_t> scratch(room);
                sort_numbers(sorted, scratch);
                ASSERT_EQ(sorted, expected) << size << " numbers of " << mask;
            }
        }
    }
}

}  // namespace
}  // namespace cdprep::test
