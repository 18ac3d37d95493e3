"""`make stress`: the engine at and beyond what it is made for, and ten thousand random scenes, as one table."""
