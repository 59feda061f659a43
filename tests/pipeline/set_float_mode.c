/* SPDX-License-Identifier: MIT */
/* Preloaded into a program: every thread begins in the floating-point environment that
 * CDPREP_TEST_FLOAT_CONTROL names, a value of MXCSR or FPCR. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdlib.h>

static unsigned long control;
static int is_set;

static void set_control(void) {
    if (!is_set) return;
#if defined(__x86_64__)
    const unsigned word = (unsigned)control;
    __asm__ volatile("ldmxcsr %0" : : "m"(word) : "memory");
#elif defined(__aarch64__)
    __asm__ volatile("msr fpcr, %0" : : "r"(control) : "memory");
#endif
}

__attribute__((constructor)) static void begin(void) {
    const char* text = getenv("CDPREP_TEST_FLOAT_CONTROL");
    if (text == NULL) return;
    control = strtoul(text, NULL, 0);
    is_set = 1;
    set_control();
}

struct start {
    void* (*routine)(void*);
    void* argument;
};

static void* run(void* given) {
    const struct start start = *(struct start*)given;
    free(given);
    set_control();
    return start.routine(start.argument);
}

typedef int (*create)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*routine)(void*),
                   void* argument) {
    create real;
    *(void**)&real = dlsym(RTLD_NEXT, "pthread_create");
    struct start* start = malloc(sizeof *start);
    if (start == NULL) return 11; /* EAGAIN */
    start->routine = routine;
    start->argument = argument;
    const int failed = real(thread, attributes, run, start);
    if (failed != 0) free(start);
    return failed;
}
