/* The inner loops of `phase.pyx`, made for any processor and for AVX2. */
#ifndef PENINK_PHASE_H
#define PENINK_PHASE_H

#include <math.h>

#define LOOPS "../../blasting/_compiled/phase_loops.h"
#include "../../ground/_compiled/twice.h"

#define agree MAKE(agree)
#define predict MAKE(predict)
#define angles MAKE(angles)

#endif
