"""What a finished drawing is measured by; nothing here knows how it was made.

strokes ─► tone.printed ─┬─► tone.figures      tone as the eye sees it, against what was wanted; ink on white
                         └─► difference        of two drawings, or of two pictures
strokes ─► lines.figures                       how evenly they lie, how long they are, how often a pen is lifted
"""
