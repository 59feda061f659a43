// SPDX-License-Identifier: MIT
#include "c/c_model.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#ifndef __wasi__
#include <filesystem>
#endif
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "cdprep/format/sections.h"
#ifndef __wasi__
#include "core/mapped_file.h"
#endif

namespace cdprep::c {
namespace {

constexpr std::array kFields = {
    Field{"mode", offsetof(cdprep_open_options, mode), Holds::choice, CDPREP_MAP_TRUSTED},
};

/// The sections that descriptions read, for any query.
constexpr SectionSet kAlways = {SectionId::bounds, SectionId::provenance, SectionId::verdicts,
                                SectionId::findings, SectionId::repaired_from};

/// Checked options of opening.
struct Asked {
    cdprep_open_options options{};
    cdprep_allocator allocator{};
    OpenOptions open;
};

int read(Call& call, const cdprep_open_options* given, Asked& asked) noexcept {
    const Name name = {"options"};
    if (const int code = read_options(call, name, given, asked.options)) return code;
    const cdprep_open_options& options = asked.options;
    if (const int code = check_asks(call, name.of("ask"), options.ask)) return code;
    if (const int code =
            read_allocator(call, name.of("allocator"), options.allocator, asked.allocator)) {
        return code;
    }
    asked.open.asks = static_cast<Ask>(options.ask);
    if (options.ask != 0) asked.open.sections = kAlways;
    if (options.name != nullptr) asked.open.name = options.name;
    return CDPREP_OK;
}

/// Reports a failure to open. If the requested sections are missing, the file was not baked for the
/// query.
int fail_opening(Call& call, const Error& error, const Asked& asked) noexcept {
    if (error.code != ErrorCode::bad_argument) {
        return call.fail(static_cast<int>(error.code), error.message);
    }
    if (asked.open.asks == Ask::nothing) {
        return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, {"bytes"}, error.message);
    }
    return call.refuse_with(CDPREP_WHY_NOT_BAKED, Name{"options"}.of("ask"), error.message);
}

void release_all(const Memory& object, const Memory& bytes, const Memory& index) noexcept {
    release(index);
    release(bytes);
    release(object);
}

/// Makes the model. It takes over the opened Model and the copy of its bytes.
int make_model(Call& call, const Asked& asked, Model&& model, const Memory& bytes,
               cdprep_model** to) noexcept {
    Memory object, index;
    int code = allocate(call, asked.allocator, sizeof(cdprep_model), object);
    if (code == CDPREP_OK) code = allocate(call, asked.allocator, index_size(model), index);
    if (code != CDPREP_OK) {
        { const Model ended = std::move(model); }  // its bytes are released next
        release_all(object, bytes, index);
        return code;
    }
    *to = new (object.start) cdprep_model(std::move(model), object, bytes, index);
    make_index(**to, index.start);
    return CDPREP_OK;
}

int check_alignment(Call& call, std::span<const std::byte> bytes) noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(bytes.data());
    if (address % CDPREP_ALIGNMENT == 0) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"bytes"},
                       "does not start at a multiple of %d; CDPREP_COPY takes any address.",
                       CDPREP_ALIGNMENT);
}

/// Opens the caller's bytes in place.
int open_in_place(Call& call, const Asked& asked, std::span<const std::byte> bytes,
                  cdprep_model** to) {
    if (const int code = check_alignment(call, bytes)) return code;
    Result<Model> opened = Model::open(bytes, asked.open);
    if (!opened) return fail_opening(call, opened.error(), asked);
    return make_model(call, asked, std::move(opened).value(), {}, to);
}

/// Opens a copy, which the model takes over.
int open_copied(Call& call, const Asked& asked, OwnedMemory& copy, cdprep_model** to) {
    const Memory& memory = copy.get();
    Result<Model> opened =
        Model::open({static_cast<const std::byte*>(memory.start), memory.size}, asked.open);
    if (!opened) return fail_opening(call, opened.error(), asked);
    return make_model(call, asked, std::move(opened).value(), copy.take(), to);
}

int open_copy(Call& call, const Asked& asked, std::span<const std::byte> bytes, cdprep_model** to) {
    OwnedMemory copy;
    if (const int code = copy.allocate(call, asked.allocator, bytes.size())) return code;
    if (!bytes.empty()) std::memcpy(copy.get().start, bytes.data(), bytes.size());
    return open_copied(call, asked, copy, to);
}

int fail_reading(Call& call, const std::string& path, const char* why) {
    return call.fail(CDPREP_UNREADABLE, path + ": " + why);
}

#ifdef __wasi__
int open_path(Call& call, const Asked& /*asked*/, const char* utf8, cdprep_model** /*to*/) {
    return call.fail(CDPREP_UNREADABLE,
                     std::string(utf8) + ": this build reads no files, only bytes in memory.");
}
#else
struct CloseFile {
    void operator()(std::FILE* file) const noexcept {
        std::fclose(file);
    }
};

