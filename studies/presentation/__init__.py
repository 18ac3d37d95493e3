"""What all studies share: how figures look, and verdict tables."""
