from penink_cli.reconstruction._desk cimport Desk
from penink_cli.reconstruction._lanes cimport Lanes
from penink_cli.reconstruction._tile cimport Tile

cdef void attenuate(Lanes* bits, Desk desk, Tile tile, double radius) noexcept nogil
