// SPDX-License-Identifier: MIT
#include "cli/output_path.h"

#include <gtest/gtest.h>

#include <iostream>

namespace cdprep::cli {
namespace {

// The report must not mix with a mesh on standard output.
TEST(ReportStream, IsStandardErrorForAMeshOnStandardOutput) {
    EXPECT_EQ(&report_stream("-"), &std::cerr);
    for (const char* file : {"mesh.obj", "./-", "-.obj", ""}) {
        EXPECT_EQ(&report_stream(file), &std::cout) << file;
    }
}

}  // namespace
}  // namespace cdprep::cli
