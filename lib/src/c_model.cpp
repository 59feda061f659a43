// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <cstddef>
#include <cstring>
#include <utility>

namespace cdprep {
namespace {

int opened(Result<Model> result, cdprep_model** model, cdprep_error* error) {
    if (!result) return fail(error, result.error());
    *model = new cdprep_model{std::move(result).value()};
    return CDPREP_OK;
}

}  // namespace
}  // namespace cdprep

using cdprep::Model;

static_assert(sizeof(cdprep_verdict) == sizeof(cdprep::format::Verdict) &&
              offsetof(cdprep_verdict, genus) == offsetof(cdprep::format::Verdict, genus) &&
              offsetof(cdprep_verdict, volume) == offsetof(cdprep::format::Verdict, volume));
static_assert(CDPREP_PROMISE_SURFACE == int{cdprep::format::promise_surface} &&
              CDPREP_PROMISE_INSIDE_EXACT == int{cdprep::format::promise_inside_exact} &&
              CDPREP_PROMISE_SIMPLE_SOLID == int{cdprep::format::promise_simple_solid} &&
              CDPREP_PROMISE_CONTAINED_PIECES == int{cdprep::format::promise_contained_pieces});

int cdprep_open(const char* path, cdprep_model** model, cdprep_error* error) {
    if (cdprep::any_null(path, model)) return cdprep::null_argument(error);
    *model = nullptr;
    return cdprep::guarded(error, [&] { return cdprep::opened(Model::open(path), model, error); });
}

int cdprep_open_memory(const void* bytes, size_t size, const char* name, cdprep_model** model,
                       cdprep_error* error) {
    if (cdprep::any_null(bytes, name, model)) {
        return cdprep::null_argument(error);
    }
    *model = nullptr;
    return cdprep::guarded(error, [&] {
        const std::span<const std::byte> file(static_cast<const std::byte*>(bytes), size);
        return cdprep::opened(Model::open(file, {.name = name}), model, error);
    });
}

int cdprep_open_trusted(const char* path, cdprep_model** model, cdprep_error* error) {
    if (cdprep::any_null(path, model)) return cdprep::null_argument(error);
    *model = nullptr;
    return cdprep::guarded(error,
                           [&] { return cdprep::opened(Model::open_trusted(path), model, error); });
}

void cdprep_close(cdprep_model* model) {
    delete model;
}

uint32_t cdprep_triangle_count(const cdprep_model* model) {
    return model == nullptr ? 0 : model->model.triangle_count();
}

uint32_t cdprep_vertex_count(const cdprep_model* model) {
    return model == nullptr ? 0 : model->model.vertex_count();
}

int cdprep_is_closed(const cdprep_model* model) {
    return model != nullptr && model->model.is_closed() ? 1 : 0;
}

size_t cdprep_verdict_count(const cdprep_model* model) {
    return model == nullptr ? 0 : model->model.verdicts().size();
}

int cdprep_read_verdict(const cdprep_model* model, size_t number, cdprep_verdict* verdict) {
    if (verdict == nullptr || number >= cdprep_verdict_count(model)) return 0;
    std::memcpy(verdict, &model->model.verdicts()[number], sizeof *verdict);
    return 1;
}

const uint32_t* cdprep_repaired_from(const cdprep_model* model) {
    return model == nullptr ? nullptr : model->model.repaired_from().data();
}
