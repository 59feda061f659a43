# SPDX-License-Identifier: MIT
# Fails when the shared libraries export anything but functions that a header marks with CDPREP_API,
# or lack one of these. What private headers mark is for cdprep_cells, and is listed here.
# Run as: cmake -D NM=<nm> -D ROOT=<source dir> -D LIBRARY=<libcdprep.so>
#     -D CELLS=<libcdprep_cells.so> -P check_exports.cmake
cmake_minimum_required(VERSION 3.25)
set(private_headers build/frame_map.h build/oriented_axes.h c/c_model.h c/call.h core/require.h
    core/sort_pairs.h exact/predicates.h exact/triangle_box.h exact/triangle_contact.h
    exact/wide_integer.h exact/winding.h kernels/curve.h kernels/kernels.h walk/box_placement.h
    walk/cell_searches.h walk/leaf_batch.h)
list(TRANSFORM private_headers PREPEND lib/)
set(offences "")

# Sets variable to the names of functions that a header marks.
function(read_marked header variable)
    file(READ ${header} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REPLACE ";" "@" text "${text}")
    string(REPLACE "\n" " " text "${text}")
    string(REGEX MATCHALL "CDPREP_API [^(@{]*\\(" marked "${text}")
    list(TRANSFORM marked REPLACE "^.*[ *&](operator[^ (]*|~?[A-Za-z_0-9]+)\\($" "\\1")
    set(${variable} ${marked} PARENT_SCOPE)
endfunction()

# Sets variable to the names of what a library exports, without namespaces, classes and parameters.
function(read_exported library variable)
    execute_process(COMMAND ${NM} -D -C --defined-only ${library}
        OUTPUT_VARIABLE lines RESULT_VARIABLE failed)
    if(failed)
        message(FATAL_ERROR "${NM} cannot read ${library}")
    endif()
    string(REPLACE ";" "," lines "${lines}")
    string(REGEX REPLACE "\n" ";" lines "${lines}")
    set(names "")
    foreach(line IN LISTS lines)
        if(line STREQUAL "" OR line MATCHES " A CDPREP_[0-9]+")  # the version itself
            continue()
        endif()
        string(REGEX REPLACE "@+CDPREP_[0-9]+$" "" line "${line}")
        if(line MATCHES " T (cdprep_[a-z0-9_]+)$")
            list(APPEND names ${CMAKE_MATCH_1})
        elseif(line MATCHES " T (cdprep::([A-Za-z0-9_]+::)*)(operator[^(]+|~?[A-Za-z0-9_]+)(\\[abi:cxx11\\])?\\(")
            list(APPEND names "${CMAKE_MATCH_3}")
        else()
            string(APPEND offences "\n  ${library}: ${line}")
        endif()
    endforeach()
    list(REMOVE_DUPLICATES names)
    set(${variable} ${names} PARENT_SCOPE)
    set(offences "${offences}" PARENT_SCOPE)
endfunction()

set(marked "")
file(GLOB_RECURSE headers ${ROOT}/lib/include/*.h ${ROOT}/format/include/*.h)
list(FILTER headers EXCLUDE REGEX "/api\\.h$")  # defines the mark
foreach(header IN LISTS headers private_headers)
    cmake_path(ABSOLUTE_PATH header BASE_DIRECTORY ${ROOT})
    read_marked(${header} of_header)
    list(APPEND marked ${of_header})
endforeach()
list(REMOVE_DUPLICATES marked)

read_exported(${LIBRARY} exported)
read_exported(${CELLS} of_cells)
list(APPEND exported ${of_cells})
list(LENGTH exported count)
if(count LESS 200)
    message(FATAL_ERROR "only ${count} functions are exported")
endif()
foreach(name IN LISTS exported)
    if(NOT name IN_LIST marked)
        string(APPEND offences "\n  ${name}() is exported, and no header marks it")
    endif()
endforeach()
foreach(name IN LISTS marked)
    if(NOT name IN_LIST exported)
        string(APPEND offences "\n  ${name}() is marked with CDPREP_API, and not exported")
    endif()
endforeach()
if(NOT "cdprep_cells" IN_LIST of_cells)
    string(APPEND offences "\n  cdprep_cells() is not in ${CELLS}")
endif()

find_program(OBJDUMP objdump REQUIRED)
foreach(library ${LIBRARY} ${CELLS})
    cmake_path(GET library FILENAME name)
    execute_process(COMMAND ${OBJDUMP} -p ${library} OUTPUT_VARIABLE dynamic)
    string(REPLACE "." "\\." pattern "${name}.0")
    if(NOT dynamic MATCHES "SONAME +${pattern}\n")
        string(APPEND offences "\n  ${name}: its SONAME is not ${name}.0")
    endif()
endforeach()

if(offences)
    message(FATAL_ERROR "the shared libraries:${offences}")
endif()
