/* SPDX-License-Identifier: MIT */
/* A plugin of QEMU that counts the instructions of a program and prints their number at its end.
 * Declares what it uses of the plugin interface, version 1, whose header Debian does not package.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef uint64_t qemu_id;
struct qemu_plugin_tb;
enum { QEMU_ADD_U64 = 0 };

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_id id,
                                           void (*translated)(qemu_id, struct qemu_plugin_tb*));
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* block);
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb* block, int operation,
                                              void* number, uint64_t by);
void qemu_plugin_register_atexit_cb(qemu_id id, void (*ended)(qemu_id, void*), void* context);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

static uint64_t executed;

static void add_block(qemu_id id, struct qemu_plugin_tb* block) {
    (void)id;
    qemu_plugin_register_vcpu_tb_exec_inline(block, QEMU_ADD_U64, &executed,
                                             qemu_plugin_tb_n_insns(block));
}

static void print_count(qemu_id id, void* context) {
    (void)id;
    (void)context;
    fprintf(stderr, "instructions: %llu\n", (unsigned long long)executed);
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_id id, const void* info,
                                                               int count, char** arguments) {
    (void)info;
    (void)count;
    (void)arguments;
    qemu_plugin_register_vcpu_tb_trans_cb(id, add_block);
    qemu_plugin_register_atexit_cb(id, print_count, NULL);
    return 0;
}
