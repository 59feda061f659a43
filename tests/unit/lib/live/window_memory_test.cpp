// SPDX-License-Identifier: MIT
// In a program of its own, whose memory is all counted.
#include <gtest/gtest.h>

#include <cmath>

#include "cdprep/window.h"
#include "support/counted_memory.h"
#include "support/open_tiny.h"
#include "support/placements.h"

namespace cdprep::test {
namespace {

TEST(WindowMemory, NeitherLoopAllocates) {
    const OpenModel all = open_tiny(torus(1, 0.3, 60, 40), {.double_precision = true});
    const OpenModel probe = open_tiny(moved_by(icosphere(1), 0.1, {}));
    AlignedBytes memory(Window::bytes({200}).value());
    auto made = Window::in(memory.span(), {200});
    ASSERT_TRUE(made);
    Window& window = made.value();
    Workspace workspace;
    PairCache cache;
    LastDistance last;
    std::size_t complete = 0, late = 0;
    const std::size_t before = most = used;
    for (int step = 0; step < 2000; ++step) {
        const double angle = 0.004 * step;
        const Placement placement = shifted({std::cos(angle), std::sin(angle), 0.45});
        if (step % 20 == 0) {
            window.fill({all.model, probe.model, placement}, step % 40 == 0 ? 0.1 : 10);
        }
        const BoundedDistance found =
            window.distance({window.model(), probe.model, placement, {}, &cache}, workspace, {},
                            {.work = step % 3 == 0 ? 4U : 0U, .last = &last});
        (found.is_complete ? complete : late) += 1;
    }
    EXPECT_EQ(most, before);
    EXPECT_GT(complete, 300U);
    EXPECT_GT(late, 300U);
}

}  // namespace
}  // namespace cdprep::test
