# SPDX-License-Identifier: MIT
# Fails when a header of the C API does not compile alone as C99 and as C++17, or does not declare
# its functions extern "C" for C++. Also when a struct has padding, when a function has more than six
# parameters, or when an identifier is a keyword of a language that calls C.
# Run by ctest as: cmake -D ROOT=<source dir> -D CC=<cc> -D CXX=<c++> -D OUT=<dir> -P this file
cmake_policy(SET CMP0057 NEW)
set(offences "")
file(GLOB headers RELATIVE ${ROOT}/lib/include
    ${ROOT}/lib/include/cdprep/c/*.h ${ROOT}/lib/include/cdprep/cdprep.h)
list(LENGTH headers count)
if(count LESS 6)
    message(FATAL_ERROR "only ${count} headers were found")
endif()

# Of Rust, Python, C# and Swift; those of C itself are none of ours.
set(keywords
    abstract as async await base become bool box byte catch char16 checked class crate decimal def
    default defer deinit delegate dyn elif event except explicit extension fallthrough False
    fileprivate final finally fixed fn foreach from func get global guard impl implicit import in
    init inout interface internal is lambda let lock loop macro match mod move mut namespace
    new nil None nonlocal not null object open operator or out override params pass priv private
    proc protected protocol pub public raise readonly ref rethrows sbyte sealed self Self
    stackalloc string subscript super throw throws trait True try type typeof uint ulong
    unchecked unsafe unsized use ushort using var virtual where with yield)

foreach(header IN LISTS headers)
    file(WRITE ${OUT}/alone.c "#include \"${header}\"\nint main(void) { return 0; }\n")
    file(WRITE ${OUT}/alone.cpp "#include \"${header}\"\nint main() { return 0; }\n")
    set(flags -pedantic -Wall -Wextra -Wpadded -Werror -I${ROOT}/lib/include
        -I${ROOT}/format/include -fsyntax-only)
    foreach(command "${CC};-std=c99;${OUT}/alone.c" "${CXX};-std=c++17;${OUT}/alone.cpp")
        execute_process(COMMAND ${command} ${flags} RESULT_VARIABLE failed ERROR_VARIABLE why)
        if(failed)
            string(APPEND offences "\n  ${header} alone: ${why}")
        endif()
    endforeach()

    file(READ ${ROOT}/lib/include/${header} text)
    # Comments go, and what CMake takes for lists.
    string(REGEX REPLACE "/\\*([^*]|\\*+[^*/])*\\*+/" "/**/" code "${text}")
    string(REPLACE "[" "(" code "${code}")
    string(REPLACE "]" ")" code "${code}")
    string(REGEX MATCHALL "CDPREP_API [^;]*;" functions "${code}")
    if(functions AND NOT code MATCHES "#ifdef __cplusplus\nextern \"C\" {\n#endif\n")
        string(APPEND offences "\n  ${header}: its functions are not extern \"C\" in C++")
    endif()
    foreach(function IN LISTS functions)
        string(REGEX MATCHALL "," commas "${function}")
        list(LENGTH commas parameters)
        if(parameters GREATER 5)
            string(APPEND offences "\n  more than six parameters: ${function}")
        endif()
    endforeach()
    string(REGEX REPLACE "\n *#[^\n]*" "" code "${code}")
    string(REGEX MATCHALL "[A-Za-z_][A-Za-z0-9_]*" words "${code}")
    list(REMOVE_DUPLICATES words)
    foreach(word IN LISTS words)
        if(word IN_LIST keywords)
            string(APPEND offences "\n  ${header}: '${word}' is a keyword elsewhere")
        endif()
    endforeach()
endforeach()

if(offences)
    message(FATAL_ERROR "the C API's headers:${offences}")
endif()
