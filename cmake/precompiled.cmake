# SPDX-License-Identifier: MIT
# Headers that most files include are parsed once. Sources still include what they use: the lint
# stage of tests/run compiles without this. <iostream> is left out, because it adds code to each
# file that includes it.
set(CDPREP_COMMON_HEADERS <algorithm> <array> <atomic> <bit> <cassert> <charconv> <cmath> <cstddef>
    <cstdint> <cstdio> <cstring> <filesystem> <functional> <limits> <map> <memory>
    <numeric> <optional> <span> <string> <string_view> <tuple> <utility> <vector>)
if(CDPREP_PROCESSOR STREQUAL "wasm32")  # which has no files
    list(REMOVE_ITEM CDPREP_COMMON_HEADERS <filesystem>)
endif()

# The sources of target include the common headers and those named further. Targets that name the
# same, and are compiled with the same options, share the file of the first: a macro that it alone
# defines would make the file useless to the others.
function(cdprep_precompile target)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "EXECUTABLE")
        set(type program)  # position-independent in another way
    else()
        set(type library)
    endif()
    get_target_property(options ${target} COMPILE_OPTIONS)
    get_target_property(definitions ${target} COMPILE_DEFINITIONS)
    get_target_property(visibility ${target} CXX_VISIBILITY_PRESET)
    get_target_property(sources ${target} SOURCES)
    if(sources MATCHES "\\.c(;|$)")
        set(type ${target})  # CMake would look for a file for C beside that of another target
    endif()
    string(MD5 key "${type} ${ARGN} ${options} ${definitions} ${visibility}")
    get_property(owner GLOBAL PROPERTY CDPREP_PRECOMPILED_${key})
    # ccache keeps what is compiled with such a file if it sees which one. GCC 12 then also warns,
    # wrongly, of inlined code of the standard library.
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:\
-fpch-preprocess;-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>")
    if(owner)
        target_precompile_headers(${target} REUSE_FROM ${owner})
    else()
        set_property(GLOBAL PROPERTY CDPREP_PRECOMPILED_${key} ${target})
        # For C++ alone: some targets have files in C.
        set(headers ${CDPREP_COMMON_HEADERS} ${ARGN})
        list(TRANSFORM headers REPLACE "<(.+)>"
            "$<$<COMPILE_LANGUAGE:CXX>:<\\1$<ANGLE-R>>")
        target_precompile_headers(${target} PRIVATE ${headers})
    endif()
endfunction()
