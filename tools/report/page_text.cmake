# The texts of the page become sources: its own, and three.js from Debian's libjs-three.
find_file(CDPREP_THREE_JS three.min.js
    PATHS /usr/share/javascript/three/build /usr/share/javascript/three NO_DEFAULT_PATH)
find_file(CDPREP_ORBIT_CONTROLS_JS OrbitControls.js
    PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH)
foreach(script CDPREP_THREE_JS CDPREP_ORBIT_CONTROLS_JS)
    if(NOT ${script})
        message(FATAL_ERROR "three.js was not found. Install libjs-three, or set ${script}.")
    endif()
endforeach()

function(cdprep_embed_text name input script)
    cmake_path(GET input FILENAME file)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/page_text/${file}.cpp)
    set(step ${CMAKE_CURRENT_SOURCE_DIR}/embed_text.cmake)
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D INPUT=${input} -D OUTPUT=${output}
            -D SCRIPT=${script} -P ${step}
        DEPENDS ${input} ${step} VERBATIM)
    target_sources(cdprep_report PRIVATE ${output})
endfunction()

set(page ${CMAKE_CURRENT_SOURCE_DIR}/page)
cdprep_embed_text(kFrame ${page}/page.html OFF)
cdprep_embed_text(kStyle ${page}/page.css OFF)
cdprep_embed_text(kView ${page}/view.js ON)
cdprep_embed_text(kList ${page}/list.js ON)
cdprep_embed_text(kPage ${page}/page.js ON)
cdprep_embed_text(kLicense ${page}/three_license.txt OFF)
cdprep_embed_text(kThree ${CDPREP_THREE_JS} ON)
cdprep_embed_text(kControls ${CDPREP_ORBIT_CONTROLS_JS} ON)
cdprep_embed_text(kAccuracyFrame ${page}/accuracy.html OFF)
cdprep_embed_text(kAccuracyStyle ${page}/accuracy.css OFF)
cdprep_embed_text(kAccuracyScript ${page}/accuracy.js ON)
cdprep_embed_text(kTables ${page}/tables.css OFF)
