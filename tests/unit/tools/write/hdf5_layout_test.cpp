// SPDX-License-Identifier: MIT
#include "write/hdf5_layout.h"

#include <gtest/gtest.h>

#include "support/scratch_folder.h"

namespace cdprep::write {
namespace {

/// An HDF5 file with these datasets, whose elements are zeros.
std::filesystem::path file_of(const test::ScratchFolder& folder, std::span<const Plan> plans) {
    const std::optional<Layout> layout = make_layout(plans, {});
    EXPECT_TRUE(layout);
    std::vector<std::byte> bytes(layout->rest.size());
    layout->rest.read(0, bytes);
    return folder.write("file.h5", bytes);
}

TEST(FindLayout, SaysWhyNothingIsFound) {
    const test::ScratchFolder folder;
    const std::string unreadable = "it is not a readable HDF5 file";
    const FoundLayout missing = find_layout(folder.file("missing"));
    EXPECT_EQ(missing.damage, unreadable);
    EXPECT_TRUE(missing.places.empty());
    const FoundLayout text = find_layout(folder.write("text", std::string(10000, 'x')));
    EXPECT_EQ(text.damage, unreadable);
    EXPECT_TRUE(text.places.empty());
    const FoundLayout foreign = find_layout(file_of(folder, {}));
    EXPECT_EQ(foreign.damage, "it contains no dataset of cdprep");
    EXPECT_TRUE(foreign.places.empty());
}

TEST(FindLayout, FindsThePlaceOfADataset) {
    const test::ScratchFolder folder;
    const std::vector<Plan> plans = {{format::SectionId::positions_f64, 5}};
    const FoundLayout found = find_layout(file_of(folder, plans));
    EXPECT_EQ(found.damage, "");
    ASSERT_EQ(found.places.size(), 1U);
    EXPECT_EQ(found.places[0].id, format::SectionId::positions_f64);
    EXPECT_EQ(found.places[0].count, 5U);
}

}  // namespace
}  // namespace cdprep::write
