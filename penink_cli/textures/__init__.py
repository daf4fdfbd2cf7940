"""The stroke textures that penink ships, and what makes them."""
