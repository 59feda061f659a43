/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_FORMAT_API_H
#define CDPREP_FORMAT_API_H

/* CDPREP_API marks the functions that a shared library exports, in C and in C++. All other
 * functions are hidden. A static library exports nothing, and its functions stay hidden inside a
 * shared library. On Windows, CMake and pkg-config define CDPREP_SHARED for programs that link the
 * shared library. To use an export macro of your own, define CDPREP_API before you include this
 * header. */
#ifndef CDPREP_API
#if !defined(CDPREP_SHARED)
#define CDPREP_API
#elif defined(_WIN32) && defined(CDPREP_BUILDING)
#define CDPREP_API __declspec(dllexport)
#elif defined(_WIN32)
#define CDPREP_API __declspec(dllimport)
#else
#define CDPREP_API __attribute__((visibility("default")))
#endif
#endif

#endif /* CDPREP_FORMAT_API_H */
