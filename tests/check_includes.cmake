# SPDX-License-Identifier: MIT
# Fails when a file includes something that its room may not know about.
# Run by ctest as: cmake -D ROOT=<source dir> -P check_includes.cmake. ROOT is the folder above by
# default.

cmake_minimum_required(VERSION 3.25)
if(NOT ROOT)
    cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH ROOT)
endif()

# A room, then the rooms beside itself whose headers it may include. Public headers of the library,
# "cdprep/...", may be included everywhere but in format, which may include its own alone. No
# two know each other.
set(lib_rooms
    "exact:"
    "kernels:"
    "core: exact"
    "build: core exact kernels"
    "live: build core exact walk"
    "walk: core exact kernels"
    "hull: core exact kernels"
    "pieces: core exact hull kernels walk"
    "query: core exact pieces walk"
    "motion: build core exact query walk"
    "scene: core kernels walk"
    "cells: core exact kernels walk"
    "cells/build: build cells core exact"
    "c: core kernels pieces walk"
    "c/scene: c core pieces")
set(tools_rooms
    "command_line: text"
    "mesh:"
    "page: text"
    "text:"
    "write:"
    "import: mesh"
    "import/child: import"
    "crossings: mesh"
    "cli: import command_line mesh text write"
    "validate/defects: crossings mesh"
    "validate: cli import command_line mesh page text validate/defects"
    "hull: cli command_line mesh text write"
    "repair: cli crossings import command_line mesh text validate/defects write"
    "decompose/surface: hull mesh text"
    "decompose/enclose: cli crossings decompose/surface hull mesh text write"
    "decompose: cli decompose/enclose decompose/surface hull command_line text write"
    "export: cli command_line decompose/enclose hull mesh text write"
    "bake: cli crossings decompose/enclose decompose/surface hull import command_line mesh repair\
 text validate validate/defects write"
    "info: cli decompose/surface command_line mesh study text validate/defects"
    "study: bake decompose/enclose decompose/surface mesh"
    "accuracy: cli decompose/enclose hull command_line mesh page study text"
    "cell_searches: mesh study"
    "scene_file: bake cli import mesh text"
    "compare: cell_searches cli command_line decompose/surface hull import page study text"
    "query/inaccessible: mesh"
    "query: bake cell_searches cli command_line mesh query/inaccessible scene_file text\
 write"
    "simulate/dynamics: mesh text"
    "simulate/run: scene_file simulate/dynamics text"
    "simulate/page: cli page simulate/run text"
    "simulate: cli command_line import scene_file simulate/page simulate/run text")

# A library of others: the pattern of its headers, then the folders that may know it.
set(libraries
    "xxh:tests"
    "assimp/|zip\\.h:tools/import/child"
    "pugixml:tools/import/child tools/validate tools/write"
    "H5|hdf5:tools/write"
    "CGAL/:tools/decompose/enclose tools/info tools/query/inaccessible\
 tools/repair"
    "Eigen/:tools/mesh"
    "CLI/:tools/command_line"
    "Bullet[A-Z]|bt[A-Z]|LinearMath/|bullet_(manifold|shape):samples/engines tools/simulate/dynamics"
    "tbb/|oneapi/:tools/cli/program_threads.cpp"
    "nlohmann/:tools/accuracy tools/bake tools/compare tools/decompose tools/export tools/hull\
 tools/import/child tools/info tools/repair tools/scene_file tools/text\
 tools/simulate tools/validate tools/write")

set(offences "")
function(add_offence file hit)
    file(RELATIVE_PATH name ${ROOT} ${file})
    set(offences "${offences}\n  ${name}: ${hit}" PARENT_SCOPE)
endfunction()