/// Fills all of `bytes`. Some C libraries count the bytes of one call in 32 bits.
bool read_whole(std::FILE* file, std::span<std::byte> bytes) noexcept {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // of a call
    std::size_t done = 0;
    while (done < bytes.size()) {
        const std::size_t wanted = std::min(kMost, bytes.size() - done);
        const std::size_t got = std::fread(bytes.data() + done, 1, wanted, file);
        if (got == 0) return false;
        done += got;
    }
    return true;
}

/// Reads the file, without mapping it.
int open_copy(Call& call, const Asked& asked, const std::filesystem::path& path,
              cdprep_model** to) {
    const std::string name = path_text(path);
    std::error_code failed;
    if (!std::filesystem::is_regular_file(path, failed)) {
        return fail_reading(call, name, "is not there, or is not a regular file.");
    }
    const std::unique_ptr<std::FILE, CloseFile> file(open_to_read(path));
    if (file == nullptr) return fail_reading(call, name, "cannot be opened.");
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed) return fail_reading(call, name, "its size cannot be read.");
    OwnedMemory copy;
    if (const int code = copy.allocate(call, asked.allocator, size)) return code;
    if (!read_whole(file.get(), {static_cast<std::byte*>(copy.get().start), size})) {
        return fail_reading(call, name, "cannot be read to its end.");
    }
    Asked named = asked;
    named.open.name = name;
    return open_copied(call, named, copy, to);
}

int open_trusted(Call& call, const Asked& asked, const std::filesystem::path& path,
                 cdprep_model** to) {
    Result<Model> opened = Model::open_trusted(path);
    if (!opened) return fail_opening(call, opened.error(), asked);
    if (const std::optional<Refusal> refused = opened.value().refusal(asked.open.asks)) {
        return call.refuse_with(CDPREP_WHY_NOT_BAKED, Name{"options"}.of("ask"), refused->message);
    }
    return make_model(call, asked, std::move(opened).value(), {}, to);
}

int open_path(Call& call, const Asked& asked, const char* utf8, cdprep_model** to) {
    const std::optional<std::filesystem::path> named = path_from_utf8(utf8);
    if (!named) return call.fail(CDPREP_UNREADABLE, std::string(utf8) + ": is not UTF-8.");
    const std::filesystem::path& path = *named;
    if (asked.options.mode == CDPREP_COPY) return open_copy(call, asked, path, to);
    if (asked.options.mode == CDPREP_MAP_TRUSTED) return open_trusted(call, asked, path, to);
    Result<Model> opened = Model::open(path, asked.open);
    if (!opened) return fail_opening(call, opened.error(), asked);
    return make_model(call, asked, std::move(opened).value(), {}, to);
}
#endif

std::span<const std::byte> file_of(const Model& model) noexcept {
    const format::FileHeader& header = model.header();
    return {reinterpret_cast<const std::byte*>(&header),
            static_cast<std::size_t>(header.file_size)};
}

}  // namespace

const InputType Input<cdprep_open_options>::type = {"cdprep_open_options", 0xcd500002U,
                                                    sizeof(cdprep_open_options),
                                                    sizeof(cdprep_open_options), kFields};

cdprep_open_options Input<cdprep_open_options>::defaults() noexcept {
    return {};
}

int check_asks(Call& call, const Name& name, std::uint32_t ask) noexcept {
    const auto known = static_cast<std::uint32_t>(known_asks());
    if ((ask & ~known) == 0) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name,
                       "is 0x%x; this version knows only the bits 0x%x.", ask, known);
}

int check_serves(Call& call, const Name& name, const Model& model, Ask asks) {
    if (model.serves(asks)) [[likely]]
        return CDPREP_OK;
    const std::optional<Refusal> refused = model.refusal(asks);
    if (!refused) return CDPREP_OK;
    const bool is_opened = refused->reason == Refusal::Reason::not_opened;
    return call.refuse_with(is_opened ? CDPREP_WHY_NOT_OPENED : CDPREP_WHY_NOT_BAKED, name,
                            refused->message);
}

std::span<const std::byte> section_bytes(const Model& model, SectionId id) noexcept {
    if (!model.sections().contains(id)) return {};
    const std::span<const std::byte> file = file_of(model);
    const auto entry = format::find_section(file, id);
    if (!entry) return {};
    return file.subspan(entry->offset, entry->count * entry->element_size);
}

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;
using cdprep::c::Name;

