"""The paper's section 3: a grey image and a stroke texture to pen strokes of the same tone."""
