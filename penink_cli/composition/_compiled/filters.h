/* The inner loops of `filters.pyx`, made for any processor and for AVX2. */
#ifndef PENINK_FILTERS_H
#define PENINK_FILTERS_H

#include <stddef.h>

#define LOOPS "../../composition/_compiled/filters_loops.h"
#include "../../ground/_compiled/twice.h"

#define symmetric MAKE(symmetric)
#define bytes_summed MAKE(bytes_summed)
#define bytes_divided MAKE(bytes_divided)
#define shorts_divided MAKE(shorts_divided)
#define gathered MAKE(gathered)
#define shorts_summed MAKE(shorts_summed)
#define floats_summed MAKE(floats_summed)

#endif
