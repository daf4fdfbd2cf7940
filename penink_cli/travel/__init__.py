"""The order in which a pen draws strokes, so that it travels little while it is up.

order.ordered    nearest ends first (_compiled/tree), then exchanges while they shorten the way (_compiled/improve)
clock            how long a plotter takes to draw strokes in their order
"""
