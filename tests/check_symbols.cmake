# SPDX-License-Identifier: MIT
# Fails when the runtime throws, or uses a stream of the standard library: the C API
# may be called by programs that know neither. What the C++ library itself throws, the
# C API catches.
# Run by ctest as: cmake -D NM=<nm> -D LIBRARY=<libcdprep.a> -P check_symbols.cmake
execute_process(COMMAND ${NM} -C --undefined-only ${LIBRARY}
    OUTPUT_VARIABLE symbols RESULT_VARIABLE failed ERROR_QUIET)
if(failed)
    message(FATAL_ERROR "${NM} cannot read ${LIBRARY}")
endif()
if(NOT symbols MATCHES "__cxa_begin_catch")
    message(FATAL_ERROR "the C API catches nothing, or ${NM} shows no symbols")
endif()
string(REGEX MATCHALL
    "[^\n]*(__cxa_throw|__cxa_allocate_exception|std::(cout|cerr|clog|cin)|basic_[io]?o?stream|ios_base)[^\n]*"
    offences "${symbols}")
list(FILTER offences EXCLUDE REGEX "__cxa_throw_bad_array_new_length")
if(offences)
    message(FATAL_ERROR "the runtime uses: ${offences}")
endif()
