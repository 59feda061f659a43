# SPDX-License-Identifier: MIT
# What the libraries show to programs that link them.

# The version of the binary interface: the 0 of libcdprep.so.0.
set(CDPREP_SOVERSION 0)

# Only functions that are marked with CDPREP_API can be seen outside the library of target: all of a
# shared library, none of a static one. Call this before cdprep_precompile().
function(cdprep_hide_symbols target)
    set_target_properties(${target} PROPERTIES
        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    if(NOT BUILD_SHARED_LIBS)
        return()
    endif()
    target_compile_definitions(${target} PRIVATE CDPREP_BUILDING CDPREP_SHARED)
    if(WIN32)  # who imports a function says so
        target_compile_definitions(${target} INTERFACE CDPREP_SHARED)
    endif()
    get_target_property(type ${target} TYPE)
    if(NOT type STREQUAL "SHARED_LIBRARY")
        return()
    endif()
    set_target_properties(${target} PROPERTIES
        VERSION ${PROJECT_VERSION} SOVERSION ${CDPREP_SOVERSION} DEFINE_SYMBOL "")
    # The standard library marks its templates as visible.
    if(UNIX AND NOT APPLE)
        set(map ${PROJECT_SOURCE_DIR}/cmake/exported.map)
        target_link_options(${target} PRIVATE LINKER:--version-script=${map})
        set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${map})
        if(NOT CMAKE_CXX_FLAGS MATCHES "sanitize")
            target_link_options(${target} PRIVATE LINKER:--no-undefined)
        endif()
    endif()
endfunction()

# What a linker for C must add for C++: -lstdc++ -lm. As flags, they are never taken for targets.
set(CDPREP_CXX_LIBRARY ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(REMOVE_ITEM CDPREP_CXX_LIBRARY ${CMAKE_C_IMPLICIT_LINK_LIBRARIES} c gcc gcc_s)
list(REMOVE_DUPLICATES CDPREP_CXX_LIBRARY)
list(TRANSFORM CDPREP_CXX_LIBRARY PREPEND -l)

# A program in C that links the static library of target links the C++ library too.
function(cdprep_link_cxx_library target)
    if(CDPREP_CXX_LIBRARY AND NOT BUILD_SHARED_LIBS)
        target_link_libraries(${target} INTERFACE
            "$<$<NOT:$<LINK_LANGUAGE:CXX>>:${CDPREP_CXX_LIBRARY}>")
    endif()
endfunction()
