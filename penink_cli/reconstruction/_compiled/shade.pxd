from penink_cli.reconstruction._compiled.scratch cimport Scratch
from penink_cli.reconstruction._compiled.tile cimport Tile

cdef int attenuate(Scratch scratch, Tile tile) except -1 nogil
