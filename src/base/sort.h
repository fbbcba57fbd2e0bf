// Rising order. Values that are not numbers are equal to all others: leave them out.
#ifndef SSDO_BASE_SORT_H
#define SSDO_BASE_SORT_H

#include <stddef.h>

void sort_floats(float *v, size_t count);
void sort_doubles(double *v, size_t count);
void sort_ints(int *v, size_t count);

#endif
