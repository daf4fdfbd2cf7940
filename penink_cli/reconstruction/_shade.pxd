from penink_cli.reconstruction._desk cimport Desk
from penink_cli.reconstruction._tile cimport Tile

cdef void attenuate(Desk desk, Tile tile) noexcept nogil
