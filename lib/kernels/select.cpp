// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <cstring>

#include "kernels.h"

namespace cdprep::kernels {
namespace {

const Table& choose() noexcept {
    const Available tables = available();
    // Read once, before any query: nothing else in the process writes it then.
    const char* wanted = std::getenv("CDPREP_KERNELS");  // NOLINT(concurrency-mt-unsafe)
    for (std::size_t i = 0; wanted != nullptr && i < tables.count; ++i) {
        if (std::strcmp(tables.table[i]->name, wanted) == 0) return *tables.table[i];
    }
    return *tables.table[tables.count - 1];
}

}  // namespace

Available available() noexcept {
    Available tables = {{&kScalar, nullptr, nullptr}, 1};
#ifdef CDPREP_HAVE_AVX2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        tables.table[tables.count++] = &kAvx2;
    }
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq")) {
        tables.table[tables.count++] = &kAvx512;
    }
#endif
    return tables;
}

const Table& active() noexcept {
    static const Table& table = choose();
    return table;
}

}  // namespace cdprep::kernels
