// SPDX-License-Identifier: MIT
// AVX2 and NEON both round a product and a sum at once. So a model is walked in the same way on
// both processors, and counts of a query are the same. Every kernel of the table is asked.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "unit/lib/kernels/each_table.h"
#include "unit/lib/kernels/table_hashes.h"

namespace cdprep::kernels {
namespace {

struct Expected {
    const char* kernel;
    std::uint64_t hash;
};
constexpr std::array kBoth = {
    Expected{"cells_met", 0x35755ddffd940a17U},
    Expected{"depths of boxes", 0xc8a002075e6be26aU},
    Expected{"depths of swept 0", 0x24fc8bd5de87dbccU},
    Expected{"depths of swept 1", 0x27e881ec2e2a744cU},
    Expected{"depths of swept 2", 0xe849244d32d8f38dU},
    Expected{"edges_across", 0x7febed7e181f03e3U},
    Expected{"farthest", 0x802e0045e4253e96U},
    Expected{"farthest_moved", 0x1e1bcc20562d0649U},
    Expected{"fill_leaf", 0x53cdba50352e543cU},
    Expected{"find_contacts", 0x3e4eaa4f18f41480U},
    Expected{"find_own_contacts", 0xde65e66d1f0a1d3dU},
    Expected{"meeting_boxes", 0x2cde19e1a4c507e4U},
    Expected{"meeting_pairs", 0x8999714097a08129U},
    Expected{"met_boxes", 0x4ab87277ceb37983U},
    Expected{"near boxes", 0x66b20d07e924aea6U},
    Expected{"near swept 0", 0xa39eec1f3da98ea8U},
    Expected{"near swept 1", 0xc24e13dad8f823e7U},
    Expected{"near swept 2", 0x57d2a6e17ca99ccfU},
    Expected{"near_triangles", 0xec029590cd94cc16U},
    Expected{"overlapping boxes", 0x4fbe645a4e2c7bafU},
    Expected{"overlapping swept 0", 0x121e1ba530d8d2cbU},
    Expected{"overlapping swept 1", 0x008ec327317d1684U},
    Expected{"overlapping swept 2", 0x2c93ea05a4c6e401U},
    Expected{"place_among_cells", 0x2dc151969f082cf0U},
    Expected{"reaches", 0x1fe59882de293825U},
    Expected{"store_boxes", 0xc6d2373aaefa9f1fU},
    Expected{"triangles_within", 0x5006c45ac3729e12U},
    Expected{"weak_planes", 0x0bf20f04d5be021fU},
};

TEST(TableBits, OfNeonAreThoseOfAvx2) {
    std::size_t compared = 0;
    for_each_table([&](const Table& table) {
        const std::string name = table.name;
        if (name != "avx2" && name != "neon") return;
        Hashes hashes = hashes_of(table);
        EXPECT_EQ(hashes.size(), kKernels) << "a kernel is not asked";
        EXPECT_EQ(kBoth.size(), kKernels);
        for (const Expected& expected : kBoth) {
            EXPECT_EQ(hashes[expected.kernel].value(), expected.hash) << expected.kernel;
        }
        for (const auto& [kernel, hash] : hashes) {
            EXPECT_GT(hash.others_than_zero(), kLeastAnswers) << kernel << " hardly answers";
        }
        ++compared;
    });
    if (compared == 0) GTEST_SKIP() << "this processor has neither AVX2 nor NEON";
}

}  // namespace
}  // namespace cdprep::kernels
