// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <span>

#include "support/aligned_bytes.h"
#include "support/aligned_heap.h"
#include "support/meshes.h"

#include "cdprep/cdprep.h"
#include "cdprep/pose.h"

namespace cdprep::test {

/// Returns a pose of C++ as one of C.
inline cdprep_pose rows_in_c(const Pose& pose) {
    cdprep_pose to{};
    std::copy(pose.rotation().begin(), pose.rotation().end(), std::begin(to.rows));
    to.rows[9] = pose.translation().x;
    to.rows[10] = pose.translation().y;
    to.rows[11] = pose.translation().z;
    return to;
}

/// A model that is opened through the C API. Ends the test program on failure. The bytes must
/// outlive the model.
class CModel {
public:
    explicit CModel(std::span<const std::byte> bytes, std::uint32_t ask = 0) {
        cdprep_open_options options;
        cdprep_open_options_init(&options, sizeof options);
        options.ask = ask;
        cdprep_error error;
        if (cdprep_model_open_memory(bytes.data(), bytes.size(), &options, &model_, &error) !=
            CDPREP_OK) {
            std::fprintf(stderr, "%s\n", error.message);
            std::abort();
        }
    }
    explicit CModel(const AlignedBytes& file, std::uint32_t ask = 0) : CModel(file.span(), ask) {}
    CModel(const CModel&) = delete;
    CModel& operator=(const CModel&) = delete;
    ~CModel() {
        cdprep_model_close(model_);
    }
    [[nodiscard]] const cdprep_model* get() const {
        return model_;
    }

private:
    cdprep_model* model_ = nullptr;
};

/// Blocks that a caller gives and takes back. The library gets none while `is_empty` is true.
struct Blocks {
    std::size_t given = 0;
    std::size_t taken = 0;
    bool is_empty = false;

    static void* give(void* blocks, std::size_t size, std::size_t alignment) {
        auto* const self = static_cast<Blocks*>(blocks);
        if (self->is_empty) return nullptr;
        ++self->given;
        return aligned_heap(size, alignment);
    }
    static void take(void* blocks, void* memory, std::size_t /*size*/) {
        ++static_cast<Blocks*>(blocks)->taken;
        free_aligned(memory);
    }
    cdprep_allocator allocator = {give, take, this};
};

/// Returns options for building this mesh. They point to the mesh's arrays.
inline cdprep_build_options build_options_of(const TestMesh& mesh) {
    cdprep_build_options options;
    cdprep_build_options_init(&options, sizeof options);
    if (mesh.positions.empty()) return options;
    options.positions = &mesh.positions[0].x;
    options.vertex_count = mesh.positions.size();
    if (mesh.triangles.empty()) return options;
    options.triangles = mesh.triangles[0].vertex.data();
    options.triangle_count = mesh.triangles.size();
    return options;
}

/// A model that is built through the C API. Ends the test program on failure.
class CBuilt {
public:
    CBuilt(const cdprep_build_options& options, cdprep_workspace* workspace) {
        cdprep_error error;
        if (cdprep_model_build(&options, nullptr, 0, workspace, &model_, &error) != CDPREP_OK) {
            std::fprintf(stderr, "%s\n", error.message);
            std::abort();
        }
    }
    CBuilt(const CBuilt&) = delete;
    CBuilt& operator=(const CBuilt&) = delete;
    ~CBuilt() {
        cdprep_model_close(model_);
    }
    [[nodiscard]] const cdprep_model* get() const {
        return model_;
    }

private:
    cdprep_model* model_ = nullptr;
};

/// A workspace for all structures.
class CWorkspace {
public:
    CWorkspace() {
        cdprep_workspace_options options;
        cdprep_workspace_options_init(&options, sizeof options);
        options.cells = cdprep_cells();
        if (cdprep_workspace_make(&options, nullptr, 0, &workspace_, nullptr) != CDPREP_OK) {
            std::abort();
        }
    }
    CWorkspace(const CWorkspace&) = delete;
    CWorkspace& operator=(const CWorkspace&) = delete;
    ~CWorkspace() {
        cdprep_workspace_end(workspace_);
    }
    [[nodiscard]] cdprep_workspace* get() const {
        return workspace_;
    }

private:
    cdprep_workspace* workspace_ = nullptr;
};

}  // namespace cdprep::test
