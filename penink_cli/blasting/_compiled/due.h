/* The inner loops of `due.pyx`, made for any processor and for AVX2. */
#ifndef PENINK_DUE_H
#define PENINK_DUE_H

#define BLOCK 16

#define LOOPS "../../blasting/_compiled/due_loops.h"
#include "../../ground/_compiled/twice.h"

#define splat_block MAKE(splat)
#define weigh MAKE(weigh)
#define weigh_beside MAKE(weigh_beside)

#endif
