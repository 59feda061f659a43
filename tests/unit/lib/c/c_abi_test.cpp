// SPDX-License-Identifier: MIT
// Where every field of the C API is, and what its functions take. A program that was compiled
// before finds it there. c_abi.inc is the list. tests/check_c_api.py compares it with the headers
// and writes it. A change that is meant is named in CHANGELOG.md.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "cdprep/cdprep.h"

namespace {

struct StructEntry {
    const char* name;
    std::size_t size, size_64, size_32;
};
struct FieldEntry {
    const char* of;
    const char* name;
    std::size_t place, extent, place_64, place_32;
};
struct ValueEntry {
    const char* name;
    std::int64_t value, expected;
};

#define CDPREP_STRUCT(type, size_64, size_32)
#define CDPREP_FIELD(type, field, place_64, place_32)
#define CDPREP_VALUE(name, value)
#define CDPREP_CALLBACK(name, ...) \
    static_assert(std::is_same_v<name, std::add_pointer_t<__VA_ARGS__>>);
#define CDPREP_FUNCTION(name, ...) static_assert(std::is_same_v<decltype(name), __VA_ARGS__>);
#include "c_abi.inc"
#undef CDPREP_CALLBACK
#undef CDPREP_FUNCTION
#define CDPREP_CALLBACK(name, ...)
#define CDPREP_FUNCTION(name, ...)

#undef CDPREP_STRUCT
#define CDPREP_STRUCT(type, size_64, size_32) {#type, sizeof(type), size_64, size_32},
const std::vector<StructEntry> kStructs = {
#include "c_abi.inc"
};
#undef CDPREP_STRUCT
#define CDPREP_STRUCT(type, size_64, size_32)

#undef CDPREP_FIELD
#define CDPREP_FIELD(type, field, place_64, place_32) \
    {#type, #field, offsetof(type, field), sizeof(type::field), place_64, place_32},
const std::vector<FieldEntry> kFields = {
#include "c_abi.inc"
};
#undef CDPREP_FIELD
#define CDPREP_FIELD(type, field, place_64, place_32)

#undef CDPREP_VALUE
#define CDPREP_VALUE(name, value) {#name, std::int64_t{name}, value},
const std::vector<ValueEntry> kValues = {
#include "c_abi.inc"
};
#undef CDPREP_VALUE
#define CDPREP_VALUE(name, value)

#undef CDPREP_FUNCTION
#define CDPREP_FUNCTION(name, ...) reinterpret_cast<void (*)()>(&(name)),
const std::vector<void (*)()> kFunctions = {
#include "c_abi.inc"
};

constexpr bool kIs64 = UINTPTR_MAX == UINT64_MAX;
struct Double {
    char before;
    double number;
};
/// On i386, doubles within structs start at multiples of 4; that is another list.
constexpr bool kIsListed = offsetof(Double, number) == 8;

TEST(CAbi, SizesAndPlacesAreWhatTheyWere) {
    if (!kIsListed) GTEST_SKIP() << "doubles are aligned to 4 bytes here";
    EXPECT_GT(kStructs.size(), 70u);
    EXPECT_GT(kFields.size(), 400u);
    for (const StructEntry& type : kStructs) {
        EXPECT_EQ(type.size, kIs64 ? type.size_64 : type.size_32) << type.name;
    }
    for (const FieldEntry& field : kFields) {
        EXPECT_EQ(field.place, kIs64 ? field.place_64 : field.place_32)
            << field.of << "." << field.name;
    }
}

// Where a field is not listed, there would be a hole.
TEST(CAbi, EveryFieldIsListed) {
    if (!kIs64) GTEST_SKIP() << "structs have padding here";
    std::map<std::string, std::size_t> ends;
    for (const FieldEntry& field : kFields) {
        EXPECT_EQ(field.place, ends[field.of]) << field.of << "." << field.name;
        ends[field.of] = field.place + field.extent;
    }
    for (const StructEntry& type : kStructs) EXPECT_EQ(ends[type.name], type.size) << type.name;
}

TEST(CAbi, NumbersAreWhatTheyWere) {
    EXPECT_GT(kValues.size(), 150u);
    for (const ValueEntry& value : kValues) EXPECT_EQ(value.value, value.expected) << value.name;
}

// The linker finds all of them, and each is one of its own.
TEST(CAbi, EveryFunctionIsThere) {
    EXPECT_GT(kFunctions.size(), 150u);
    const std::set<void (*)()> distinct(kFunctions.begin(), kFunctions.end());
    EXPECT_EQ(distinct.size(), kFunctions.size());
}

/// What an initialiser writes, read as any caller could.
template <class T>
std::uint32_t tag_of(void (*init)(T*, std::size_t)) {
    T made;
    init(&made, sizeof made);
    EXPECT_EQ(made.head.size, sizeof made);
    return made.head.tag;
}

// Fixed once: a struct that an older program initialised is known by its tag.
TEST(CAbi, TagsAreWhatTheyWere) {
    EXPECT_EQ(tag_of(cdprep_workspace_options_init), 0xcd500001U);
    EXPECT_EQ(tag_of(cdprep_open_options_init), 0xcd500002U);
    EXPECT_EQ(tag_of(cdprep_pair_init), 0xcd500003U);
    EXPECT_EQ(tag_of(cdprep_distance_options_init), 0xcd500004U);
    EXPECT_EQ(tag_of(cdprep_contact_options_init), 0xcd500005U);
    EXPECT_EQ(tag_of(cdprep_hull_pair_init), 0xcd500006U);
    EXPECT_EQ(tag_of(cdprep_point_query_init), 0xcd500007U);
    EXPECT_EQ(tag_of(cdprep_ray_query_init), 0xcd500008U);
    EXPECT_EQ(tag_of(cdprep_shape_query_init), 0xcd500009U);
    EXPECT_EQ(tag_of(cdprep_build_options_init), 0xcd50000aU);
    EXPECT_EQ(tag_of(cdprep_layer_pair_init), 0xcd50000bU);
    EXPECT_EQ(tag_of(cdprep_model_use_init), 0xcd50000cU);
    EXPECT_EQ(tag_of(cdprep_plan_options_init), 0xcd50000dU);
    EXPECT_EQ(tag_of(cdprep_object_options_init), 0xcd50000eU);
    EXPECT_EQ(tag_of(cdprep_broad_phase_options_init), 0xcd50000fU);
    EXPECT_EQ(tag_of(cdprep_box_update_init), 0xcd500010U);
    EXPECT_EQ(tag_of(cdprep_live_options_init), 0xcd500011U);
    EXPECT_EQ(tag_of(cdprep_live_move_init), 0xcd500012U);
    EXPECT_EQ(tag_of(cdprep_self_query_init), 0xcd500013U);
    EXPECT_EQ(tag_of(cdprep_moving_pair_init), 0xcd500014U);
    EXPECT_EQ(tag_of(cdprep_window_options_init), 0xcd500015U);
    EXPECT_EQ(tag_of(cdprep_draw_init), 0xcd500016U);
}

}  // namespace
