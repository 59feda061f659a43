# SPDX-License-Identifier: MIT
# The options of every target of ours. They follow CMAKE_CXX_FLAGS, and must undo what changes
# answers there: a fused a * b + c, sums in another order, NaN and infinity taken for impossible.
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()

function(cdprep_compile_options target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "MSVC")
        if(MSVC_VERSION LESS 1930)
            message(FATAL_ERROR "cdprep needs Visual Studio 2022: earlier compilers fuse a * b + c, "
                "which changes answers.")
        endif()
        # Never tried. Attributes of GCC are without effect (5030).
        target_compile_options(${target} PRIVATE
            /W4 /wd5030 /permissive- /utf-8 /Zc:__cplusplus /fp:precise)
        target_compile_definitions(${target} PRIVATE _CRT_SECURE_NO_WARNINGS)  # std::getenv
        return()
    endif()
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Werror=return-type
        -fno-fast-math -fno-unsafe-math-optimizations -fno-associative-math -fno-reciprocal-math
        -fno-finite-math-only -fsigned-zeros -ffp-contract=off
        # A source of CGAL collects garbage many times over. With this heap, in kilobytes, GCC
        # hardly does, and compiles it in nine tenths of the time.
        $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>
        # GCC 12.2 drops two of the three roundings of `p = {float(p.x), float(p.y),
        # float(p.z)}` in a loop over points of doubles.
        $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
        # There GCC takes a format of printf() for that of an old C library. Linux checks them.
        $<$<BOOL:${MINGW}>:-Wno-format;-Wno-format-extra-args>
        # GCC takes what is nameless in an included source for a mistake of a header.
        $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wno-subobject-linkage>)
endfunction()
