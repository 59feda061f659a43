// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/model.h"

namespace cdprep::report {

/// Sections of an open model, and their bytes.
struct SectionBytes {
    struct Row {
        const char* name;
        std::uint64_t bytes;
    };
    std::vector<Row> rows;
    std::uint64_t bytes = 0;
};

/// The sections of a model's file. The model touches only those that it was opened with.
struct SectionUse {
    SectionBytes read;
    SectionBytes untouched;
};
[[nodiscard]] SectionUse use_of(const Model& model);

/// Returns the bytes of the sections of a set that the model was opened with.
[[nodiscard]] std::uint64_t bytes_of(const Model& model, format::SectionSet sections);

}  // namespace cdprep::report
