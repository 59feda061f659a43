// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Functions with this attribute are also compiled for AVX2; the program loader chooses the
// version. The thread sanitizer is not yet initialised then, but the choice would call it.
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define CDPREP_WITH_AVX2 [[gnu::target_clones("avx2", "default")]]
#else
#define CDPREP_WITH_AVX2
#endif
