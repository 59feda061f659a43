// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/hdf5_layout.h"

#include <hdf5.h>

#include <array>
#include <cstring>
#include <utility>

#include "cdprep/format/sections.h"
#include "write/hdf5_in_memory.h"

// The bytes of HDF5 depend only on the content under two conditions. Time stamps are off for
// the file, its groups and its datasets, and the library version is pinned. Alignment belongs
// to the open file, not to the dataset. Large sections (aligned to pages) and small ones
// (aligned to cache lines) are therefore created in two opens.

namespace cdprep::write {
namespace {

using format::SectionId;

constexpr const char* kGroup = "/cdprep";

/// An HDF5 identifier that closes itself.
class Handle {
public:
    Handle(hid_t id, herr_t (*closer)(hid_t)) noexcept : id_(id), close_(closer) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    [[nodiscard]] hid_t id() const noexcept {
        return id_;
    }
    [[nodiscard]] bool good() const noexcept {
        return id_ >= 0;
    }
    /// Closes now and returns true on success. HDF5 writes on close, so this can fail.
    [[nodiscard]] bool close() noexcept {
        return id_ >= 0 && close_(std::exchange(id_, -1)) >= 0;
    }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Suppresses error output of HDF5 while this object lives.
class Silence {
public:
    Silence() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;
    ~Silence() {
        H5Eset_auto2(H5E_DEFAULT, print_, data_);
    }

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

// --- Element types -----------------------------------------------------------

hid_t scalar_type(format::Scalar scalar) {
    using enum format::Scalar;
    switch (scalar) {
        case u8:
            return H5T_STD_U8LE;
        case u32:
            return H5T_STD_U32LE;
        case i32:
            return H5T_STD_I32LE;
        case u64:
            return H5T_STD_U64LE;
        case f32:
            return H5T_IEEE_F32LE;
        default:
            return H5T_IEEE_F64LE;
    }
}

Handle field_type(const format::Field& field) {
    std::vector<hsize_t> shape;
    for (const std::uint32_t extent : field.shape) {
        if (extent != 0) shape.push_back(extent);
    }
    const hid_t scalar = scalar_type(field.scalar);
    if (shape.empty()) return {H5Tcopy(scalar), H5Tclose};
    return {H5Tarray_create2(scalar, static_cast<unsigned>(shape.size()), shape.data()), H5Tclose};
}

/// Returns the HDF5 type of a dataset whose rows are such elements.
Handle element_type(const format::Element& element) {
    if (element.fields.empty()) return {H5Tcopy(scalar_type(element.scalar)), H5Tclose};
    Handle type(H5Tcreate(H5T_COMPOUND, element.size), H5Tclose);
    for (const format::Field& field : element.fields) {
        const Handle of_field = field_type(field);
        H5Tinsert(type.id(), field.name, field.offset, of_field.id());
    }
    return type;
}

bool has_columns(const format::Element& element) {
    return element.columns > 1;
}

// --- Making ---------------------------------------------------------------------

bool add_text(hid_t object, const char* name, const char* text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), std::strlen(text));
    H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(
        H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    return attribute.good() && H5Awrite(attribute.id(), type.id(), text) >= 0;
}

template <std::size_t N>
bool add_numbers(hid_t object, const char* name, const std::array<double, N>& values) {
    const std::array<hsize_t, 1> extent = {N};
    const Handle space(N == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, extent.data(), nullptr),
                       H5Sclose);
    const Handle attribute(
        H5Acreate2(object, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    return attribute.good() && H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, values.data()) >= 0;
}

bool add_integer(hid_t object, const char* name, std::int32_t value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(
        H5Acreate2(object, name, H5T_STD_I32LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    return attribute.good() && H5Awrite(attribute.id(), H5T_NATIVE_INT32, &value) >= 0;
}

const char* axis_name(format::UpAxis axis) {
    constexpr std::array<const char*, 4> kNames = {"unknown", "x", "y", "z"};
    return kNames[static_cast<std::size_t>(axis)];
}

/// Adds the facts that h5py needs to place boxes and to measure lengths. The header in front is
/// not part of HDF5.
bool add_facts(hid_t group, const format::FileHeader& facts) {
    const format::Double3& origin = facts.frame_origin;
    const format::Double3& offset = facts.normalize_offset;
    const bool is_normalized = (facts.flags & format::model_normalized) != 0;
    return add_integer(group, "format_version", static_cast<std::int32_t>(format::kVersion)) &&
           add_numbers<1>(group, "metres_per_unit", {facts.metres_per_unit}) &&
           add_text(group, "up_axis", axis_name(facts.up_axis)) &&
           add_text(group, "frame",
                    "boxes are in frame units: (model - frame_origin) * 2^frame_exponent") &&
           add_numbers<3>(group, "frame_origin", {origin.x, origin.y, origin.z}) &&
           add_integer(group, "frame_exponent", facts.frame_exponent) &&
           (!is_normalized ||
            (add_numbers<3>(group, "normalize_offset", {offset.x, offset.y, offset.z}) &&
             add_numbers<1>(group, "normalize_factor", {facts.normalize_factor})));
}

constexpr const char* kName = "in memory";

Handle access_list(SparseMemory& memory, std::uint64_t threshold, std::uint64_t alignment) {
    Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_alignment(list.id(), threshold, alignment);
    H5Pset_libver_bounds(list.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
    if (!keep_in_memory(list.id(), memory)) return {-1, H5Pclose};
    return list;
}

void keep_links_simple(const Handle& creation) {
    constexpr unsigned kMostCompactLinks = 65000;
    H5Pset_link_phase_change(creation.id(), kMostCompactLinks, 0);
    H5Pset_obj_track_times(creation.id(), false);
}

/// Creates an empty file with a user block and our group.
bool make_file(SparseMemory& memory, const format::FileHeader& facts) {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_userblock(creation.id(), format::kUserBlockSize);
    keep_links_simple(creation);
    const Handle access = access_list(memory, 1, format::kSectionAlignment);
    Handle file(H5Fcreate(kName, H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
    if (!file.good()) return false;
    const Handle group_creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    keep_links_simple(group_creation);
    Handle group(H5Gcreate2(file.id(), kGroup, H5P_DEFAULT, group_creation.id(), H5P_DEFAULT),
                 H5Gclose);
    const bool described =
        group.good() &&
        add_text(group.id(), "description", "a mesh baked for exact collision queries") &&
        add_facts(group.id(), facts);
    return described && group.close() && file.close();
}

std::vector<hsize_t> shape_of(const format::Element& element, std::uint64_t count) {
    if (!has_columns(element)) return {count};
    return {count, element.columns};
}

std::optional<Place> make_dataset(const Handle& file, const Plan& plan) {
    const format::SectionKind* kind = format::find_section_kind(plan.id);
    if (kind == nullptr) return std::nullopt;
    const std::vector<hsize_t> shape = shape_of(kind->element, plan.count);
    const Handle type = element_type(kind->element);
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.id(), false);
    H5Pset_layout(creation.id(), H5D_CONTIGUOUS);
    H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
    const std::string name = std::string(kGroup) + "/" + kind->name;
    Handle dataset(H5Dcreate2(file.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT,
                              creation.id(), H5P_DEFAULT),
                   H5Dclose);
    if (!dataset.good() || !add_text(dataset.id(), "units", kind->units) ||
        !add_text(dataset.id(), "description", kind->description)) {
        return std::nullopt;
    }
    const haddr_t offset = H5Dget_offset(dataset.id());
    if (offset == HADDR_UNDEF || !dataset.close()) return std::nullopt;
    return Place{plan.id, offset, plan.count};
}

bool is_large(const Plan& plan) {
    return plan.count * format::element_size(plan.id) >= format::kPageThreshold;
}

/// Creates the large or the small datasets, all in one open.
bool make_datasets(SparseMemory& memory, std::span<const Plan> plans, bool large,
                   std::vector<Place>& places) {
    const Handle access = large
                              ? access_list(memory, format::kPageThreshold, format::kPageAlignment)
                              : access_list(memory, 1, format::kSectionAlignment);
    Handle file(H5Fopen(kName, H5F_ACC_RDWR, access.id()), H5Fclose);
    if (!file.good()) return false;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (is_large(plans[i]) != large) continue;
        const std::optional<Place> place = make_dataset(file, plans[i]);
        if (!place) return false;
        places[i] = *place;
    }
    return file.close();
}

// --- Finding --------------------------------------------------------------------

std::string clause(SectionId id, const char* what) {
    return std::string("dataset ") + format::section_name(id) + " " + what;
}

/// Adds the place of one dataset of a file that another tool may have written. Returns a clause
/// that describes the damage, or "".
std::string find_place(const Handle& file, const format::SectionKind& kind,
                       std::vector<Place>& places) {
    const std::string name = std::string(kGroup) + "/" + kind.name;
    if (H5Lexists(file.id(), name.c_str(), H5P_DEFAULT) <= 0) return {};
    const Handle dataset(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.good()) return clause(kind.id, "cannot be opened");
    const Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const Handle expected = element_type(kind.element);
    if (H5Tequal(type.id(), expected.id()) <= 0) return clause(kind.id, "has another type");
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    std::array<hsize_t, 2> shape{};
    const bool two_dimensional = has_columns(kind.element);
    const int expected_rank = two_dimensional ? 2 : 1;
    if (H5Sget_simple_extent_ndims(space.id()) != expected_rank ||
        H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr) != expected_rank ||
        (two_dimensional && shape[1] != kind.element.columns)) {
        return clause(kind.id, "has another shape");
    }
    const Handle creation(H5Dget_create_plist(dataset.id()), H5Pclose);
    const haddr_t offset = H5Dget_offset(dataset.id());
    if (H5Pget_layout(creation.id()) != H5D_CONTIGUOUS || offset == HADDR_UNDEF) {
        return clause(kind.id, "is not stored contiguously and uncompressed");
    }
    places.push_back({kind.id, offset, shape[0]});
    return {};
}

}  // namespace

std::optional<Layout> make_layout(std::span<const Plan> plans, const format::FileHeader& facts) {
    const Silence silence;
    Layout layout{std::vector<Place>(plans.size()), {}};
    const bool made = make_file(layout.rest, facts) &&
                      make_datasets(layout.rest, plans, true, layout.places) &&
                      make_datasets(layout.rest, plans, false, layout.places);
    if (!made) return std::nullopt;
    return layout;
}

FoundLayout find_layout(const std::filesystem::path& path) {
    const Silence silence;
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.good()) return {{}, "it is not a readable HDF5 file"};
    FoundLayout found;
    for (const format::SectionKind& kind : format::section_kinds()) {
        const std::string damage = find_place(file, kind, found.places);
        if (!damage.empty()) return {{}, damage};
    }
    if (found.places.empty()) found.damage = "it contains no dataset of cdprep";
    return found;
}

}  // namespace cdprep::write
