/* Preloaded, this has one allocation fail: the n-th that a kernel asks for itself. See shortage.py. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <string.h>

extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);

static char wanted[256];   /* part of the path of the kernel's module; empty: none fails, none is counted */
static long failing, seen; /* which is to fail, from 1; how many there were */

void shortage_of(const char *kernel, long n) {
    wanted[0] = 0;
    seen = 0;
    failing = n;
    strncpy(wanted, kernel, sizeof wanted - 1);
}

long shortage_seen(void) { return seen; }

static int fails(void *caller) {
    Dl_info module;
    if (!wanted[0] || !dladdr(caller, &module) || !strstr(module.dli_fname, wanted)) return 0;
    if (__sync_add_and_fetch(&seen, 1) != failing) return 0;
    errno = ENOMEM;
    return 1;
}

void *malloc(size_t n) { return fails(__builtin_return_address(0)) ? 0 : __libc_malloc(n); }
void *calloc(size_t n, size_t each) { return fails(__builtin_return_address(0)) ? 0 : __libc_calloc(n, each); }
void *realloc(void *p, size_t n) { return fails(__builtin_return_address(0)) ? 0 : __libc_realloc(p, n); }
