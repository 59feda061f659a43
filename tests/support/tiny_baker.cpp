// SPDX-License-Identifier: MIT
#include "support/tiny_baker.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "cdprep/advanced/build_image.h"
#include "cdprep/advanced/build_model.h"

namespace cdprep::test {
namespace {

/// Ends the test program when something cannot be built.
template <class T>
T or_abort(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().message.c_str());
        std::abort();
    }
    return std::move(result).value();
}

AlignedBytes image_of(const format::FileHeader& facts, std::span<const build::Section> sections,
                      std::uint64_t section_alignment) {
    const build::ImageOptions options{.section_alignment = section_alignment};
    AlignedBytes file(or_abort(build::image_size(sections, options)));
    or_abort(build::build_image(facts, sections, file.span(), options));
    return file;
}

}  // namespace

AlignedBytes assemble(const format::FileHeader& facts, const std::vector<TinySection>& sections,
                      std::uint64_t section_alignment) {
    std::vector<build::Section> views;
    for (const TinySection& made : sections) views.push_back({made.id, made.bytes});
    return image_of(facts, views, section_alignment);
}

AlignedBytes bake_tiny(std::span<const Double3> positions, std::span<const Triangle> triangles,
                       const TinyOptions& options) {
    return bake_tiny(positions, triangles,
                     build::build_bvh(positions, triangles,
                                      {.bounds = options.bounds, .quality = options.quality}),
                     options);
}

AlignedBytes bake_tiny(std::span<const Double3> positions, std::span<const Triangle> triangles,
                       const build::Bvh& bvh, const TinyOptions& options) {
    const build::ModelArrays arrays =
        build::arrange_model(positions, triangles, bvh,
                             options.double_precision ? build::Precision::double_precision
                                                      : build::Precision::single_precision);
    format::SectionSet wanted = format::SectionSet::all();
    for (std::uint32_t number = 1; number < 64; ++number) {
        if (options.leave_out.contains(SectionId{number})) wanted.erase(SectionId{number});
    }
    return image_of(arrays.facts, arrays.sections(wanted).sections(), options.section_alignment);
}

}  // namespace cdprep::test