# The room of an include is its folder; a header without one is of the same room.
function(check_rooms base rooms)
    foreach(row IN LISTS rooms)
        string(REGEX MATCH "^([^:]*):(.*)$" row "${row}")
        set(room ${CMAKE_MATCH_1})
        string(REGEX MATCHALL "[a-z_/]+" known "${CMAKE_MATCH_2}")
        file(GLOB files ${ROOT}/${base}/${room}/*.h ${ROOT}/${base}/${room}/*.cpp)
        foreach(file IN LISTS files)
            file(STRINGS ${file} hits REGEX "^ *# *include *\"[^\"]*/")
            foreach(hit IN LISTS hits)
                string(REGEX REPLACE "^[^\"]*\"(.*)/[^/]*$" "\\1" from "${hit}")
                if(NOT from MATCHES "^cdprep(/|$)" AND NOT from STREQUAL room
                   AND NOT from IN_LIST known)
                    add_offence(${file} "${hit}")
                endif()
            endforeach()
        endforeach()
    endforeach()
    set(offences "${offences}" PARENT_SCOPE)
endfunction()

# Every folder with sources must stand in the table.
function(check_listed base rooms)
    file(GLOB_RECURSE files RELATIVE ${ROOT}/${base} ${ROOT}/${base}/*.cpp)
    foreach(file IN LISTS files)
        cmake_path(GET file PARENT_PATH room)
        if(NOT ";${rooms};" MATCHES ";${room}:")
            add_offence(${ROOT}/${base}/${file} "is in a folder that check_includes.cmake lacks")
        endif()
    endforeach()
    set(offences "${offences}" PARENT_SCOPE)
endfunction()

check_rooms(lib "${lib_rooms}")
check_rooms(tools "${tools_rooms}")
check_listed(lib "${lib_rooms}")
check_listed(tools "${tools_rooms}")

# Features that stand alone: each goes with its folder and its line in tools/cli/main.cpp.
foreach(feature accuracy compare export info query simulate)
    foreach(row IN LISTS tools_rooms)
        if(row MATCHES "[: ]${feature}(/| |$)" AND NOT row MATCHES "^${feature}[:/]")
            add_offence(${ROOT}/tools/${feature} "is used elsewhere: ${row}")
        endif()
    endforeach()
    file(GLOB_RECURSE files ${ROOT}/tools/CMakeLists.txt ${ROOT}/tests/CMakeLists.txt)
    list(FILTER files EXCLUDE REGEX "/tools/${feature}/")
    foreach(file IN LISTS files)
        file(STRINGS ${file} hits REGEX "cdprep_${feature}[^a-z_]")
        list(FILTER hits EXCLUDE REGEX "^if\\(TARGET ")
        if(hits)
            add_offence(${file} "${hits}")
        endif()
    endforeach()
endforeach()

# Public headers include public headers; those of format and samples even fewer.
function(allow_only folder pattern)
    file(GLOB_RECURSE files ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp
        ${ROOT}/${folder}/*.c)
    foreach(file IN LISTS files)
        file(STRINGS ${file} hits REGEX "^ *# *include *\"")
        foreach(hit IN LISTS hits)
            if(NOT hit MATCHES "include *\"(${pattern})")
                add_offence(${file} "${hit}")
            endif()
        endforeach()
    endforeach()
    set(offences "${offences}" PARENT_SCOPE)
endfunction()
allow_only(lib/include "cdprep/")
allow_only(format/include "cdprep/format/")
allow_only(format/src "cdprep/format/|[a-z_]+\\.h\"")
allow_only(lib/bindings "cdprep/")
allow_only(samples "cdprep/|bullet_(manifold|shape)\\.h\"")

# The library cells is above the rest of lib, which knows none of its public headers. Its own C API
# does.
file(GLOB_RECURSE files ${ROOT}/lib/*.h ${ROOT}/lib/*.hpp ${ROOT}/lib/*.cpp)
list(FILTER files EXCLUDE REGEX "/lib/(cells|include/cdprep/cells)/|/cdprep/cells\\.h$|/c_cells\\.cpp$")
foreach(file IN LISTS files)
    file(STRINGS ${file} hits REGEX "^ *# *include *[<\"]cdprep/cells[/.]")
    foreach(hit IN LISTS hits)
        add_offence(${file} "${hit}")
    endforeach()
endforeach()

# A kernel knows nothing of ours but what kernels share, and two headers: macros, and what compilers
# offer in different ways. Who chooses among kernels knows more.
file(GLOB files ${ROOT}/lib/kernels/*.h ${ROOT}/lib/kernels/*.cpp)
list(FILTER files EXCLUDE REGEX "/select\\.cpp$")
foreach(file IN LISTS files)
    file(STRINGS ${file} hits REGEX "^ *# *include *\"[^\"]*/")
    list(FILTER hits EXCLUDE REGEX "cdprep/format/(api|portable)\\.h")
    if(hits)
        add_offence(${file} "${hits}")
    endif()
endforeach()

foreach(row IN LISTS libraries)
    string(REGEX MATCH "^(.*):(.*)$" row "${row}")
    set(headers ${CMAKE_MATCH_1})
    string(REGEX MATCHALL "[^ ]+" places "${CMAKE_MATCH_2}")
    file(GLOB_RECURSE files ${ROOT}/format/*.h ${ROOT}/format/*.cpp ${ROOT}/lib/*.h
        ${ROOT}/lib/*.cpp ${ROOT}/tools/*.h ${ROOT}/tools/*.cpp ${ROOT}/samples/*.cpp)
    foreach(file IN LISTS files)
        file(STRINGS ${file} hits REGEX "^ *# *include *[<\"](${headers})")
        if(NOT hits)
            continue()
        endif()
        set(is_allowed NO)
        foreach(place IN LISTS places)
            string(FIND "${file}" "${ROOT}/${place}" at)
            if(at EQUAL 0)
                set(is_allowed YES)
            endif()
        endforeach()
        if(NOT is_allowed)
            add_offence(${file} "${hits}")
        endif()
    endforeach()
endforeach()

if(offences)
    message(FATAL_ERROR "includes that break the dependency rule:${offences}")
endif()
