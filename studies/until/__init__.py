"""Which cells of a sweep need more seeds, and what stopping as soon as they have them does to intervals."""
