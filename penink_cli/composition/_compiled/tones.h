/* The loops of `tones.pyx`, made for any processor and for AVX2. */
#ifndef PENINK_TONES_H
#define PENINK_TONES_H

#include <math.h>

#define LOOPS "../../composition/_compiled/tones_loops.h"
#include "../../ground/_compiled/twice.h"

#define stretched MAKE(stretched)
#define based MAKE(based)
#define stirred MAKE(stirred)
#define rooted MAKE(rooted)
#define weighed MAKE(weighed)
#define lifted_by MAKE(lifted_by)
#define without_shine MAKE(without_shine)
#define blanked MAKE(blanked)
#define sunk MAKE(sunk)
#define less_light MAKE(less_light)
#define gained MAKE(gained)
#define guarded MAKE(guarded)
#define drawn MAKE(drawn)
#define with_room MAKE(with_room)

#endif
