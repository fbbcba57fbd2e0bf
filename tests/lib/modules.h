// The modules (ssdo-*.so) that were built together with the running test.
#ifndef SSDO_TESTS_MODULES_H
#define SSDO_TESTS_MODULES_H

// Points SSDO_PLUGIN_DIR to the folder above that of the test, unless the environment names another already.
void use_built_modules(void);

#endif
