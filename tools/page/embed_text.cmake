# SPDX-License-Identifier: GPL-3.0-or-later
# Writes a source file that holds a text file as the string_view
# cdprep::report::page::NAME. Run as
#   cmake -D NAME=... -D INPUT=... -D OUTPUT=... [-D SCRIPT=ON] -P embed_text.cmake
# SCRIPT: the text goes into a script element, and must not be able to end it.
file(READ ${INPUT} text)
if(SCRIPT)
    string(TOLOWER "${text}" lower)
    foreach(end "</script" "<script" "<!--")
        string(FIND "${lower}" "${end}" at)
        if(NOT at EQUAL -1)
            message(FATAL_ERROR "${INPUT} contains ${end}, which would break the page.")
        endif()
    endforeach()
endif()

# In several literals, for compilers that limit the length of one literal.
string(LENGTH "${text}" length)
set(literals "\"\"")
set(at 0)
while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 literal)
    string(APPEND literals "\nR\"cdprep(${literal})cdprep\"")
    math(EXPR at "${at} + 8000")
endwhile()

file(WRITE ${OUTPUT} "#include <string_view>\n
namespace cdprep::report::page {
extern const std::string_view ${NAME};
const std::string_view ${NAME} = ${literals};
}
")
