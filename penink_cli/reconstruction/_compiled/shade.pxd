from penink_cli.reconstruction._compiled.desk cimport Desk
from penink_cli.reconstruction._compiled.tile cimport Tile

cdef int attenuate(Desk desk, Tile tile) except -1 nogil
