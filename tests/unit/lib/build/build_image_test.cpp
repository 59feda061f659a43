// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "cdprep/format/checksum.h"
#include "cdprep/format/content_hash.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "cdprep/model.h"
#include "support/aligned_bytes.h"

namespace cdprep::build {
namespace {

using format::SectionEntry;
using format::SectionId;
using test::AlignedBytes;

/// The ids that this version knows.
std::vector<SectionId> known_ids() {
    std::vector<SectionId> ids;
    for (std::uint32_t number = 1; number < 64; ++number) {
        if (format::element_size(SectionId{number}) != 0) ids.push_back(SectionId{number});
    }
    return ids;
}

/// Sections that own their bytes.
struct OwnedSections {
    std::vector<std::vector<std::byte>> bytes;
    std::vector<Section> views;

    void add(SectionId id, std::size_t elements) {
        const std::size_t size = elements * format::element_size(id);
        bytes.emplace_back(size);
        for (std::size_t i = 0; i < size; ++i) {
            bytes.back()[i] = static_cast<std::byte>(7 * i + static_cast<std::size_t>(id));
        }
        views.push_back({id, bytes.back()});
    }
};

/// One of every kind: some empty, some small, some of pages.
OwnedSections every_section() {
    OwnedSections sections;
    sections.bytes.reserve(64);
    std::size_t i = 0;
    for (const SectionId id : known_ids()) {
        const std::size_t large = 2 * format::kPageThreshold / format::element_size(id);
        sections.add(id, i % 5 == 0 ? large : i % 5);
        ++i;
        if (i % 7 == 0) {
            sections.bytes.back().clear();
            sections.views.back().bytes = {};
        }
    }
    return sections;
}

std::string refusal(std::span<const Section> sections, std::span<std::byte> memory,
                    const ImageOptions& options = {}) {
    const auto built = build_image({}, sections, memory, options);
    if (built) return "";
    EXPECT_EQ(built.error().code, ErrorCode::bad_argument);
    return built.error().message;
}

AlignedBytes full_of(std::size_t size, std::byte value) {
    AlignedBytes memory(size);
    std::ranges::fill(memory.span(), value);
    return memory;
}

// The bytes that go in are at hand, and so are their checksums.
TEST(BuildImage, EverySectionKeepsItsBytesWithItsEntry) {
    const OwnedSections sections = every_section();
    AlignedBytes memory = full_of(image_size(sections.views).value(), std::byte{0xa5});
    const auto image = build_image({}, sections.views, memory.span());
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_FALSE(format::find_header_damage(image.value()));
    EXPECT_EQ(format::read_header(image.value()).section_count, sections.views.size());
    for (const Section& section : sections.views) {
        const auto entry = format::find_section(image.value(), section.id);
        ASSERT_TRUE(entry) << format::section_name(section.id);
        EXPECT_EQ(entry->element_size, format::element_size(section.id));
        EXPECT_EQ(entry->count * entry->element_size, section.bytes.size());
        EXPECT_EQ(entry->checksum, format::checksum(section.bytes));
        if (section.bytes.empty()) {
            EXPECT_EQ(entry->offset, 0U);
            continue;
        }
        EXPECT_EQ(std::memcmp(image.value().data() + entry->offset, section.bytes.data(),
                              section.bytes.size()),
                  0)
            << format::section_name(section.id);
    }
}

// FORMAT.md: multiples of 64, of 4,096 from 64 KiB on.
TEST(BuildImage, LargeSectionsStartPagesAndOthersCacheLines) {
    const OwnedSections sections = every_section();
    AlignedBytes memory(image_size(sections.views).value());
    const auto image = build_image({}, sections.views, memory.span()).value();
    std::size_t beside_pages = 0;
    for (const Section& section : sections.views) {
        const auto entry = format::find_section(image, section.id).value();
        const bool is_large = section.bytes.size() >= format::kPageThreshold;
        EXPECT_EQ(entry.offset % (is_large ? format::kPageAlignment : format::kSectionAlignment),
                  0U);
        if (entry.offset % format::kPageAlignment != 0) ++beside_pages;
    }
    EXPECT_GT(beside_pages, 10U);  // small ones lie close together
}

// Every byte of the image that no section has is compared with zero.
TEST(BuildImage, BytesBetweenSectionsAreZero) {
    const OwnedSections sections = every_section();
    AlignedBytes memory = full_of(image_size(sections.views).value(), std::byte{0xa5});
    const auto image = build_image({}, sections.views, memory.span()).value();
    std::vector<bool> is_used(image.size());
    std::fill_n(is_used.begin(), format::kUserBlockSize, true);
    for (const Section& section : sections.views) {
        const auto entry = format::find_section(image, section.id).value();
        std::fill_n(is_used.begin() + static_cast<std::ptrdiff_t>(entry.offset),
                    section.bytes.size(), true);
    }
    for (std::size_t i = 0; i < image.size(); ++i) {
        ASSERT_TRUE(is_used[i] || image[i] == std::byte{0}) << i;
    }
}

TEST(BuildImage, MemoryBehindTheImageIsNotTouched) {
    const OwnedSections sections = every_section();
    const std::size_t size = image_size(sections.views).value();
    AlignedBytes memory = full_of(size + 1000, std::byte{0xa5});
    const auto image = build_image({}, sections.views, memory.span()).value();
    EXPECT_EQ(image.data(), memory.span().data());
    EXPECT_EQ(image.size(), size);
    EXPECT_EQ(format::read_header(image).file_size, size);
    EXPECT_TRUE(std::ranges::all_of(memory.span().subspan(size),
                                    [](std::byte byte) { return byte == std::byte{0xa5}; }));
}

TEST(BuildImage, TheOrderOfTheArgumentsMakesNoDifference) {
    const OwnedSections sections = every_section();
    std::vector<Section> backwards(sections.views.rbegin(), sections.views.rend());
    AlignedBytes first(image_size(sections.views).value());
    AlignedBytes second(image_size(backwards).value());
    ASSERT_TRUE(build_image({}, sections.views, first.span()));
    ASSERT_TRUE(build_image({}, backwards, second.span()));
    EXPECT_TRUE(std::ranges::equal(first.span(), second.span()));
}

// Facts are copied; the hash of the rest is the public one of format.
TEST(BuildImage, TheHeaderKeepsTheFactsAndTheContentHash) {
    format::FileHeader facts{};
    facts.vertex_count = 3;
    facts.triangle_count = 5;
    facts.flags = format::model_normalized;
    facts.up_axis = format::UpAxis::z;
    facts.metres_per_unit = 0.001;
    facts.frame_origin = {1, 2, 3};
    facts.frame_exponent = -4;
    facts.normalize_factor = 0.5;
    const OwnedSections sections = every_section();
    AlignedBytes memory(image_size(sections.views).value());
    const auto image = build_image(facts, sections.views, memory.span()).value();
    const format::FileHeader header = format::read_header(image);
    EXPECT_EQ(header.vertex_count, 3U);
    EXPECT_EQ(header.triangle_count, 5U);
    EXPECT_EQ(header.flags, format::model_normalized);
    EXPECT_EQ(header.up_axis, format::UpAxis::z);
    EXPECT_EQ(header.metres_per_unit, 0.001);
    EXPECT_EQ(header.frame_origin, (format::Double3{1, 2, 3}));
    EXPECT_EQ(header.frame_exponent, -4);
    EXPECT_EQ(header.normalize_factor, 0.5);
    std::vector<SectionEntry> entries;
    for (const SectionId id : known_ids()) {
        entries.push_back(format::find_section(image, id).value());
    }
    EXPECT_EQ(header.content_hash, format::content_hash(header, entries));
}

// Offsets do not count in the hash: FORMAT.md.
TEST(BuildImage, AnotherAlignmentMovesSectionsAndKeepsTheContentHash) {
    const OwnedSections sections = every_section();
    const ImageOptions on_pages{.section_alignment = 4096};
    AlignedBytes close(image_size(sections.views).value());
    AlignedBytes apart(image_size(sections.views, on_pages).value());
    const auto image = build_image({}, sections.views, close.span()).value();
    const auto paged = build_image({}, sections.views, apart.span(), on_pages).value();
    EXPECT_GT(paged.size(), image.size());
    EXPECT_EQ(paged.size() % 4096, 0U);
    EXPECT_EQ(format::read_header(paged).content_hash, format::read_header(image).content_hash);
    for (const Section& section : sections.views) {
        EXPECT_EQ(format::find_section(paged, section.id)->offset % 4096, 0U);
    }
}

TEST(BuildImage, AnImageOfNoSectionsIsAnEmptyModel) {
    AlignedBytes memory(image_size({}).value());
    const auto image = build_image({}, {}, memory.span());
    ASSERT_TRUE(image);
    EXPECT_FALSE(format::find_damage(image.value()));
    EXPECT_TRUE(Model::open(image.value()));
}

TEST(BuildImage, ASectionGivenTwiceIsRefusedByName) {
    OwnedSections sections;
    sections.bytes.reserve(3);
    sections.add(SectionId::triangles, 4);
    sections.add(SectionId::bounds, 1);
    sections.add(SectionId::triangles, 4);
    AlignedBytes memory(8192);
    EXPECT_EQ(refusal(sections.views, memory.span()), "Section 3 (triangles) is given twice.");
    EXPECT_EQ(image_size(sections.views).error().code, ErrorCode::bad_argument);
}

TEST(BuildImage, PartsOfElementsAreRefused) {
    OwnedSections sections;
    sections.add(SectionId::triangles, 4);
    sections.views[0].bytes = sections.views[0].bytes.first(40);
    AlignedBytes memory(8192);
    EXPECT_EQ(refusal(sections.views, memory.span()),
              "Section 3 (triangles) has 40 bytes, which is not a multiple of the element size, 12 "
              "bytes.");
}

TEST(BuildImage, UnknownSectionsAreRefused) {
    AlignedBytes memory(8192);
    for (const std::uint32_t number : {0U, 62U, 64U, 0xffffffffU}) {
        const std::vector<Section> sections = {{SectionId{number}, {}}};
        EXPECT_NE(refusal(sections, memory.span()).find("is unknown to this version"),
                  std::string::npos)
            << number;
    }
    const std::vector<Section> too_many(format::kMaxSections + 1,
                                        Section{SectionId::triangles, {}});
    EXPECT_NE(refusal(too_many, memory.span()).find("more than the 120"), std::string::npos);
    const std::span<const Section> not_too_many = std::span(too_many).first(format::kMaxSections);
    EXPECT_NE(refusal(not_too_many, memory.span()).find("is given twice"), std::string::npos);
}

// One byte less than image_size(), none at all, and every place that is not aligned.
TEST(BuildImage, MemoryThatDoesNotFitIsRefusedAndNotWritten) {
    const OwnedSections sections = every_section();
    const std::size_t size = image_size(sections.views).value();
    AlignedBytes memory = full_of(size + 64, std::byte{0xa5});
    EXPECT_EQ(refusal(sections.views, memory.span().first(size - 1)),
              "The image needs " + std::to_string(size) + " bytes, but the memory for it has " +
                  std::to_string(size - 1) + ".");
    EXPECT_NE(refusal(sections.views, {}), "");
    for (const std::size_t off : {1U, 8U, 32U, 63U}) {
        EXPECT_NE(refusal(sections.views, memory.span().subspan(off)).find("past a multiple of 64"),
                  std::string::npos);
    }
    EXPECT_TRUE(
        std::ranges::all_of(memory.span(), [](std::byte byte) { return byte == std::byte{0xa5}; }));
}

TEST(BuildImage, AlignmentsThatAFileMayNotHaveAreRefused) {
    AlignedBytes memory(16384);
    for (const std::uint64_t alignment : {0ULL, 1ULL, 32ULL, 63ULL, 65ULL, 96ULL, 4095ULL}) {
        EXPECT_NE(refusal({}, memory.span(), {.section_alignment = alignment})
                      .find("cannot be aligned to"),
                  std::string::npos)
            << alignment;
    }
    EXPECT_EQ(refusal({}, memory.span(), {.section_alignment = 128}), "");
    // Places of two sections would wrap around.
    OwnedSections sections;
    sections.bytes.reserve(2);
    sections.add(SectionId::triangles, 1);
    sections.add(SectionId::bounds, 1);
    EXPECT_NE(refusal(sections.views, memory.span(), {.section_alignment = std::uint64_t{1} << 63}),
              "");
}

}  // namespace
}  // namespace cdprep::build
