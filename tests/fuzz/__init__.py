"""Coverage-guided fuzzing of every reader: ``make fuzz SECONDS=600``."""
