from penink_cli.reconstruction._compiled.desk cimport Desk
from penink_cli.reconstruction._compiled.tile cimport Tile

cdef void attenuate(Desk desk, Tile tile) noexcept nogil
