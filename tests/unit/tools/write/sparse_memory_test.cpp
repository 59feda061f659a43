// SPDX-License-Identifier: MIT
#include "write/sparse_memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>

#include "support/aligned_bytes.h"

namespace cdprep::write {
namespace {

std::string text_at(const SparseMemory& memory, std::uint64_t offset, std::size_t size) {
    std::string text(size, '?');
    memory.read(offset, std::as_writable_bytes(std::span(text.data(), text.size())));
    return text;
}

TEST(SparseMemory, UnwrittenBytesAreZeros) {
    SparseMemory memory;
    memory.write(5000, test::bytes_of("abc"));
    EXPECT_EQ(memory.size(), 5003U);
    EXPECT_EQ(text_at(memory, 4998, 7), std::string("\0\0abc\0\0", 7));
    EXPECT_EQ(text_at(memory, 1, 3), std::string(3, '\0'));
    EXPECT_EQ(text_at(memory, 1U << 30, 3), std::string(3, '\0'));
}

TEST(SparseMemory, ShrinkingForgetsAndGrowingBringsZeros) {
    SparseMemory memory;
    memory.write(4090, test::bytes_of("0123456789"));
    memory.resize(4093);
    memory.resize(1U << 30);
    EXPECT_EQ(memory.size(), 1U << 30);
    EXPECT_EQ(text_at(memory, 4090, 10), std::string("012\0\0\0\0\0\0\0", 10));
}

// The plain string is the truth.
TEST(SparseMemory, BehavesLikePlainMemory) {
    std::mt19937 random(3);
    SparseMemory memory;
    std::string plain;
    for (int i = 0; i < 2000; ++i) {
        const std::size_t offset = random() % 20000;
        if (i % 100 == 99) {
            memory.resize(offset);
            plain.resize(offset);
            continue;
        }
        const std::string block(random() % 9000, static_cast<char>('a' + i % 26));
        plain.resize(std::max(plain.size(), offset + block.size()));
        plain.replace(offset, block.size(), block);
        memory.write(offset, test::bytes_of(block));
        ASSERT_EQ(memory.size(), plain.size());
        ASSERT_EQ(text_at(memory, 0, plain.size()), plain);
    }
}

}  // namespace
}  // namespace cdprep::write
