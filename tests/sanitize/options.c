// Linked into every program built with SANITIZE=...: how the sanitizers behave, also where a script clears the environment.
#pragma GCC visibility push(default) // the sanitizers look these names up
const char *__asan_default_options(void);
const char *__ubsan_default_options(void);
const char *__lsan_default_options(void);
const char *__lsan_default_suppressions(void);
int dlclose(void *module);
#pragma GCC visibility pop

// An exit code that the program has for nothing else. Tests let allocations fail, and preload libraries of their own. The last
// one: the search for leaks would follow thread-local memory of Embree's threads while they end, and die of it.
const char *__asan_default_options(void)
{
    return "exitcode=66:allocator_may_return_null=1:verify_asan_link_order=0:intercept_tls_get_addr=0";
}

const char *__ubsan_default_options(void) { return "print_stacktrace=1:exitcode=66"; }

const char *__lsan_default_options(void) { return "print_suppressions=0"; }

// What drivers and libraries keep until the process ends. No source or function of ours may be named here.
const char *__lsan_default_suppressions(void)
{
    return "leak:libEGL_mesa\n"
           "leak:libgallium\n"
           "leak:swrast_dri.so\n"
           "leak:libLLVM\n";
}

// Nothing is unloaded: a leak of a closed driver would have no name that a suppression could know.
int dlclose(void *module)
{
    (void)module;
    return 0;
}