static_assert(CDPREP_ASK_COLLIDE == static_cast<unsigned>(cdprep::Ask::collide) &&
              CDPREP_ASK_OVERLAP == static_cast<unsigned>(cdprep::Ask::overlap) &&
              CDPREP_ASK_DISTANCE == static_cast<unsigned>(cdprep::Ask::distance) &&
              CDPREP_ASK_WITHIN == static_cast<unsigned>(cdprep::Ask::within) &&
              CDPREP_ASK_CONTACTS == static_cast<unsigned>(cdprep::Ask::contacts) &&
              CDPREP_ASK_RESPONSE == static_cast<unsigned>(cdprep::Ask::response) &&
              CDPREP_ASK_CONTINUOUS == static_cast<unsigned>(cdprep::Ask::continuous) &&
              CDPREP_ASK_SELF == static_cast<unsigned>(cdprep::Ask::self) &&
              CDPREP_ASK_DEFORM == static_cast<unsigned>(cdprep::Ask::deform) &&
              CDPREP_ASK_TEAR == static_cast<unsigned>(cdprep::Ask::tear) &&
              CDPREP_ASK_HAPTIC == static_cast<unsigned>(cdprep::Ask::haptic) &&
              CDPREP_ASK_INSIDE == static_cast<unsigned>(cdprep::Ask::inside) &&
              CDPREP_ASK_RAY == static_cast<unsigned>(cdprep::Ask::ray) &&
              CDPREP_ASK_CLOSEST == static_cast<unsigned>(cdprep::Ask::closest) &&
              CDPREP_ASK_TOUCH == static_cast<unsigned>(cdprep::Ask::touch) &&
              CDPREP_ASK_HULLS == static_cast<unsigned>(cdprep::Ask::hulls) &&
              CDPREP_ASK_PIECES == static_cast<unsigned>(cdprep::Ask::pieces) &&
              CDPREP_ASK_CORNERS == static_cast<unsigned>(cdprep::Ask::corners) &&
              CDPREP_ASK_INACCESSIBLE == static_cast<unsigned>(cdprep::Ask::inaccessible) &&
              CDPREP_ASK_OCTREE == static_cast<unsigned>(cdprep::Ask::octree) &&
              CDPREP_ASK_ADAPTIVE_OCTREE == static_cast<unsigned>(cdprep::Ask::adaptive_octree) &&
              CDPREP_ASK_TETRA_TREE == static_cast<unsigned>(cdprep::Ask::tetra_tree) &&
              CDPREP_ASK_HASHED_OCTREE == static_cast<unsigned>(cdprep::Ask::hashed_octree) &&
              CDPREP_ASK_SOLID == static_cast<unsigned>(cdprep::Ask::solid));

void cdprep_open_options_init(cdprep_open_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

const char* cdprep_ask_name(uint32_t ask) {
    const cdprep::Needs* const row = cdprep::find_needs(static_cast<cdprep::Ask>(ask));
    return row == nullptr ? nullptr : row->name;
}

int cdprep_model_open(const char* utf8_path, const cdprep_open_options* options,
                      cdprep_model** model, cdprep_error* error) {
    if (model != nullptr) *model = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(utf8_path, {"utf8_path"})) return code;
        if (const int code = call.need(model, {"model"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        if (asked.options.name != nullptr) {
            return call.refuse(CDPREP_WHY_NO_MEANING, Name{"options"}.of("name"),
                               "is set, but messages name a file by its path; leave it at null.");
        }
        return cdprep::c::open_path(call, asked, utf8_path, model);
    });
}

int cdprep_model_open_memory(const void* bytes, size_t size, const cdprep_open_options* options,
                             cdprep_model** model, cdprep_error* error) {
    if (model != nullptr) *model = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(bytes, {"bytes"})) return code;
        if (const int code = call.need(model, {"model"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        const std::span<const std::byte> file(static_cast<const std::byte*>(bytes), size);
        switch (asked.options.mode) {
            case CDPREP_MAP:
                return cdprep::c::open_in_place(call, asked, file, model);
            case CDPREP_COPY:
                return cdprep::c::open_copy(call, asked, file, model);
            default:
                return call.refuse(CDPREP_WHY_NO_MEANING, Name{"options"}.of("mode"),
                                   "is CDPREP_MAP_TRUSTED, which is for files only.");
        }
    });
}

void cdprep_model_close(cdprep_model* model) {
    if (model == nullptr || !model->own) return;  // that of a live model or a window ends with it
    const cdprep::c::Memory object = model->object, bytes = model->bytes, index = model->index;
    std::destroy_at(model);
    cdprep::c::release_all(object, bytes, index);
}

int cdprep_model_serves(const cdprep_model* model, uint32_t ask, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = cdprep::c::check_asks(call, {"ask"}, ask)) return code;
        return check_serves(call, {"model"}, *model, static_cast<cdprep::Ask>(ask));
    });
}

int cdprep_model_prefetch(const cdprep_model* model, uint32_t ask, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = cdprep::c::check_asks(call, {"ask"}, ask)) return code;
        const auto asks = static_cast<cdprep::Ask>(ask);
        if (const int code = check_serves(call, {"model"}, *model, asks)) return code;
        static_cast<void>(model->model.touch(asks));
        return CDPREP_OK;
    });
}
