"""The textures that come with the program, by what they are."""

from penink_cli.options.textures import find_texture, shipped

TEXTURES = {name: find_texture(name) for name in shipped()}
SETS = [name for name, texture in TEXTURES.items() if texture.oriented]
TILES = [name for name in TEXTURES if name not in SETS]
ENGRAVINGS = [name for name, texture in TEXTURES.items() if texture.engraving]
