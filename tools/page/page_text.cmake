# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the text of a file the string_view cdprep::report::page::NAME of a room's library. SCRIPT: it
# goes into a script element.
function(cdprep_embed_text room name input script)
    cmake_path(GET input FILENAME file)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/page_text/${file}.cpp)
    set(step ${PROJECT_SOURCE_DIR}/tools/page/embed_text.cmake)
    cmake_path(ABSOLUTE_PATH input)
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D INPUT=${input} -D OUTPUT=${output}
            -D SCRIPT=${script} -P ${step}
        DEPENDS ${input} ${step} VERBATIM)
    target_sources(${room} PRIVATE ${output})
    set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
