// SPDX-License-Identifier: MIT
// Leaks that the address sanitizer does not report of the program that imports. It starts with an
// empty environment, so it is compiled in. assimp leaks when an import fails.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libassimp.so";
}
