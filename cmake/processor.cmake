# SPDX-License-Identifier: MIT
# CDPREP_PROCESSOR: x86_64, aarch64, wasm32 or other, which chooses the kernels. The compiler says
# it: CMAKE_SYSTEM_PROCESSOR is that of this machine if CMAKE_OSX_ARCHITECTURES, the option -A of
# Visual Studio or the compiler itself chooses another. Emscripten's own file for CMake says x86.
include(CheckCXXSourceCompiles)

list(LENGTH CMAKE_OSX_ARCHITECTURES architectures)
if(APPLE AND architectures GREATER 1)
    list(JOIN CMAKE_OSX_ARCHITECTURES " and " architectures)
    message(FATAL_ERROR "CMAKE_OSX_ARCHITECTURES names ${architectures}, but cdprep has kernels for "
        "each processor: build it for one at a time, and join the libraries with lipo.")
endif()

# Sets `processor` if a condition on the macros of the compiler holds.
function(cdprep_set_processor processor condition)
    set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # nothing needs to be linked
    set(CMAKE_REQUIRED_QUIET ON)
    set(holds CDPREP_COMPILES_FOR_${processor}_${CMAKE_OSX_ARCHITECTURES})
    check_cxx_source_compiles("
        #if !(${condition})
        #error another processor
        #endif
        int answer = 0;" ${holds})
    if(${holds})
        set(CDPREP_PROCESSOR ${processor} PARENT_SCOPE)
    endif()
endfunction()

set(CDPREP_PROCESSOR other)
# ARM64EC has the macros of x64, but not its instructions.
cdprep_set_processor(x86_64 "defined(__x86_64__) || (defined(_M_X64) && !defined(_M_ARM64EC))")
cdprep_set_processor(aarch64 "defined(__aarch64__) || defined(_M_ARM64)")
cdprep_set_processor(wasm32 "defined(__wasm__)")
