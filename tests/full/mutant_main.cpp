// SPDX-License-Identifier: MIT
// The main() of unit tests in the build of tests/full/mutants: says which test begins.
#include <gtest/gtest.h>

#include <string>

#include "mutant_switch.h"

namespace {

struct Listener : testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo& test) override {
        for (auto& met : mutant_met) met = false;
        tell(std::string("= ") + test.test_suite_name() + "." + test.name());
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        tell("took " + std::to_string(test.result()->elapsed_time()));
    }
    static void tell(const std::string& text) {
        if (kMutantsMet != nullptr) tell_mutants_met(text.c_str());
    }
};

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    testing::UnitTest::GetInstance()->listeners().Append(new Listener);
    return RUN_ALL_TESTS();
}
