// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/hdf5_in_memory.h"

#include <algorithm>
#include <functional>
#include <new>

// A driver for HDF5's virtual file layer (H5FDpublic.h). HDF5 passes the result of open() to
// each function. Addresses count from the start of the file, user block included.

namespace cdprep::write {
namespace {

struct File {
    H5FD_t base;  // first: HDF5 passes its address
    SparseMemory* memory;
    haddr_t end_of_allocation;
};

File* file_of(H5FD_t* base) noexcept {
    return reinterpret_cast<File*>(base);
}
const File* file_of(const H5FD_t* base) noexcept {
    return reinterpret_cast<const File*>(base);
}

/// The data in an access list: the memory that holds the file.
struct Home {
    SparseMemory* memory;
};

H5FD_t* open(const char* /*name*/, unsigned flags, hid_t access, haddr_t /*limit*/) {
    const auto* home = static_cast<const Home*>(H5Pget_driver_info(access));
    if (home == nullptr) return nullptr;
    File* file = new (std::nothrow) File{};
    if (file == nullptr) return nullptr;
    file->memory = home->memory;
    if ((flags & H5F_ACC_TRUNC) != 0) file->memory->resize(0);
    return &file->base;
}

herr_t close(H5FD_t* base) {
    delete file_of(base);
    return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) {
    const std::less<const SparseMemory*> before;
    const SparseMemory* of_a = file_of(a)->memory;
    const SparseMemory* of_b = file_of(b)->memory;
    return static_cast<int>(before(of_b, of_a)) - static_cast<int>(before(of_a, of_b));
}

/// Asks HDF5 to write metadata in few, large blocks, as for a file on disk.
herr_t query(const H5FD_t* /*base*/, unsigned long* features) {
    *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA |
                H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

haddr_t end_of_allocation(const H5FD_t* base, H5FD_mem_t /*type*/) {
    return file_of(base)->end_of_allocation;
}

herr_t set_end_of_allocation(H5FD_t* base, H5FD_mem_t /*type*/, haddr_t address) {
    file_of(base)->end_of_allocation = address;
    return 0;
}

haddr_t end_of_file(const H5FD_t* base, H5FD_mem_t /*type*/) {
    return file_of(base)->memory->size();
}

herr_t read(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
            std::size_t size, void* buffer) {
    file_of(base)->memory->read(address, {static_cast<std::byte*>(buffer), size});
    return 0;
}

/// Writes bytes. Catches all exceptions, because none may pass through HDF5.
herr_t write(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
             std::size_t size, const void* buffer) {
    try {
        file_of(base)->memory->write(address, {static_cast<const std::byte*>(buffer), size});
        return 0;
    } catch (const std::bad_alloc&) {
        return -1;
    }
}

herr_t truncate(H5FD_t* base, hid_t /*transfer*/, hbool_t /*closing*/) {
    file_of(base)->memory->resize(file_of(base)->end_of_allocation);
    return 0;
}

hid_t driver() {
    static const H5FD_class_t description = [] {
        H5FD_class_t made{};
        made.name = "cdprep sparse memory";
        made.maxaddr = HADDR_MAX;
        made.fc_degree = H5F_CLOSE_WEAK;
        made.fapl_size = sizeof(Home);
        made.open = open;
        made.close = close;
        made.cmp = compare;
        made.query = query;
        made.get_eoa = end_of_allocation;
        made.set_eoa = set_end_of_allocation;
        made.get_eof = end_of_file;
        made.read = read;
        made.write = write;
        made.truncate = truncate;
        constexpr H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
        std::copy_n(map, H5FD_MEM_NTYPES, made.fl_map);
        return made;
    }();
    static const hid_t id = H5FDregister(&description);
    return id;
}

}  // namespace

bool keep_in_memory(hid_t access, SparseMemory& memory) {
    const Home home{&memory};
    return H5Pset_driver(access, driver(), &home) >= 0;
}

}  // namespace cdprep::write
