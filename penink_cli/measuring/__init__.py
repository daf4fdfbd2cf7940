"""Measures of a finished drawing. Nothing here knows how the drawing was made.

strokes ─► tone.printed ─┬─► tone.figures      tone as the eye sees it, against the tone wanted; ink on white
                         └─► difference        of two drawings, or of two pictures
strokes ─► lines.figures                       how evenly strokes lie, how long they are, how often a pen is lifted
"""
