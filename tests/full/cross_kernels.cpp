// SPDX-License-Identifier: MIT
// Prints a hash of the answers of each kernel of one instruction set, for tests/full/cross. Tables
// that round alike print the same: those of WebAssembly and of plain C++ do.
//
// Usage: cross_kernels TABLE
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "unit/lib/kernels/table_hashes.h"

namespace {

using namespace cdprep::kernels;

const Table* find_table(const char* name) {
    const Available tables = available();
    for (std::size_t i = 0; i < tables.count; ++i) {
        if (std::strcmp(tables.table[i]->name, name) == 0) return tables.table[i];
    }
    return nullptr;
}

int print_hashes(const Table& table) {
    const Hashes hashes = hashes_of(table);
    int code = 0;
    for (const auto& [kernel, hash] : hashes) {
        std::printf("%s %016" PRIx64 "\n", kernel.c_str(), hash.value());
        if (hash.others_than_zero() > kLeastAnswers) continue;
        std::fprintf(stderr, "cross_kernels: '%s' returns almost only zeros.\n", kernel.c_str());
        code = 1;
    }
    if (hashes.size() == kKernels) return code;
    std::fprintf(stderr, "cross_kernels: tests %zu of %zu kernels.\n", hashes.size(), kKernels);
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    const Table* const table = argc == 2 ? find_table(argv[1]) : nullptr;
    if (table == nullptr) {
        std::fputs("usage: cross_kernels TABLE, which this processor must have\n", stderr);
        return 2;
    }
    return print_hashes(*table);
}
