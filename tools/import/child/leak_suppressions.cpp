// SPDX-License-Identifier: GPL-3.0-or-later
// The leaks of this program that the address sanitizer does not report. The program starts with an
// empty environment, so they are compiled in. assimp leaks when an import fails.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libassimp.so";
}
